"""Flights that a caller steps: a simulation, the pilot as an object, a flight that records its commands."""
