"""The table of checks, and all of them of a mission."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import CLOSE, FAILS, SETTINGS, CheckResult, noted
from tandemlift.missions.flight_checks.authority import authority_checks
from tandemlift.missions.flight_checks.loops import loop_checks
from tandemlift.missions.flight_checks.passage import passage_checks
from tandemlift.missions.flight_checks.pushes import point_checks, push_checks
from tandemlift.missions.flight_checks.schedule import schedule_checks
from tandemlift.missions.flight_checks.sensing import sensing_checks
from tandemlift.missions.flight_checks.start import start_checks
from tandemlift.missions.flight_checks.stiffness import stiffness_checks
from tandemlift.missions.tables.mission import Mission


class FlightCheck(NamedTuple):
    """A check: its name, value, limit and unit, the missions to which it applies, and the keys that change it."""

    name: str
    value: str
    limit: str
    unit: str
    applies: str
    keys: str


ROTORS = '`actuators.model = "rotors"`'
CHECKS = (
    FlightCheck(
        "thrust",
        "weight and the largest load downwards, with pushes and wind",
        "usable part of the rotors' thrust with their faults: `compliance.thrust_fraction`, or 95 % if scheduled",
        "N",
        ROTORS,
        "`plant.mass_scale`, `compliance.thrust_fraction`, `vehicle.quadrotors`, `disturbance.force`, `pushes`",
    ),
    FlightCheck(
        "supervised lift",
        "weight that the pilot assumes",
        "`supervision.checks.thrust_fraction` of the thrust",
        "N",
        '`supervision.model = "on"`',
        "`supervision.checks.thrust_fraction`",
    ),
    FlightCheck(
        "tilt",
        "horizontal force of disturbance, wind with 2 σ of turbulence, and pushes, at the worst time",
        "force that `controller.max_tilt`, and the thrust beside the weight, can provide",
        "N",
        ROTORS,
        "`controller.max_tilt`, `wind`, `disturbance.force`, `pushes`",
    ),
    FlightCheck(
        "moment",
        "moment of disturbance, wind and pushes about each axis",
        "85 % of the rotors' moment in hover at which the first one reaches a limit",
        "N m",
        ROTORS,
        "`disturbance.moment`, `pushes.*.point`, `allocation.weights`",
    ),
    FlightCheck(
        "start",
        "speed and rates; moment and tilt that the controller commands at the start by the pseudo-inverse",
        "5 m/s (of ideal rotors 10 m/s); 20 rad/s, and what the rotors stop in the air within 0.35 rad (yaw: 2 rad); 4 "
        "times what the rotors can give in hover; 0.4 rad",
        "m/s, rad/s, N m, rad",
        "",
        "`initial`, the controller's gains, `allocation.method`",
    ),
    FlightCheck(
        "gain",
        "`lambda_1` and `lambda_2` of `nftsmc`",
        "above 0 along each axis",
        "",
        '`controller.name = "nftsmc"`',
        "`controller.gains`",
    ),
    FlightCheck(
        "offset",
        "constant unknown force over the controller's stiffness along each axis",
        "`promise.rms_distance`; along z, to land without a floor, `outcome.landed_height`",
        "m",
        '`observer.model = "none"`',
        "`observer.model`, `plant.mass_scale`, `disturbance.force`, the controller's gains",
    ),
    FlightCheck(
        "delay",
        "delay of rotors, step and readings",
        "delay margin of the loop of z, roll, pitch or yaw, with the rotors' lag",
        "ms",
        ROTORS,
        "`actuators.delay`, `sensors.delay`, `vehicle.quadrotors.*.lag_up`, the controller's gains",
    ),
    FlightCheck(
        "wind on the payload",
        "2 σ of the turbulent wind's force on the payload; that of mean wind and gusts less the tare",
        "`admittance.threshold`; in turbulence, gusts that carry the reference by up to 2 m are left out",
        "N",
        "wind, and a push that is measured",
        "`admittance.threshold`, `wind.turbulence`, `wind.gusts`, `estimator.wind_compensation`",
    ),
    FlightCheck(
        "sampling",
        "interval and delay of the joints' and inertial sensors, and of the motion sensor",
        "π over the bandwidth of the push's low-pass; 1 over that of the estimator; at least 0.1 s",
        "s",
        "a push, a state that is measured",
        "`sensors.interval`, `sensors.delay`, `sensors.motion.interval`, `sensors.motion.delay`",
    ),
    FlightCheck(
        "noise",
        "4 σ of the measured push's noise behind its low-pass",
        "the smallest `admittance.threshold`",
        "N",
        "a push that is measured",
        "`admittance.threshold`, `sensors.joints.force_noise`, `compliance.input_bandwidth`",
    ),
    FlightCheck(
        "haste",
        "largest acceleration of the lift and, if scheduled, of the landing",
        "largest acceleration within the thrust range; 100 m/s² for ideal actuators",
        "m/s²",
        "",
        "`phases.lift_duration`, `phases.land_duration`, `phases.height`",
    ),
    FlightCheck(
        "descent",
        "distance by which pushes move the reference down",
        "the height of the lift",
        "m",
        "a floor",
        "`pushes`, `phases.height`",
    ),
    FlightCheck(
        "schedule",
        "end of the landing, of a person's path, of lift and tare before a push; a lift below `outcome.lifted_height`",
        "the end of the mission; the time of the push",
        "s",
        "",
        "`mission.duration`, `phases`, `pushes.*.time`, `person.speed`",
    ),
    FlightCheck(
        "push",
        "`admittance.threshold`",
        "force of a push, with others at the same time, along one axis or more",
        "N",
        "a push of the mission",
        "`pushes.*.force`, `admittance.threshold`",
    ),
    FlightCheck(
        "push point",
        "distance of a push's point from the box of all parts",
        "5 cm",
        "m",
        "a push of the mission",
        "`pushes.*.point`",
    ),
    FlightCheck(
        "passage",
        "radius of a quadrotor's guard",
        "its distance from the nearest wall on the person's path, with the heading kept, rotated or trailing",
        "m",
        "walls, and a person",
        "`corridor.width`, `person.model`, `person.path`",
    ),
)

PARTS: tuple[Callable[[Mission], Iterator[CheckResult]], ...] = (
    authority_checks,
    start_checks,
    stiffness_checks,
    loop_checks,
    sensing_checks,
    schedule_checks,
    push_checks,
    point_checks,
    passage_checks,
)


def flight_checks(m: Mission) -> tuple[CheckResult, ...]:
    """The results of all checks of a mission, by closed forms."""
    with np.errstate(all="ignore"):
        return tuple(result for part in PARTS for result in _results(part, m))


def _results(part: Callable[[Mission], Iterator[CheckResult]], m: Mission) -> Iterator[CheckResult]:
    """Yield the results of a part, until numbers are too extreme to compute with."""
    try:
        yield from part(m)
    except (ArithmeticError, np.linalg.LinAlgError):
        name = part.__name__.replace("_", " ")
        yield noted(name, f"the {name} end here: the mission's numbers are too extreme for them", verdict=CLOSE)


def worst_failures(results: Iterable[CheckResult]) -> Iterator[CheckResult]:
    """The worst failure of each check, and every failure of settings."""
    failed: dict[str, list[CheckResult]] = {}
    for result in results:
        if result.verdict == FAILS:
            failed.setdefault(result.text if result.check == SETTINGS else result.check, []).append(result)
    yield from (max(many, key=_excess) for many in failed.values())


def _excess(result: CheckResult) -> float:
    """The excess of a result over its limit, as a fraction of the limit."""
    if result.value is None or result.limit is None or result.limit <= 0.0:
        return float("inf")
    return result.value / result.limit
