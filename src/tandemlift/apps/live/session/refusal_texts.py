"""The texts of refused messages of a page, with placeholders in braces.

A session fills them in. So does the page that flies without a server: it is given these texts (`apps.live.offline`).
"""

from __future__ import annotations

UNKNOWN = "{key}: is not a parameter that can be changed in flight; there are {known}"
NO_NUMBER = "{key} = {value}: must be a number, or a list of numbers"
OUT_OF_BOUNDS = "{key} = {value}: must be from {low:g} to {high:g}"
OVER = "{key}: the flight is over; reset it first"
WHOLE_ROTORS = "rotor = {rotor}: the rotors of this mission cannot fail"
FAILED_ALREADY = "rotor = {rotor}: fails at {time:g} s already"
BESIDE = "point = {point}: must be on the vehicle, within {reach:.3g} m of its centre of mass"
TARED_IN_HOVER = "hands off until the force sensors are tared, in steady hover"
TARED_UNTIL = "hands off until {end:g} s: the force sensors are tared in hover"
NO_REQUESTS = "{what}: mission {mission} is scheduled and takes no requests"
