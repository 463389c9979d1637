"""Contact of the vehicle with floor and walls: springs, shapes, their forces, clearance, the record of touches."""
