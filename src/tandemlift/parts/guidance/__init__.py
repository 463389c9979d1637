"""Scheduled or interactive guidance: phases, heading, contact, requests, supervision and reactions to faults."""
