"""Diagrams of a mission before any flight: the vehicle with its loads, the control loop, the admittance."""
