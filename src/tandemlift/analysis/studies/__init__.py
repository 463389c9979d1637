"""Many flights: studies from a file, tuning, feel, comparisons."""
