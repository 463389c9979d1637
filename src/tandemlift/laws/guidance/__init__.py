"""Guidance: admittance and compliance, phases of a flight, requests, supervision and its reactions to faults."""
