"""Flies missions: one, many at once, with changes in flight; outcomes and findings; the pilot alone."""
