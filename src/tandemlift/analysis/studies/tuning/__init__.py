"""Tuning: the numbers and words of a mission that make some metrics small, found by search over many flights."""
