"""Whether the rotors can hold a hand: an ideal pilot with their limits, about each axis and along z.

It knows the hand's force F and moments M exactly, and counters them at once, but gives no more than the rotors have
beside the weight: u = clip(−M − J (2 ω q' + ω² q)), J q'' = M + u. It holds the hand if q stays within the bounds that
a real pilot is held to. So a short tap that inertia takes is within what rotors can give, however large its peak.
"""

from __future__ import annotations

import math

import numpy as np

from tandemlift.core.types import Array
from tandemlift.missions import Mission
from tandemlift.parts.rotors.hover import CONTROL

SINKS, TURNS = 0.1, math.radians(5.0)
QUICK = 8.0  # rad/s, of the ideal pilot's return
STEP = 0.002  # s
ARM = 1.0  # of the hand's largest force, by which an arm's spring may pull in addition


def hand_wrench(mission: Mission, times: Array) -> Array:
    """Fz [N] and roll, pitch, yaw moment [N m] of all pushes about the centre of mass over time (T, 4), level."""
    found = np.zeros((len(times), 4))
    yaw = mission.initial.euler[2]
    c, s = math.cos(yaw), math.sin(yaw)
    for push in mission.pushes:
        size = np.exp(-0.5 * ((times - push.time) / push.sigma) ** 2)
        x, y, z = push.force
        body = np.array([c * x + s * y, c * y - s * x, z])
        found += size[:, None] * np.array([z, *np.cross(push.point, body)])
    return found


def is_within(mission: Mission, start: float, end: float) -> bool:
    """Whether an ideal pilot with the mission's rotors holds its pushes, and tilts enough to counter them."""
    hover = mission.hover
    times = np.arange(start - 0.5, end, STEP)
    wrench = hand_wrench(mission, times)
    if mission.person.model == "hold":  # the arm pulls at its grip, at most by its largest force
        wrench[:, 3] += np.sign(wrench[:, 3]) * mission.person.max_force * abs(mission.person.grip) * 0.5
    share = 1.0 - CONTROL
    authority = share * hover.authority
    up, down = share * hover.lift - hover.weight, hover.weight * share
    limits = [(-down, up), *((-a, a) for a in authority)]
    inertia = [hover.mass, *np.diag(hover.vehicle.real_inertia(hover.plant))]
    bounds = [SINKS, TURNS, TURNS, TURNS]
    return all(_excursion(wrench[:, i], inertia[i], *limits[i]) <= bounds[i] and limits[i][1] > 0.0 for i in range(4))


def _excursion(M: Array, J: float, low: float, high: float) -> float:
    """The largest excursion under a load M with the counter-load within limits."""
    q = v = worst = 0.0
    for load in M.tolist():
        wanted = -load - J * (2.0 * QUICK * v + QUICK * QUICK * q)
        u = min(max(wanted, low), high)
        v += STEP * (load + u) / J
        q += STEP * v
        worst = max(worst, abs(q))
    return worst
