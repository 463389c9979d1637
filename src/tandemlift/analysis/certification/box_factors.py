"""The factors of a box of parameters: proven to be stable by µ, and found to oscillate by a search."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from tandemlift.analysis.certification.hover_responses import Family, Hovers, family_at
from tandemlift.analysis.certification.structured_singular_value import TINY, Bound, upper_bound
from tandemlift.analysis.certification.uncertain_loop import DeviatingLoop, uncertain_loop
from tandemlift.analysis.certification.uncertainty import Values, box_at, largest_factor, weakens
from tandemlift.core.types import Array

EVERY = 4  # of the frequencies of a loop, at which µ is bounded
HIGH, CLOSER = 0.8, 17  # of the largest bound: a peak, with so many frequencies about it
ABOUT = 0.03  # of the frequency that is known
SMALLER = 0.99  # of a factor that is not proven
STARTS, SEED = 6, 1  # of the search
BETTER = 0.999  # of a factor, which is worth a change


def proven_factor(hovers: Hovers, deviations: DeviatingLoop, near: float) -> tuple[float, Array, Array]:
    """(the largest factor whose box has µ ≤ 1 at all frequencies, these [rad/s], bounds of µ of the box itself).

    The frequencies are closer about the peaks: µ of real parameters has sharp ones.

    Args:
        hovers: of the mission.
        deviations: of its vehicle.
        near: a frequency at which the loop is known to oscillate first [rad/s]; NaN if none is.
    """
    widths, w = deviations.widths, np.append(hovers.w[:-1:EVERY], hovers.w[-1])
    bounds = bounds_of(family_at(hovers, w), widths)
    values = np.array([0.0, *[bound.value for bound in bounds], 0.0])
    high = values[1:-1] > HIGH * values.max()
    peaks = np.flatnonzero(high & (values[1:-1] >= values[:-2]) & (values[1:-1] >= values[2:]))
    between = [np.geomspace(w[max(k - 1, 0)], w[min(k + 1, len(w) - 1)], CLOSER)[1:-1] for k in map(int, peaks)]
    critical = np.geomspace((1.0 - ABOUT) * near, (1.0 + ABOUT) * near, CLOSER) if near < w[-1] else w[-1:]
    w = np.unique(np.clip(np.concatenate([w, *between, critical]), w[0], w[-1]))
    family = family_at(hovers, w)
    bounds = bounds_of(family, widths)
    order = sorted(range(len(w)), key=lambda k: -bounds[k].value)

    def proves(factor: float) -> bool:
        box = box_at(widths, factor)
        loop = uncertain_loop(family, box)
        return deviations.stable({name: p.middle for name, p in box.items()}) and all(
            upper_bound(loop.M[k], loop.blocks, bounds[k], enough=1.0).value <= 1.0 for k in order
        )

    factor = min(1.0 / max(bounds[order[0]].value, TINY), largest_factor(widths))
    while not proves(factor):
        factor *= SMALLER
    return factor, w, np.array([bound.value for bound in bounds])


def bounds_of(family: Family, widths: Mapping[str, float]) -> list[Bound]:
    """The bounds of µ of a box at the frequencies of a family."""
    loop, bounds = uncertain_loop(family, box_at(widths, 1.0)), list[Bound]()
    for M in loop.M:
        bounds.append(upper_bound(M, loop.blocks, bounds[-1] if bounds else None))
    return bounds


def found_factor(deviations: DeviatingLoop, most: float, *, flyable: bool) -> tuple[float, Values]:
    """(the smallest factor of the box at which a search loses stability, in which direction), infinite up to `most`.

    From each start, one parameter after the other changes its sign while that makes the factor smaller; at the end,
    those that do not matter are 0. `flyable`: without rotors that are stronger than the pilot assumes.
    """
    rng, best, found = np.random.default_rng(SEED), math.inf, dict[str, float]()
    choices = {
        name: (0.0, 1.0) if name == "delay" else (-1.0, 0.0) if flyable and weakens(name) else (-1.0, 0.0, 1.0)
        for name in deviations.widths
    }
    for _ in range(STARTS):
        signs = {name: 1.0 if name == "lag" else float(rng.choice(choices[name])) for name in choices}
        factor, improved = min(deviations.limit(signs, most), most), True
        while improved:
            improved = False
            for name, sign in [(str(n), sign) for n in rng.permutation(list(choices)) for sign in choices[str(n)]]:
                other = {**signs, name: sign}
                smaller = deviations.limit(other, min(factor, best)) if other != signs else math.inf
                if smaller < BETTER * factor:
                    signs, factor, improved = other, smaller, True
        if factor < min(best, most):
            best, found = factor, signs
    for name in found:
        if not deviations.stable(deviations.along({**found, name: 0.0}, best / BETTER)):
            found[name] = 0.0
    return best, found
