"""How a reference answers a push: admittance, limits, passivity, and what the vehicle can follow."""
