"""Errors of an estimated push against the true one, as sums over the steps in which it is used.

With e the error of the force and ΔF the change of the true push in a step, a delay δ leaves e = −δ Ḟ at first order.
Least squares over all steps give δ = −dt Σ e·ΔF / Σ ΔF·ΔF.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from tandemlift.core.law import law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Absent, Vec3, dot


class EstimateErrors(NamedTuple):
    """Sums over steps: their count, squares of the errors of force [N²] and moment [N²·m²], e·ΔF and ΔF·ΔF [N²].

    `push`: the true one in the last step [N].
    """

    steps: Number
    force_squares: Vec3
    moment_squares: Vec3
    along_change: Number
    change_squares: Number
    push: Vec3


class PushErrors(NamedTuple):
    """A step: 1 if the push is used, else 0; errors of force [N, world axes] and moment [N·m, body]; the true push."""

    used: Number
    force: Vec3
    moment: Vec3
    push: Vec3


NO_ERRORS = EstimateErrors(0.0, ZERO, ZERO, 0.0, 0.0, ZERO)


@law(absent="sums")
def with_errors(sums: EstimateErrors, x: PushErrors) -> EstimateErrors:
    """The sums with one more step."""
    change = (x.push - sums.push) * x.used
    return EstimateErrors(
        steps=sums.steps + x.used,
        force_squares=sums.force_squares + x.force * x.force * x.used,
        moment_squares=sums.moment_squares + x.moment * x.moment * x.used,
        along_change=sums.along_change + dot(x.force, change),
        change_squares=sums.change_squares + dot(change, change),
        push=x.push,
    )


def error_metrics(early: EstimateErrors | Absent, late: EstimateErrors | Absent, step: float) -> dict[str, Any]:
    """The metrics of two spans of a flight with steps of `step` [s]; none without sums."""
    both = [sums for sums in (early, late) if isinstance(sums, EstimateErrors)]
    if not both:
        return {}
    steps, along, square = (sum(getattr(s, x) for s in both) for x in ("steps", "along_change", "change_squares"))
    force, moment = (
        [math.sqrt(sum(getattr(s, x)[axis] for s in both) / steps) for axis in range(3)] if steps else None
        for x in ("force_squares", "moment_squares")
    )
    delay = -step * along / square if square > 0.0 else None
    return {"push_force_rmse_n": force, "push_moment_rmse_n_m": moment, "push_delay_s": delay}
