"""Quadrotors as MAVLink vehicles, over UDP."""
