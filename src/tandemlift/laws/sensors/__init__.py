"""Sensors: their readings and errors, their faults, their health, and the watchdogs over them."""
