"""The limit of a parameter by linear models of changed missions: each value that is tried is linearized anew.

A change of mass or inertia changes what the joint sensors feel, so that it is more than a gain of the loop.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.certification.parameters import PARAMETERS, with_keys
from tandemlift.analysis.linearization.linear_model import continuous
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import DELAYS, NO_KINK, ON_CIRCLE, RESTING, calm_mission, motion_of
from tandemlift.analysis.linearization.operating_point import OperatingPoint, flown_to
from tandemlift.core.errors import InputError
from tandemlift.core.types import flat
from tandemlift.missions import Mission
from tandemlift.simulation.plan import FlightPlan

STEP, FINE_STEP, ACCURACY = 1.25, 1.04, 0.01  # factors between values that bracket a limit; width of the last bracket
DECAY = 0.5  # of the motion before: what has decayed
MIN_RATIO, MAX_RATIO = 0.02, 50.0  # of the nominal value, between which a limit is looked for


class LinearLimit(NamedTuple):
    """A limit by linear models.

    Attributes:
        value: of the parameter; 0 or infinite where there is none within the range of the search.
        frequency: of the oscillation there [rad/s]; 0 where the motion grows without one.
    """

    value: float
    frequency: float


def with_body_of(point: OperatingPoint, mission: Mission) -> OperatingPoint:
    """A hover with the numbers of another mission whose body hovers alike, such as one of another inertia."""
    plan = FlightPlan(mission)
    numbers, flown = plan.start().numbers, len(flat(plan.model.flight_state))
    numbers[:flown] = point.numbers[:flown]
    return point._replace(plan=plan, numbers=numbers)


class GrowthOfHover:
    """The growth of deviations from a mission's hover with its real rotors, by the value of a parameter of its body.

    Raises:
        InputError: the mission cannot hover calmly.
    """

    def __init__(self, mission: Mission, name: str) -> None:
        self._mission, self._parameter = mission, PARAMETERS[name]
        self._calm, self._last = calm_mission(mission, slow=1.0, wait=DELAYS[-1])
        # an inertia does not change the hover, which is flown to once; from the floor, a body of another inertia may
        # be thrown off a hover that is stable
        self._hover = flown_to(self._calm, self._last) if name.endswith("inertia") else None

    def __call__(self, value: float) -> complex | None:
        """The eigenvalue [1/s] that grows fastest; None if none grows.

        A hover that still moves is looked at again later: one that settles slowly is stable. A motion that does not
        decay, and a hover that cannot be flown to, grow; by an infinite rate if no eigenvalue does.
        """
        found, before = complex(math.inf), math.inf
        for wait in DELAYS:
            try:
                changed = with_keys(self._calm, self._parameter.keys(self._mission, value))
                at = self._last - DELAYS[-1] + wait
                point = flown_to(changed, at) if self._hover is None else with_body_of(self._hover, changed)
                model = linearize(point, inputs=["thrust_offsets"], outputs=["rotor_thrusts"], kink_tolerance=NO_KINK)
            except InputError:
                return found
            z, motion = np.linalg.eigvals(model.connected().A), motion_of(model)
            if not len(z):  # rotors at their limits: no thrust moves anything
                return complex(math.inf)
            worst = z[np.argmax(np.abs(z))]
            if grows := abs(worst) > 1.0 + ON_CIRCLE:
                found = continuous(complex(worst), model.step)
            if motion < RESTING or (not grows and motion < DECAY * before < math.inf):
                return found if grows else None
            before = motion
        return found


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
    step = STEP if near is None else FINE_STEP
    nominal, growth = PARAMETERS[name].nominal(mission), GrowthOfHover(mission, name)
    factor = step if growing else 1.0 / step
    stable, value = nominal, nominal * factor if near is None else near
    s = growth(value)
    while s is None:
        stable, value = value, value * factor
        if not MIN_RATIO * nominal < value < MAX_RATIO * nominal:
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
