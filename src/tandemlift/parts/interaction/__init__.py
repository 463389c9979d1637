"""Person and vehicle: the person who pushes and the inputs of a caller; and the compliance that follows them."""
