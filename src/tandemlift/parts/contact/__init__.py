"""Contact of the vehicle with floor and walls: its shapes, loads, records of touches, and clearances."""
