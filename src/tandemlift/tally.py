"""Running sums over every step of a flight, from which its metrics are formed: memory does not grow with the steps."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from tandemlift.law import law
from tandemlift.ops import absolute, maximum, minimum
from tandemlift.vector import ZERO, Vec3

LATE = 10.0  # s: "after 10 s" leaves the disturbed start out


class Errors(NamedTuple):
    """What a step adds to the tally: errors are desired minus actual, world axes or Euler angles; SI units."""

    position: Vec3
    velocity: Vec3
    attitude: Vec3
    tilt: Vec3
    thrust: Any
    moment: Vec3
    push: Vec3
    power: Any
    saturated: Any
    hearing: Any


class Tally(NamedTuple):
    """Sums and extremes over a stretch of steps; `triggers`: how often a push came to be heard; if one is now."""

    steps: Any
    position_squares: Vec3
    position_max: Vec3
    velocity_max: Vec3
    attitude_squares: Vec3
    tilt_max: Vec3
    thrust_min: Any
    thrust_max: Any
    moment_max: Vec3
    push_sum: Vec3
    power_sum: Any
    saturated: Any
    triggers: Any
    hearing: Any


EMPTY = Tally(0.0, ZERO, ZERO, ZERO, ZERO, ZERO, math.inf, -math.inf, ZERO, ZERO, 0.0, 0.0, 0.0, 0.0)


@law
def count(c: Tally, x: Errors) -> Tally:
    """The tally with one more step."""
    return Tally(
        c.steps + 1.0,
        c.position_squares + x.position * x.position,
        maximum(c.position_max, absolute(x.position)),
        maximum(c.velocity_max, absolute(x.velocity)),
        c.attitude_squares + x.attitude * x.attitude,
        maximum(c.tilt_max, absolute(x.tilt)),
        minimum(c.thrust_min, x.thrust),
        maximum(c.thrust_max, x.thrust),
        maximum(c.moment_max, absolute(x.moment)),
        c.push_sum + x.push,
        c.power_sum + x.power,
        c.saturated + x.saturated,
        c.triggers + x.hearing * (1.0 - c.hearing),
        x.hearing,
    )


def _root_mean(squares: Any, steps: float) -> list[float] | None:
    return [math.sqrt(s / steps) for s in squares] if steps else None


def summary(early: Tally, late: Tally, step: float) -> dict[str, Any]:
    """The metrics from the tallies before and after `LATE`, with steps of `step` [s]; None where there is none."""
    steps = early.steps + late.steps
    return {
        "position_rmse_m": _root_mean(early.position_squares + late.position_squares, steps),
        "position_rmse_after_10s_m": _root_mean(late.position_squares, late.steps),
        "position_max_error_m": list(maximum(early.position_max, late.position_max)) if steps else None,
        "position_max_error_after_10s_m": list(late.position_max) if late.steps else None,
        "attitude_rmse_rad": _root_mean(early.attitude_squares + late.attitude_squares, steps),
        "velocity_max_error_after_10s_m_s": list(late.velocity_max) if late.steps else None,
        "max_tilt_after_10s_rad": list(late.tilt_max) if late.steps else None,
        "thrust_min_after_10s_n": late.thrust_min if late.steps else None,
        "thrust_max_after_10s_n": late.thrust_max if late.steps else None,
        "moment_max_abs_after_10s_n_m": list(late.moment_max) if late.steps else None,
        "human_impulse_n_s": list((early.push_sum + late.push_sum) * step),
        "human_work_j": (early.power_sum + late.power_sum) * step,
        "push_triggers_after_10s": late.triggers if late.steps else None,
        "rotor_saturated_share": (early.saturated + late.saturated) / steps if steps else None,
    }
