"""Mechanics: the rigid body and its parts, rotations, pushes, contact with floor and walls, and wind."""
