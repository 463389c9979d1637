"""A person with the vehicle: one who guides it, their tremor, a hand moved from outside, and what a caller adds."""
