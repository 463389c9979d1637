"""The pilot: from a measurement to rotor thrusts, the same for every body."""
