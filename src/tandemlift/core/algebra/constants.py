"""Physical constants."""

GRAVITY = 9.81  # m/s², paper Table II


NEVER = 1e18  # s
