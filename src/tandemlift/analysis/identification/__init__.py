"""A vehicle from its logs: the flight that tells most, its numbers, and what a pilot makes of a log."""
