"""Validation of the pilot: chapters of measurements on flights, each beside its target."""
