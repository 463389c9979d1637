"""The push as estimated, by joint sensors or by an observer."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3


class PushEstimate(NamedTuple):
    """The push as estimated.

    `measured` [N, world axes] and `measured_moment` [N·m, body axes, about the payload's centre of mass]: the last
    sample less the tare; `force` and `moment`, likewise: low-passed, zero until the tare is over; `point` [m]: where on
    body y the force acts, 0 if it is too small; `payload_mass` [kg]; `disagreement` [N]: the horizontal force by which
    one joint sensor alone would have to be wrong; `trusted` is 1 while that is below its limit, `armed` once the tare
    is over, else 0; `usable`: `force` where trusted, else zero. `withheld` [N, world axes]: what is not confirmed
    of the push (`push_confirmation`), and is not in the fields above; `refuted`: 1 while the motion refutes it, else 0.
    """

    measured: Vec3
    measured_moment: Vec3
    force: Vec3
    moment: Vec3
    point: Number
    payload_mass: Number
    disagreement: Number
    trusted: Number
    armed: Number
    usable: Vec3
    withheld: Vec3 = ZERO
    refuted: Number = 0.0
