"""Many flights that step together from Python, eight to a vector of the processor."""
