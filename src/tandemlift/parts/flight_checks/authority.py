"""Checks of the rotors' lift, thrust, tilt and moments about each axis against a mission's demand.

Moments are those of the allocation's pseudo-inverse in hover. `lift_checks` rejects missions whose rotors cannot lift
the vehicle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from tandemlift.core.errors import CLOSE, FAILS, CheckResult, judged, refused, warned
from tandemlift.parts.flight_checks.hover_loads import ALWAYS, Loads, VehicleLoads
from tandemlift.parts.rotors.hover import CONTROL, HoverFacts

AXES = ("roll", "pitch", "yaw")
HAND_FORCE = 3.0  # N, of a hand that is not gentle; it scales with the mass …
HAND_MASS = 3.5  # kg … from that of a vehicle with this one
UNLIMITED_TILT = 0.5  # rad, that a controller without a limit may tilt
SCHEDULED_SHARE = 0.95  # of the largest thrust that a flight with scheduled guidance may need


def authority_checks(
    hover: HoverFacts, loads: Loads, by_hand: float | None, tilt: float | None
) -> Iterator[CheckResult]:
    """Checks of thrust, tilt and moments of real rotors; none for ideal ones.

    Args:
        hover: the vehicle and its rotors.
        loads: on it, of which at least one lasts.
        by_hand: `compliance.thrust_fraction` of interactive guidance; None if scheduled.
        tilt: largest tilt of the controller [rad]; None without a limit.
    """
    if hover.actuators.model != "rotors":
        return
    loads = loads._replace(each=list(loads.each))
    thrust = thrust_check(hover, loads, by_hand)
    yield thrust
    if thrust.value is None or thrust.value < hover.faulty_lift:
        yield tilt_check(hover, loads, tilt)
    yield from moment_checks(hover, loads)
    if by_hand is not None:
        yield from push_checks(hover)


def _at(when: str) -> str:
    return "" if when == ALWAYS else f"{when}, "


def thrust_check(hover: HoverFacts, loads: Loads, by_hand: float | None) -> CheckResult:
    """Compare the thrust for the worst vertical load with the usable thrust of all rotors."""
    lift, fraction = hover.faulty_lift, SCHEDULED_SHARE if by_hand is None else by_hand
    limit, needs = fraction * lift, lambda load: hover.weight - min(float(load.force[2]), 0.0)
    worst = loads.worst(lambda load: needs(load) - limit, hover.mass, loads.distance)
    needed = needs(worst)
    names = f"{fraction:g}" if by_hand is None else f"compliance.thrust_fraction = {fraction:g}"
    then = "the vehicle cannot fly" if needed > lift else "too little is left to follow pushes and to control"
    text = (
        f"{_at(worst.when)}hover needs {needed:.3g} N of thrust, and {names} of the rotors' {lift:.3g} N is "
        f"{limit:.3g} N: {then}; lower the masses, plant.mass_scale or the load, or raise the rotors' max_speed"
    )
    return judged("thrust", needed, limit, "N", text, subject=worst.when, near=0.05)


def tilt_check(hover: HoverFacts, loads: Loads, tilt: float | None) -> CheckResult:
    """Compare the horizontal load with the force that tilt [rad] and thrust provide beside the weight."""
    weight, lift = hover.weight, hover.faulty_lift

    def limit_of(load: VehicleLoads) -> float:
        up = max(weight - float(load.force[2]), 0.0)
        by_thrust = math.sqrt(max(lift**2 - up**2, 0.0))
        return by_thrust if tilt is None else min(by_thrust, up * math.tan(tilt))

    inertia = np.diag(hover.vehicle.inertia)[:2]
    turns = np.sqrt((tilt or UNLIMITED_TILT) * inertia / hover.authority[:2])  # s, to half the tilt
    loads = loads._replace(lag=loads.lag + float(turns.mean()))
    worst = loads.worst(lambda load: load.across - limit_of(load), hover.mass, loads.distance)
    limit = limit_of(worst)
    key = "the rotors' thrust" if tilt is None else f"controller.max_tilt = {tilt:g}"
    change = "lower the load" if tilt is None else "lower the load, or raise controller.max_tilt"
    text = (
        f"{_at(worst.when)}wind, disturbance and pushes make {worst.across:.3g} N across, and {key} can "
        f"counter {limit:.3g} N: the vehicle is carried away; {change}"
    )
    return judged("tilt", worst.across, limit, "N", text, subject=worst.when)


def moment_checks(hover: HoverFacts, loads: Loads) -> Iterator[CheckResult]:
    """Compare the moment of all loads about each axis with that which the rotors have left in hover."""
    authority, usable = hover.authority, hover.usable_authority
    for i, axis in enumerate(AXES):
        limit, angle = float(usable[i]), loads.heading if axis == "yaw" else loads.tilt
        beyond = partial(lambda load, i, limit: float(load.about[i]) - limit, i=i, limit=limit)
        worst = loads.worst(beyond, float(hover.vehicle.inertia[i, i]), angle)
        value = float(worst.about[i])
        text = (
            f"{_at(worst.when)}wind, disturbance and pushes exert a {axis} moment of {value:.3g} N m, and by "
            f"allocation.weights the rotors give {authority[i]:.3g} N m in hover, of which {limit:.3g} N m leaves "
            f"{CONTROL:.0%} for control: "
            "the vehicle overturns or rotates away; lower disturbance.moment, the wind, or the push and its lever arm"
        )
        yield judged("moment", value, limit, "N m", text, subject=axis, near=0.3)


def push_checks(hover: HoverFacts) -> Iterator[CheckResult]:
    """Compare a push in proportion to the mass with the one at which a rotor saturates: a warning to a hand."""
    push = HAND_FORCE * hover.vehicle.mass / HAND_MASS
    x, y, _ = max(hover.vehicle.lever_arms, key=lambda arm: math.hypot(arm[0], arm[1]))
    far = math.hypot(x, y)
    up = np.array([0.0, 0.0, 1.0])
    ways = {"down at the middle": (np.zeros(3), [-up])}
    if far > 0.0:
        across = np.array([-y, x, 0.0]) / far
        ways["level at an end"] = (np.array([x, y, 0.0]), [across, -across])
        ways["upright at an end"] = (np.array([x, y, 0.0]), [up, -up])
    for subject, (place, directions) in ways.items():
        limit = min(hover.largest_push(place, way) for way in directions)
        text = (
            f"a push of {push:.3g} N {subject} of the vehicle saturates a rotor, one of {limit:.2g} N does not yet: "
            "then it follows late, or turns away; push gently there, or nearer the middle"
        )
        result = judged("push", push, limit, "N", text, subject=subject)
        yield result._replace(verdict=CLOSE) if result.verdict == FAILS else result


def lift_checks(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for real rotors that cannot lift the vehicle, and for ideal ones with a thrust of their own."""
    scale, stronger = hover.plant.mass_scale, hover.plant.thrust_scale
    if hover.actuators.model != "rotors" and stronger != 1.0:
        yield refused(f'plant.thrust_scale = {stronger:g}: must be 1, or actuators.model "rotors", not "ideal"')
    if hover.actuators.model == "rotors" and hover.weight > hover.lift:
        yield refused(
            f'actuators.model = "rotors": the vehicle weighs {hover.weight:.4g} N'
            f"{f' (plant.mass_scale = {scale:g})' if scale != 1.0 else ''} "
            f'and its rotors lift {hover.lift:.4g} N at most; it must be lighter, or the model "ideal"'
        )


def ideal_lift_warnings(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for ideal rotors that give more thrust than real ones could."""
    if hover.weight > hover.lift:
        yield warned(
            f"the vehicle weighs {hover.weight:.4g} N and its rotors lift {hover.lift:.4g} N; it flies only because "
            "actuators.model is ideal"
        )


def hover_warnings(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for rotors that cannot give their thrusts in hover."""
    for i, (most, own) in enumerate(zip(hover.most.tolist(), hover.thrusts, strict=True), 1):
        worst = max(own, key=lambda f: max(-f, f - most))
        if not 0.0 <= worst <= most:
            yield warned(f"in hover a rotor of quadrotor {i} would give {worst:.4g} N and can give 0 to {most:.4g} N")


def payload_warnings(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for a true mass so small that the payload would have none."""
    scale = hover.plant.mass_scale
    if hover.payload_mass <= 0.0:
        yield warned(
            f"plant.mass_scale = {scale}: the joint forces assign all of the difference to the payload, "
            f"which would weigh {hover.payload_mass:.4g} kg"
        )
