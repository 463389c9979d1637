"""The log of a vehicle: its contract, its clocks, and checks of its units and frames."""
