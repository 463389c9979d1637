"""A mission assembled into a flight at t = 0: its state, its parameters, and its inputs from outside."""
