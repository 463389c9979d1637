"""Certificates: how far a mission is from instability, with which parameters and person, and how often it fails."""
