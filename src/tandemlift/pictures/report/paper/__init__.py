"""The paper beside what is flown here: its figures, its tables and its errata, as one document."""
