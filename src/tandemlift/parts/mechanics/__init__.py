"""Mechanics: the rigid body and its parts, rotations, tilt, pushes, and wind."""
