"""Linear models of the closed step, or of the body alone, of a mission at a time: matrices, names and units."""
