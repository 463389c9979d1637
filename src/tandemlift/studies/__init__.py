"""Many flights: studies from a file, tuning, feel, comparisons, validation of the pilot, missions at random."""
