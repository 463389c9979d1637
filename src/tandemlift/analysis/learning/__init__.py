"""Flights that step together for learning: blocks, their lanes and readings, and environments of Gymnasium."""
