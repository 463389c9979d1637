"""Analyses by many flights: studies from a file, tuning, feel, comparisons."""
