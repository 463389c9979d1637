"""The quadrotors of a vehicle, each flown by the client of a real one: setpoints in, states out."""
