"""Sensors: their readings and errors, their faults, their health, and the watchdogs over them."""

from tandemlift.parts.sensors import additional_sensors  # registers its sensors

__all__ = ["additional_sensors"]
