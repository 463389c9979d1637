"""Guidance by the clock or by hand: phases, heading, contact, requests, supervision and its reactions to faults."""
