"""Flights that a caller steps: a simulation, and a flight that records its commands."""
