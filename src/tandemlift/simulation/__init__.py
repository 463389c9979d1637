"""Simulation of missions: assembly, whole flights, flights step by step, and changes in flight."""
