"""Reading a study: its table, statistics of its rows, and what its results depend on."""
