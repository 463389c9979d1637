"""The paper beside our flights: its figures, tables and errata, as one document."""
