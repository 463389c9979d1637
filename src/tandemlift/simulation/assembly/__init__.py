"""Assembles a mission into a flight at t = 0: its state, its parameters, and its external inputs."""
