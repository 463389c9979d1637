"""`tl.check`: all checks of a mission before its flight, with the margins of its loops by their linear model."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from tandemlift.analysis.certification.shakes import shake_checks
from tandemlift.analysis.certification.structure import structure_in_loop_checks
from tandemlift.analysis.linearization.linear_model import Mode, modes_of
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import (
    NO_KINK,
    OpenLoop,
    axis_margins,
    calm_mission,
    is_stable,
    largest,
    open_loop,
    rotor_delay_and_lag,
)
from tandemlift.core.errors import CLOSE, FAILS, REFUSED, CheckResult, InputError, judged, noted
from tandemlift.missions import MissionLike, mission_of
from tandemlift.missions.checks import FlightCheck, mission_checks

NEAR_PHASE = 1.0 / 6.0  # of 180 deg: less than 30 deg of phase left is close
NEAR_GAIN = 0.4  # a gain that may grow by less than a factor of 1.7, or fall by less, is close
NEAR_DELAY = 0.3
MODE_COUNT = 5  # modes that are checked

LOOP_CHECKS = (
    FlightCheck("loop phase", "phase lag of an axis where its loop's gain is 1", "180°", "deg", "", "the gains"),
    FlightCheck(
        "loop gain",
        "1 for *most*; the factor to which the gain of an axis may fall, for *least*",
        "the factor by which the gain may grow; 1. The limit that the smaller change reaches is the *nearer*",
        "1",
        "",
        "the gains",
    ),
    FlightCheck(
        "loop delay",
        "delay of the rotors",
        "the delay at which the linear model oscillates, by bisection",
        "ms",
        "",
        "`actuators.delay`",
    ),
    FlightCheck(
        "loop lag",
        "lag of the rotors, the mean of up and down",
        "the lag at which the linear model oscillates, by bisection",
        "ms",
        "",
        "`vehicle.quadrotors.*.lag_up` and `lag_down`",
    ),
    FlightCheck(
        "shake",
        "how far a sine of 3 N for 3.5 kg, in proportion to the mass, lets the vehicle sink, stray and turn from its "
        "reference in flights of 8 s: 0.5 to 10 Hz, each axis, in the payload's middle and near its ends. Beyond the "
        "limits of straying and turning it is close, and no failure",
        "0.1 m; 0.25 m; 5°",
        "m, deg",
        '`actuators.model = "rotors"`, interactive guidance',
        "`compliance.force_lead`, `compliance.input_bandwidth`, `allocation.priorities`, `vehicle.quadrotors`",
    ),
    FlightCheck(
        "structure",
        "less the damping ratio, in flight, of each mode of a beam that bends or of mounts that give",
        "0",
        "1",
        "a beam that bends, or mounts that give",
        "`allocation.notches`, `vehicle.payload`, the gains",
    ),
    FlightCheck("loop mode", "less the damping ratio of each of the least damped modes", "0", "1", "", "the gains"),
)


def check(mission: MissionLike) -> tuple[CheckResult, ...]:
    """All checks of a mission: closed forms, inconsistent settings, and its loops by their linear model.

    Args:
        mission: or its name or path; flown to a hover without disturbances, to be linearized there.

    Returns:
        A result for each check; its verdict is "ok", "close" or "fails"; or the one that is "refused".
    """
    mission = mission_of(mission)
    results = tuple(mission_checks(mission))
    if results and results[-1].verdict == REFUSED:
        return results
    try:
        if mission.is_elastic:
            results = (*results, *structure_in_loop_checks(mission))
            if any(r.check == "structure" and r.verdict == FAILS for r in results):
                return results  # whatever else is flown shakes as well
        if mission.pilot.guidance == "interactive" and mission.actuators.model == "rotors":
            results = (*results, *shake_checks(mission))
        loop = open_loop(mission)
    except InputError as error:
        return *results, noted("loop", f"there is no linear model: {error}", verdict=CLOSE)
    if not loop.stable:
        text = (
            "the hover is unstable even without delay and lag of the rotors: see what fails above, or lower the gains"
        )
        return *results, noted("loop", text, verdict=FAILS)
    delay, lag = rotor_delay_and_lag(mission.hover)
    limits = (*results, *delay_and_lag_limits(loop, delay, lag))
    if not is_stable(loop, delay, lag):
        return limits
    calm, at = calm_mission(mission, slow=1.0)
    closed = linearize(calm, at, kink_tolerance=NO_KINK).connected()
    return *limits, *margins(loop, delay, lag), *modes(modes_of(closed).modes)


def delay_and_lag_limits(loop: OpenLoop, delay: float, lag: float) -> Iterator[CheckResult]:
    """Check the delay that the loop tolerates with the rotors' lag, and the lag with their delay."""
    bears_lag, bears_delay = is_stable(loop, 0.0, lag), is_stable(loop, delay, 0.0)
    if bears_lag:
        most = 1e3 * largest(lambda x: is_stable(loop, x, lag))
        text = (
            f"with a lag of {1e3 * lag:.3g} ms the loops oscillate from a delay of {most:.3g} ms on, and "
            f"actuators.delay is {1e3 * delay:.3g} ms: lower it, or the gains of [controller]"
        )
        yield judged("loop delay", 1e3 * delay, most, "ms", text, near=NEAR_DELAY)
    if bears_delay:
        most = 1e3 * largest(lambda x: is_stable(loop, delay, x))
        text = (
            f"with a delay of {1e3 * delay:.3g} ms the loops oscillate from a lag of {most:.3g} ms on, and that of the "
            f"rotors is {1e3 * lag:.3g} ms: lower their lag_up and lag_down, or the gains of [controller]"
        )
        yield judged("loop lag", 1e3 * lag, most, "ms", text, near=NEAR_DELAY)
    if not bears_lag and not bears_delay:
        text = (
            f"the loops oscillate with a delay of {1e3 * delay:.3g} ms alone and with a lag of {1e3 * lag:.3g} ms "
            "alone: lower both, or the gains of [controller]"
        )
        yield noted("loop", text, verdict=FAILS)


def margins(loop: OpenLoop, delay: float, lag: float) -> Iterator[CheckResult]:
    """Phase and gain margin of each axis, with the other loops closed."""
    for margin in axis_margins(loop.w, loop.L @ loop.rotors.wrench(loop.w, delay, lag)):
        if not math.isnan(margin.phase):
            text = f"the {margin.axis} loop lacks {-margin.phase:.3g} deg of phase at {margin.crossover:.3g} rad/s"
            yield judged("loop phase", 180.0 - margin.phase, 180.0, "deg", text, subject=margin.axis, near=NEAR_PHASE)
        for name, value, limit in (("most", 1.0, margin.gain), ("least", margin.least_gain, 1.0)):
            nearer = margin.nearest_gain in (value, limit)
            subject = f"{margin.axis}, {name}{' (nearer)' if nearer else ''}"
            yield judged("loop gain", value, limit, "1", "", subject=subject, near=NEAR_GAIN)


def modes(every: Iterable[Mode]) -> Iterator[CheckResult]:
    """Check that no mode grows: the least damped ones."""
    for mode in sorted((mode for mode in every if mode.frequency > 0.0), key=lambda mode: mode.damping)[:MODE_COUNT]:
        names = ", ".join(name for name, _ in mode.states[:2])
        text = f"a mode of {mode.frequency:.3g} Hz grows: {names}"
        yield judged("loop mode", -mode.damping, 0.0, "1", text, subject=f"{mode.frequency:.3g} Hz: {names}")
