"""Observers of the external wrench, without force sensors."""
