"""Signals: low-pass filters, random numbers and smooth trajectories."""
