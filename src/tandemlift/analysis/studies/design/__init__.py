"""The design of a study: its file, varied keys, and rows."""
