"""Flights for other machines: the graph of a mission as WebAssembly, as objects for other processors, and as C99."""
