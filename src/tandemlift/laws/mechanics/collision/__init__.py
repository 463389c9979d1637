"""Contact of the vehicle's parts with floor and walls: springs, shapes that meet the floor, the record of touches."""
