"""Exercises and their checks, the hand-ins of a class, and its table."""
