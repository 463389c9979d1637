"""Random missions, over all keys."""
