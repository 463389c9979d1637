"""What thrust, tilt and ground allow the guidance by hand, and whether the vehicle can follow its reference."""
