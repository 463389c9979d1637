"""A mission as C99: the pilot, and the whole flight around it."""
