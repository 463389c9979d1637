"""Blocks of flights: which fly together, and the text of what a block does besides its steps."""
