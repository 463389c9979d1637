"""Quadrotors as Crazyflies: the protocol CRTP over UDP."""
