"""The limit of a parameter by linear models of changed missions: each value that is tried is linearized anew.

A change of mass or inertia changes what the joint sensors feel, so that it is more than a gain of the loop.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.parameters import PARAMETERS, with_keys
from tandemlift.analysis.linearization.linear_model import continuous
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import (
    NO_KINK,
    ON_CIRCLE,
    calm_mission,
    is_calm,
    rotor_delay_and_lag,
)
from tandemlift.core.errors import InputError
from tandemlift.missions import Mission

STEP, CLOSER, ACCURACY = 1.25, 1.04, 0.01  # factors between values that bracket a limit; width of the last bracket
LEAST, MOST = 0.02, 50.0  # of the nominal value, between which a limit is looked for


class LinearLimit(NamedTuple):
    """A limit by linear models.

    Attributes:
        value: of the parameter; 0 or infinite where there is none between `LEAST` and `MOST` of the nominal value.
        frequency: of the oscillation there [rad/s]; 0 where the motion grows without one.
    """

    value: float
    frequency: float


def fastest_growth(calm: Mission, at: float, changes: dict[str, Any]) -> complex | None:
    """The eigenvalue [1/s] of a hover, calm at a time [s], that grows fastest with changes by key; None if none grows.

    A hover that cannot be flown to grows, by an infinite rate.
    """
    try:
        changed = with_keys(calm, changes)
        model = linearize(changed, at, inputs=["thrust_offsets"], outputs=["rotor_thrusts"], kink_tolerance=NO_KINK)
    except InputError:
        return complex(math.inf)
    z = np.linalg.eigvals(model.connected().A)
    if not len(z):  # rotors at their limits: no thrust moves anything
        return complex(math.inf)
    worst = z[np.argmax(np.abs(z))]
    if abs(worst) > 1.0 + ON_CIRCLE:
        return continuous(complex(worst), model.step)
    return None if is_calm(model) else complex(math.inf)


def linear_limit(mission: Mission, name: str, *, growing: bool, near: float | None = None) -> LinearLimit:
    """The nearest value above (`growing`) or below the nominal one at which a hover is no longer stable.

    Args:
        mission: the nominal one.
        name: of the parameter.
        growing: whether the limit is above the nominal value.
        near: a value on that side near the limit, at which the search begins; by default, the nominal one.

    Raises:
        InputError: no parameter has this name, or the mission cannot hover calmly.
    """
    p, step = PARAMETERS[name], STEP if near is None else CLOSER
    nominal = p.nominal(mission)
    calm, at = calm_mission(mission, lag=rotor_delay_and_lag(mission.hover)[1])

    def growth(value: float) -> complex | None:
        return fastest_growth(calm, at, p.keys(mission, value))

    factor = step if growing else 1.0 / step
    stable, value = nominal, nominal * factor if near is None else near
    s = growth(value)
    while s is None:
        stable, value = value, value * factor
        if not LEAST * nominal < value < MOST * nominal:
            return LinearLimit(math.inf if growing else 0.0, 0.0)
        s = growth(value)
    while stable == nominal and abs(math.log(value / nominal)) > 1.01 * math.log(step):  # back from `near`
        found = growth(value / factor)
        stable, value, s = (value / factor, value, s) if found is None else (stable, value / factor, found)
    while abs(value - stable) > ACCURACY * value:
        middle = math.sqrt(value * stable)  # of factors, the middle is the geometric mean
        found = growth(middle)
        stable, value, s = (middle, value, s) if found is None else (stable, middle, found)
    return LinearLimit(math.sqrt(value * stable), abs(s.imag) if math.isfinite(s.real) else 0.0)
