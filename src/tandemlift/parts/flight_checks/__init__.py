"""Checks before a flight: loads, authority, loops, sensing, schedule, and the linear response of a controller."""
