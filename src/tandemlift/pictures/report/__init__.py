"""Reports of a flight, and of comparisons, as HTML pages."""
