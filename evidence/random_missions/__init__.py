"""Missions at random, over all keys."""
