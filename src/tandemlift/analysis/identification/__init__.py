"""What a log of a vehicle tells: its contract, its clocks, what a mission's pilot makes of it."""
