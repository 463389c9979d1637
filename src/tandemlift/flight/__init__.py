"""The record of a flight: its channels, its file, and the record as a table."""

from tandemlift.flight.channels import CHANNELS, DERIVED, Channel
from tandemlift.flight.record import Ending, Flight

__all__ = ["CHANNELS", "DERIVED", "Channel", "Ending", "Flight"]
