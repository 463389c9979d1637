"""Rotors: their lag and faults, the allocation of a wrench to them, and the thrusts within their limits."""
