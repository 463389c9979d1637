"""The table of checks, and all of them of a mission."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.core.errors import CLOSE, CheckResult, noted
from tandemlift.core.part import FlightCheck
from tandemlift.missions.facts import Facts
from tandemlift.missions.mission import PARTS, Mission
from tandemlift.missions.outcomes import promise_of
from tandemlift.parts.controllers.interface import tilt_limit_of
from tandemlift.parts.flight_checks import schedule_checks
from tandemlift.parts.flight_checks.authority import authority_checks
from tandemlift.parts.flight_checks.controller_checks import gain_checks, offset_checks, start_checks
from tandemlift.parts.flight_checks.hover_loads import Loads, WindOnParts, loads_of
from tandemlift.parts.flight_checks.loop_checks import loop_checks
from tandemlift.parts.flight_checks.sensing_checks import sensing_checks
from tandemlift.parts.mechanics.vehicle_checks import point_checks, push_checks
from tandemlift.parts.person.passage import passage_checks, way_checks

ROTORS = '`actuators.model = "rotors"`'
CHECKS = (
    FlightCheck(
        "thrust",
        "weight and the largest load downwards, with wind, and with pushes that carry it away",
        "usable part of the rotors' thrust with their faults: `compliance.thrust_fraction`, or 95 % if scheduled",
        "N",
        ROTORS,
        "`plant.mass_scale`, `compliance.thrust_fraction`, `vehicle.quadrotors`, `disturbance.force`, `pushes`",
    ),
    FlightCheck(
        "tilt",
        "horizontal force of disturbance, wind with 2 σ of turbulence, and pushes that carry it away",
        "force that `controller.max_tilt`, and the thrust beside the weight, can provide",
        "N",
        ROTORS,
        "`controller.max_tilt`, `wind`, `disturbance.force`, `pushes`",
    ),
    FlightCheck(
        "moment",
        "moment of disturbance, wind, and pushes that turn it away, about each axis",
        "85 % of the rotors' moment in hover at which the first one reaches a limit",
        "N m",
        ROTORS,
        "`disturbance.moment`, `pushes.*.point`, `allocation.weights`",
    ),
    FlightCheck(
        "push",
        "3 N of a hand for 3.5 kg, in proportion to the mass: down at the middle; level, and upright, above "
        "the outermost quadrotor. Beyond the limit it is close, and no failure",
        "push at which the first rotor reaches a limit in hover",
        "N",
        f"{ROTORS}, interactive guidance",
        "`vehicle.quadrotors`, `vehicle.payload`, `allocation.weights`",
    ),
    FlightCheck(
        "start",
        "speed and rates; moment and tilt that the controller, linear about hover, commands at the start by the "
        "pseudo-inverse",
        "5 m/s (of ideal rotors 10 m/s); 20 rad/s, and what the rotors stop in the air within 0.35 rad (yaw: 2 rad); 4 "
        "times the rotors' moment in hover at which the first one reaches a limit; 0.4 rad",
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
    *(row for part in PARTS for row in part.rows),
    FlightCheck(
        "passage",
        "radius of a quadrotor's guard",
        "its distance from the nearest wall on the person's path, with the heading kept, rotated or trailing",
        "m",
        "walls, and a person",
        "`corridor.width`, `person.model`, `person.path`",
    ),
)


@np.errstate(all="ignore")
def flight_checks(m: Mission) -> tuple[CheckResult, ...]:
    """The results of all checks of a mission, by closed forms, in the order of the parts."""
    facts = Facts(m)
    step, end, pilot, controller, hover = m.mission.step, m.mission.duration, m.pilot, m.controller, m.hover
    wind = WindOnParts(m.wind, hover.vehicle, m.initial.euler[2], step)
    by_hand, schedule = m.by_hand, schedule_checks.Schedule(m.phases, m.pushes, m.admittance, m.by_hand, end)
    compliant_yaw = by_hand is not None and by_hand.yaw.model == "compliant"
    each = loads_of(m.disturbance, wind, m.pushes, end, yielding_yaw=compliant_yaw)
    usable, longest = (None, end) if by_hand is None else (by_hand.thrust_fraction, by_hand.following.time)
    promised = (promise := promise_of(m.promise, pilot.guidance)).rms_promised(pilot.guidance)
    lands = m.ground.model == "none" and m.phases.land_start is not None and m.phases.land_start < end
    offsets = (promised, promised, min(promised, m.outcome.landed_height) if lands else promised)
    windy = wind.blows and pilot.push != "truth"  # wind on the payload counts as a push
    joined = windy or m.person.model != "none" or any(change.key.startswith("admittance") for change in m.changes)
    unobserved, over_floor = m.observer.model == "none", m.ground.model == "floor"
    loads = Loads(each, promise.distance, promise.tilt, promise.heading, longest, hover.response_time)
    checks: list[tuple[str, Iterator[CheckResult]]] = [  # each is computed on demand
        ("authority", authority_checks(hover, loads, usable, tilt_limit_of(controller))),
        ("start", start_checks(m.initial, hover, controller, step, running=m.phases.rotors == "always")),
        ("stiffness", gain_checks(controller)),
        *[("stiffness", offset_checks(controller, hover, step, wind, m.disturbance, offsets))] * unobserved,
        ("loop", loop_checks(m.control_loop)),
        ("sensing", sensing_checks(m.sensors, pilot, m.estimator, schedule, wind)),
        ("schedule", schedule_checks.lift_checks(schedule, m.outcome.lifted_height)),
        ("schedule", schedule_checks.haste_checks(schedule, hover)),
        ("schedule", schedule_checks.push_time_checks(schedule, m.estimator, pilot.push)),
        *[("schedule", schedule_checks.descent_checks(schedule))] * over_floor,
        ("schedule", schedule_checks.landing_checks(schedule)),
        ("schedule", way_checks(m.person, m.corridor, m.initial, m.phases, schedule.landing_duration, end)),
        ("push", push_checks(() if joined else m.pushes, m.admittance.threshold, compliant_yaw=compliant_yaw)),
        *((part.name, iter(facts.ask(part, part.checks))) for part in PARTS if part.checks and facts.has(part)),
        ("point", point_checks(m.pushes, hover.vehicle)),
        ("passage", passage_checks(m.person, m.corridor, m.all_walls, m.initial, hover.vehicle)),
    ]
    return tuple(dict.fromkeys(result for part, results in checks for result in _computable(f"{part} checks", results)))


def _computable(part: str, results: Iterator[CheckResult]) -> Iterator[CheckResult]:
    """Yield the results of a part, until numbers are too extreme to compute with."""
    try:
        yield from results
    except (ArithmeticError, np.linalg.LinAlgError):
        yield noted(part, f"the {part} end here: the mission's numbers are too extreme for them", verdict=CLOSE)
