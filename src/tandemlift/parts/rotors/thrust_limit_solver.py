"""Solver of the rotors' thrust limits: the thrusts within them that come closest to a desired wrench.

minimise ‖W(B f − τ)‖² + γ‖f − f₀‖² over 0 ≤ f ≤ f_max

B (4 × n) is the effect of n rotors on thrust [N] and on the moments about x, y, z [N·m, body axes], τ the desired
wrench, f₀ [N] the thrusts of the pseudo-inverse, W = diag(priority / row rms of B). γ > 0 makes the optimum
unique and f₀ itself the optimum if it is within the limits.

`limited_thrusts` is a primal active-set method with a warm start (Nocedal and Wright, Numerical Optimization, 16.5;
Härkegård, CDC 2002, for control allocation). With the rotors of the working set held at a limit and C = W B of the
others, the free ones, the optimum is one Newton step away: by Woodbury, with r = W(τ − B f) and g = Cᵀr + γ(f₀ − f),

f ← f + (g − Cᵀμ)/γ, μ = (γI + C Cᵀ)⁻¹ C g, r ← r − μ,

so that only a 4 × 4 matrix is ever solved, however many rotors there are. The form in r, not one in the thrusts alone,
keeps the last digits when part of the wrench is out of reach: r/γ is large then, and cancels.

A step chooses between values and does not branch, so it is traced as a law is; what repeats it is a loop, here and in
compiled flights. It is not fused: where thrusts meet their limits is decided by the same sums as in plain Python.
"""

from __future__ import annotations

import functools
import operator
from typing import NamedTuple

from tandemlift.core.algebra import absolute, where
from tandemlift.core.law import elementwise
from tandemlift.core.types import Condition, Number, PerRotor
from tandemlift.core.vector import each
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.rotors.allocation import AllocationState, Mixer
from tandemlift.parts.rotors.normal_equations import GAMMA, WrenchVector, factored, free_rotors, solved, summed_from

ACCURACY = 1e-9  # N, of every thrust, where the rounding of the given numbers allows it
ROUNDING = 2.220446049250313e-16  # of a double


class BoundedProblem(NamedTuple):
    """The problem to be minimised.

    `rows`: W B, `weighted_rows`, sets of n. `weights`: the diagonal of W, `weights_of`. `wanted`: τ [N, N·m body axes].
    `unlimited`: f₀ [N], a set. `limits`: f_max [N], a set, 0 for a rotor that is lost.
    """

    rows: Mixer
    weights: Wrench
    wanted: Wrench
    unlimited: PerRotor
    limits: PerRotor


class Search(NamedTuple):
    """A step's outcome; 1 or 0 each: whole steps are taken, this one is to be repeated, the search has ended."""

    found: AllocationState
    opening: Number
    repeated: Number
    ended: Number


def _numbered(like: PerRotor) -> PerRotor:
    """0, 1, 2, … as a set."""
    return each(len(like))(*map(float, range(len(like))))


@elementwise
def _top(limit: Number) -> Number:
    return where(limit > 0.0, limit, 0.0)


@elementwise
def _side(active: Number, top: Number) -> Number:
    return where(top > 0.0, where(active > 0.0, 1.0, 0.0) - where(active < 0.0, 1.0, 0.0), -1.0)


@elementwise
def _standing(thrust: Number, side: Number, top: Number) -> Number:
    x = where(thrust > 0.0, thrust, 0.0)
    return where(side == 0.0, where(x < top, x, top), where(side > 0.0, top, 0.0))


def feasible(limits: PerRotor, held: AllocationState) -> AllocationState:
    """A feasible working set and thrusts to start from. A rotor whose limit is not > 0 gets no thrust."""
    top = _top(limits)
    side = _side(held.active, top)
    return AllocationState(side, _standing(held.thrusts, side, top))


def _residual(p: BoundedProblem, thrusts: PerRotor) -> WrenchVector:
    """r = W(τ − B f)."""
    weights, wanted = (WrenchVector(u.thrust, *u.moment) for u in (p.weights, p.wanted))
    made = [row * thrusts for row in p.rows]
    return WrenchVector(
        *[functools.reduce(operator.sub, m, w * x) for w, x, m in zip(weights, wanted, made, strict=True)]
    )


def _transposed_times(rows: Mixer, four: WrenchVector) -> PerRotor:
    """Cᵀ x of four numbers x, for every rotor."""
    return rows.thrust * four.thrust + rows.roll * four.roll + rows.pitch * four.pitch + rows.yaw * four.yaw


def _largest(values: PerRotor) -> Number:
    """The largest of the sizes of values, at least 0."""
    return functools.reduce(lambda most, size: where(size > most, size, most), absolute(values), 0.0)


@elementwise
def _side_reached(active: Number, x: Number, top: Number) -> Number:
    """−1 where a whole step of a free rotor ends below 0, 1 where it ends above the limit, 0 else; held ones as are."""
    return where(active == 0.0, where(x < 0.0, -1.0, where(x > top, 1.0, 0.0)), active)


@elementwise
def _if_free(active: Number, moved: Number, before: Number) -> Number:
    return where(active == 0.0, moved, before)


@elementwise
def _within(x: Number, top: Number, before: Number) -> Number:
    """A thrust held within its limits; as it was before where it is no number."""
    return where(x < 0.0, 0.0, where(x > top, top, where(x >= 0.0, x, before)))


@elementwise
def _newly_held(active: Number, met: Number) -> Number:
    return absolute(met) * (1.0 - absolute(active))


