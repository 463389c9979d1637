"""Checks of the rotors' thrust, tilt and moments about each axis against a mission's demand.

Moments are those of the allocation's pseudo-inverse in hover: with thrusts f₀ and the moment's column a of the inverse,
the first rotor reaches a limit at the smallest of (f_max − f₀)/a and f₀/(−a). `missions.hardware_checks` rejects
missions whose rotors cannot lift the vehicle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tandemlift.core.errors import CheckResult, judged
from tandemlift.core.types import Array
from tandemlift.missions.flight_checks.loads import ALWAYS, VehicleLoads, loads_of
from tandemlift.missions.tables.mission import Mission
from tandemlift.missions.tables.weight import lift_of, weight_of
from tandemlift.parts.mechanics.vehicle import Vehicle

AXES = ("roll", "pitch", "yaw")
CONTROL = 0.15  # of the largest moment, reserved for control, as supervision.checks.thrust_fraction does for the thrust
CLOCKED = 0.95  # of the largest thrust that a flight with scheduled guidance may need


def authority_checks(m: Mission) -> Iterator[CheckResult]:
    """Checks of thrust, tilt and moments of real rotors; none for ideal ones."""
    if m.actuators.model != "rotors":
        return
    yields = m.pilot.guidance == "interactive" and m.compliance.yaw.model == "compliant"
    loads = list(loads_of(m, yielding_yaw=yields))
    thrust = thrust_check(m, loads)
    yield thrust
    if thrust.value is None or thrust.value < lift_of(m, faulty=True):
        yield tilt_check(m, loads)
    yield from moment_checks(m, loads)
    if m.supervision.model == "on":
        yield supervised_check(m)


def _at(when: str) -> str:
    return "" if when == ALWAYS else f"{when}, "


def thrust_check(m: Mission, loads: list[VehicleLoads]) -> CheckResult:
    """Compare the thrust for the worst vertical load with the usable thrust of all rotors."""
    weight, lift = weight_of(m), lift_of(m, faulty=True)
    by_hand = m.pilot.guidance == "interactive"
    fraction, key = (m.compliance.thrust_fraction, "compliance.thrust_fraction") if by_hand else (CLOCKED, "")
    worst = min(loads, key=lambda load: float(load.force[2]))
    needed, limit = weight - min(float(worst.force[2]), 0.0), fraction * lift
    names = f"{key} = {fraction:g}" if key else f"{fraction:g}"
    then = "the vehicle cannot fly" if needed > lift else "too little is left to follow pushes and to control"
    text = (
        f"{_at(worst.when)}hover needs {needed:.3g} N of thrust, and {names} of the rotors' {lift:.3g} N is "
        f"{limit:.3g} N: {then}; lower the masses, plant.mass_scale or the load, or raise the rotors' max_speed"
    )
    return judged("thrust", needed, limit, "N", text, subject=worst.when, near=0.05)


def supervised_check(m: Mission) -> CheckResult:
    """Compare the weight that the pilot assumes with its limit for a lift."""
    vehicle = Vehicle.from_settings(m.vehicle)
    fraction = m.supervision.checks.thrust_fraction
    limit = fraction * vehicle.max_thrust
    text = (
        f"the vehicle weighs {vehicle.weight:.3g} N, and supervision.checks.thrust_fraction = {fraction:g} of its "
        f"rotors' {vehicle.max_thrust:.3g} N is {limit:.3g} N: the lift is refused; raise it, or lower the masses"
    )
    return judged("supervised lift", vehicle.weight, limit, "N", text)


def tilt_limit_of(m: Mission) -> float | None:
    """The largest tilt of the controller [rad]; None without a limit."""
    return getattr(m.controller, "max_tilt", None)


def tilt_check(m: Mission, loads: list[VehicleLoads]) -> CheckResult:
    """Compare the horizontal load with the force that tilt and thrust provide beside the weight."""
    weight, lift, tilt = weight_of(m), lift_of(m, faulty=True), tilt_limit_of(m)

    def limit_of(load: VehicleLoads) -> float:
        up = max(weight - float(load.force[2]), 0.0)
        by_thrust = math.sqrt(max(lift**2 - up**2, 0.0))
        return by_thrust if tilt is None else min(by_thrust, up * math.tan(tilt))

    worst = max(loads, key=lambda load: load.across - limit_of(load))
    limit = limit_of(worst)
    key = "the rotors' thrust" if tilt is None else f"controller.max_tilt = {tilt:g}"
    change = "lower the load" if tilt is None else "lower the load, or raise controller.max_tilt"
    text = (
        f"{_at(worst.when)}wind, disturbance and pushes make {worst.across:.3g} N across, and {key} can "
        f"counter {limit:.3g} N: the vehicle is carried away; {change}"
    )
    return judged("tilt", worst.across, limit, "N", text, subject=worst.when)


def authority_of(m: Mission) -> Array:
    """The largest moment [N m] about each body axis, either way, in hover by the pseudo-inverse (3)."""
    inverse = Vehicle.from_settings(m.vehicle).allocation(m.allocation.weights)
    most = np.repeat([q.max_thrust for q in m.vehicle.quadrotors], 4)
    hover = inverse[:, 0] * weight_of(m)
    up, down = np.maximum(most - hover, 0.0)[:, None], np.maximum(hover, 0.0)[:, None]
    column = inverse[:, 1:]
    size = np.maximum(np.abs(column), 1e-12)
    one, other = np.where(column > 0.0, up, down) / size, np.where(column > 0.0, down, up) / size
    return np.minimum(one.min(axis=0), other.min(axis=0))


def moment_checks(m: Mission, loads: list[VehicleLoads]) -> Iterator[CheckResult]:
    """Compare the moment of all loads about each axis with the moment that the rotors have left in hover."""
    authority = authority_of(m)
    for i, axis in enumerate(AXES):
        worst = max(loads, key=lambda load: float(load.about[i]))
        value, limit = float(worst.about[i]), (1.0 - CONTROL) * float(authority[i])
        text = (
            f"{_at(worst.when)}wind, disturbance and pushes exert a {axis} moment of {value:.3g} N m, and the "
            f"rotors give {authority[i]:.3g} N m in hover, of which {limit:.3g} N m leaves {CONTROL:.0%} for control: "
            "the vehicle overturns or rotates away; lower disturbance.moment, the wind, or the push and its lever arm"
        )
        yield judged("moment", value, limit, "N m", text, subject=axis, near=0.3)
