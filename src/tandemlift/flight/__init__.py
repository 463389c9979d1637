"""The record of a flight, and the record as a table."""