def _clipped(p: BoundedProblem, now: AllocationState, pull: PerRotor) -> tuple[AllocationState, Condition]:
    """(The whole step, every free rotor that would leave its limits held there; whether there is such a rotor)."""
    x = now.thrusts + pull * (1.0 / GAMMA)
    met = _side_reached(now.active, x, p.limits)
    kept = _if_free(now.active, _within(x, p.limits, now.thrusts), now.thrusts)
    return AllocationState(met, kept), summed_from(0.0, _newly_held(now.active, met)) > 0.0


@elementwise
def _part(active: Number, before: Number, step: Number, top: Number) -> Number:
    """The share of a step that a free rotor can take; 1 where it meets no limit."""
    x = before + step
    bound = where(x < 0.0, 0.0, where(x > top, top, x))
    cut = (bound != x) & (active == 0.0)
    return where(cut, (bound - before) / where(cut, step, 1.0), 1.0)


@elementwise
def _side_met(number: Number, first: Number, active: Number, pull: Number) -> Number:
    return where(number == first, where(pull < 0.0, -1.0, 1.0), active)


@elementwise
def _at_side(number: Number, first: Number, kept: Number, side: Number, top: Number) -> Number:
    return where(number == first, where(side < 0.0, 0.0, top), kept)


def _advanced(p: BoundedProblem, now: AllocationState, pull: PerRotor) -> tuple[AllocationState, Condition]:
    """(The step as far as the first limit that a free rotor meets, and that rotor held; whether there is one)."""
    step, numbers = pull * (1.0 / GAMMA), _numbered(pull)
    share, first = 1.0, -1.0
    for i, part in enumerate(_part(now.active, now.thrusts, step, p.limits)):
        first, share = where(part < share, float(i), first), where(part < share, part, share)
    x = now.thrusts + step * share
    side = _side_met(numbers, first, now.active, pull)
    kept = _at_side(numbers, first, _within(x, p.limits, now.thrusts), side, p.limits)
    return AllocationState(side, _if_free(now.active, kept, now.thrusts)), first >= 0.0


@elementwise
def _inward(active: Number, pull: Number, size: Number, limit: Number) -> Number:
    """The gradient by which a held rotor is pulled back into its limits, 0 within rounding."""
    inward = -active * pull
    return where(limit > 0.0, where(inward > 4.0 * ROUNDING * size, inward, 0.0), 0.0)


def _to_release(p: BoundedProblem, active: PerRotor, r: WrenchVector, pull: PerRotor) -> Number:
    """The number of the held rotor that pulls hardest back into its limits; −1 if none does, beyond rounding."""
    sizes = [absolute(row * x) for row, x in zip(p.rows, r, strict=True)]
    inward = _inward(active, pull, sizes[0] + sizes[1] + sizes[2] + sizes[3], p.limits)
    hardest, found = GAMMA * ACCURACY, -1.0
    for i, size in enumerate(inward):
        found, hardest = where(size > hardest, float(i), found), where(size > hardest, size, hardest)
    return found


@elementwise
def _released(number: Number, free: Number, active: Number) -> Number:
    return where(number == free, 0.0, active)


def _either(condition: Condition, a: AllocationState, b: AllocationState) -> AllocationState:
    return AllocationState(where(condition, a.active, b.active), where(condition, a.thrusts, b.thrusts))


def search_step(p: BoundedProblem, s: Search) -> Search:
    """One iteration of the active-set method."""
    now, opening = s.found, s.opening > 0.0
    factor = factored(p.rows, now.active)
    r = _residual(p, now.thrusts)
    pull = _transposed_times(p.rows, r) + (p.unlimited - now.thrusts) * GAMMA
    freely = pull * free_rotors(now.active)
    mu = solved(factor, WrenchVector(*[summed_from(0.0, row * freely) for row in p.rows]))
    eased = pull - _transposed_times(p.rows, mu)
    clipped, was_clipped = _clipped(p, now, eased)
    advanced, was_cut = _advanced(p, now, eased)
    after = _either(opening, clipped, advanced)
    changed = (opening & was_clipped) | ((s.opening <= 0.0) & was_cut)
    still = where(changed, 0.0, 1.0)
    coarse = where(_largest(freely) * ROUNDING > GAMMA * ACCURACY, 1.0, 0.0)  # g loses its last digits in a long step
    again = still * coarse * (1.0 - s.repeated)  # once more, from close by
    quiet = still - again
    free = _to_release(p, after.active, r, eased)
    active = _released(_numbered(eased), where(quiet > 0.0, free, -1.0), after.active)
    ended = where(free < 0.0, quiet, 0.0)
    return Search(AllocationState(active, after.thrusts), s.opening * (1.0 - still), again, ended)


def start_search(limits: PerRotor, held: AllocationState) -> Search:
    """The start of the search: a working set and thrusts of any size, made feasible."""
    return Search(feasible(limits, held), 1.0, 0.0, 0.0)


def limited_thrusts(p: BoundedProblem, held: AllocationState, most: int) -> tuple[AllocationState, int]:
    """The thrusts within the limits that come closest to a desired wrench.

    Whatever happens, it ends after `most` steps with 0 ≤ f ≤ limits exactly. Until the first step that no limit cuts
    short, every rotor that would leave its limits is held; from then on the cost falls from step to step. 8 n steps are
    ample: 1 or 2 from the last working set, 5.4 n at worst from any other among millions of random problems. A NaN in
    the wrench or in `unlimited` leaves the thrusts as they are but for the limits; a limit that is NaN or not above 0
    is 0.

    Args:
        p: the problem.
        held: the working set to start from (zeros if none is known), −1 at 0, 1 at the limit, 0 free, and thrusts [N]
            of any size.
        most: bound on the number of steps.

    Returns:
        The working set and thrusts of the solution, and the number of steps taken; `most` if the bound cut it short.
    """
    search = start_search(p.limits, held)
    for step in range(1, most + 1):
        search = search_step(p, search)
        if search.ended > 0.0:
            return search.found, step
    return search.found, most
