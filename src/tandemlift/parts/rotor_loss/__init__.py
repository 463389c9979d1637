"""Rotor-failure detection, `[detection]`."""
