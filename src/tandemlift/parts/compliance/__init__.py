"""The response of the reference to a push: admittance, limits, passivity, and whether the vehicle can follow."""
