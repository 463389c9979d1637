"""From a mission to its flight: whole, many at once, changed in flight; outcome and findings; the pilot alone."""
