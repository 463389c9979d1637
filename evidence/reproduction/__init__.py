"""The paper beside our results: its claims, figures, tables and errata."""
