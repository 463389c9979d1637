"""The person: a model that guides the vehicle, hand tremor, a hand moved from outside, and inputs of a caller."""
