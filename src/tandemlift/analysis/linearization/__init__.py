"""The closed step, or the body alone, as a linear model: matrices, names and units of a mission at a time."""
