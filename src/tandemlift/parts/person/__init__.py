"""The person: a model of guidance by hand, hand tremor, a virtual hand, and inputs of a caller."""
