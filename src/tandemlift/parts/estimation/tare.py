"""The tare: the bias of the sensors from their mean in hover over a window; and the payload's mass, if identified.

The means of the force F and the moment M on the payload are the bias, with the mass m = Σ f·a / Σ a·a. In hover a bias
of the joints' force along gravity cannot be distinguished from an error of the mass.

In flight, horizontal forces are compared with slow means of them.
"""

from __future__ import annotations

import math
from typing import Any, Generic, NamedTuple

from tandemlift.core.algebra import maximum, minimum, where
from tandemlift.core.law import choice, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass_step
from tandemlift.core.types import N, Number, NumberSet, number
from tandemlift.core.vector import Absent, Vec3, dot

TINY = 1e-24
"""N² or (m/s²)²: far below what any sensor shows; guards roots and divisions."""


class SideForces(NamedTuple, Generic[N]):
    """Force along body x and y on every quadrotor [N], less its mean over them (sets)."""

    x: N
    y: N


class ForceBand(NamedTuple, Generic[N]):
    """Memory of a horizontal force, of numbers or sets: low-passed along x and y, and its slow means."""

    x: LowPassState[N]
    y: LowPassState[N]
    mean_x: N
    mean_y: N


class TareSums(NamedTuple):
    """Over the samples of the tare: their count, Σ Σ f_i, Σ a, Σ M, Σ f·a, Σ a·a, and the sums of `SideForces`."""

    count: Any
    force: Vec3
    specific_force: Vec3
    moment: Vec3
    weight: Number
    square: Number
    sides: SideForces[NumberSet]


class Tare(NamedTuple):
    """The result of the tare: mass of the payload [kg], bias of force [N] and moment [N·m] (body axes) and sides."""

    mass: Number
    force: Vec3
    moment: Vec3
    sides: SideForces[NumberSet]


@law
def summed(
    sums: TareSums, begun: Number, taken: Number, f: Vec3, a: Vec3, moment: Vec3, unequal: SideForces[NumberSet]
) -> TareSums:
    """The sums with this sample if it is `taken` (1), or as they were (0); none before the tare has `begun` (0)."""
    return TareSums(
        sums.count * begun + taken,
        sums.force * begun + f * taken,
        sums.specific_force * begun + a * taken,
        sums.moment * begun + moment * taken,
        sums.weight * begun + dot(f, a) * taken,
        sums.square * begun + dot(a, a) * taken,
        SideForces(sums.sides.x * begun + unequal.x * taken, sums.sides.y * begun + unequal.y * taken),
    )


@law
def is_tared(start: Number, end: Number, count: Number, t: Number) -> Number:
    """1 once a tare from `start` until before `end` [s] is over that has a sample, and where there is none; else 0."""
    return where(t < end, 0.0, where(end < start, 1.0, minimum(count, 1.0)))


@law
def tare_of(mass: Number, identify: Number, sums: TareSums, armed: Number) -> Tare:
    """The tare from its sums once it is over (`armed` 1); before, the nominal mass [kg] and no bias.

    `identify` is 1 to identify the payload's mass, else 0.
    """
    identified = identify * armed * sums.square > 0.0
    found = where(identified, sums.weight / maximum(sums.square, TINY), mass)
    per_sample = armed / maximum(sums.count, 1.0)
    return Tare(
        found,
        (sums.specific_force * found - sums.force) * per_sample,
        sums.moment * per_sample,
        SideForces(sums.sides.x * per_sample, sums.sides.y * per_sample),
    )


def tare_fields(start: float | None, duration: float, identify_mass: bool) -> dict[str, float]:
    """The fields of an estimator's tare, from `start` [s] for a duration [s]; the end of none is before every time."""
    if start is None:
        return {"tare_start": 0.0, "tare_end": -math.inf, "identify": 0.0}
    return {"tare_start": number(start), "tare_end": start + duration, "identify": float(identify_mass)}


@law
def force_band_step(fast: LowPass, m: ForceBand[N], x: N, y: N, share: Number) -> ForceBand[N]:
    """The memory of a force after a step, of which its slow means follow a `share`."""
    after_x, after_y = low_pass_step(fast, m.x, x), low_pass_step(fast, m.y, y)
    return ForceBand(
        after_x,
        after_y,
        m.mean_x + (after_x.value - m.mean_x) * share,
        m.mean_y + (after_y.value - m.mean_y) * share,
    )


@law
def deviation(m: ForceBand[N]) -> SideForces[N]:
    """A force less its slow mean [N]."""
    return SideForces(m.x.value - m.mean_x, m.y.value - m.mean_y)


@choice(absent=Absent())
def restarted(m: ForceBand[N] | Absent, restart: Number) -> Any:
    """A memory whose slow means are the present force if it is to `restart` (1)."""


@restarted.register(ForceBand)
def _restarted(m: ForceBand[N], restart: Number) -> ForceBand[N]:
    return m._replace(
        mean_x=m.mean_x + (m.x.value - m.mean_x) * restart, mean_y=m.mean_y + (m.y.value - m.mean_y) * restart
    )
