"""Mechanics: the rigid body and its parts, rotations, pushes, and wind."""
