"""Estimation: the push, the tare, navigation, the disturbance observer, and the detection of lost rotors."""
