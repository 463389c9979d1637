"""Rules for keys of all tables: which of them act in a mission, and the present names of former keys."""
