"""Tuning: search over many flights for the numbers and words of a mission that minimize some metrics."""
