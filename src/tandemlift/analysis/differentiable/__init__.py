"""The closed step of a flight as a function of NumPy, JAX and PyTorch, with its derivatives as machine code."""
