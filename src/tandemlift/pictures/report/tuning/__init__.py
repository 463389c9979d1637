"""Pages about gains: a tuning, and the feel of an admittance."""
