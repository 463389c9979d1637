"""Allocation within the rotors' limits: the thrusts that come closest to a wanted wrench, and how much of it they give.

minimise ‖W(B f − τ)‖² + γ‖f − f₀‖² over 0 ≤ f ≤ f_max

B (4 × n) is the effect of n rotors on thrust [N] and on the moments about x, y, z [N·m, body axes], τ the wanted
wrench, f₀ [N] the thrusts that the pseudo-inverse asks for, W = diag(priority / row rms of B). γ > 0 makes the optimum
unique and f₀ itself the optimum if it is within the limits.

`limited` is a primal active-set method with a warm start (Nocedal and Wright, Numerical Optimization, 16.5; Härkegård,
CDC 2002, for control allocation). With the rotors of the working set held at a limit and C = W B of the others, free,
the optimum is one Newton step away: by Woodbury, with r = W(τ − B f) and g = Cᵀr + γ(f₀ − f),

f ← f + (g − Cᵀμ)/γ, μ = (γI + C Cᵀ)⁻¹ C g, r ← r − μ,

so that only a 4 × 4 matrix is ever solved, however many rotors there are. The form in r, not one in the thrusts alone,
keeps the last digits when part of the wrench is out of reach: r/γ is large then, and cancels.

These functions loop, so they are no laws; they keep to floats, indices and arrays that are passed in, and compile as
they are, `PARTS` inlined into `limited`. Inside the loops they choose between values and do not branch: which rotor is
at a limit cannot be foreseen, and a processor that guesses it wrong loses more than the work saved.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.law import law
from tandemlift.laws.allocation import Mixer, wrench
from tandemlift.laws.body import Wrench
from tandemlift.ops import clip, sqrt, where
from tandemlift.vector import Vec3, dot

Array = NDArray[np.float64]
Four = tuple[float, float, float, float]
Ten = tuple[float, float, float, float, float, float, float, float, float, float]

ACCURACY = 1e-9  # N, of every thrust, where the rounding of the given numbers allows it
ROUNDING = 2.220446049250313e-16  # of a double


def weights_of(effect: Array, priorities: Any) -> Array:
    """The diagonal of W (4): priority over row rms of the effect B (4 × n), so that priorities compare rotor for rotor.

    Args:
        effect: B (4 × n), rows thrust, roll, pitch, yaw.
        priorities: four numbers > 0, thrust, roll, pitch, yaw.
    """
    return np.asarray(priorities, dtype=float) / np.sqrt(np.mean(np.square(effect), axis=1))


def weighted_rows(effect: Array, weights: Array) -> Array:
    """W B (4 × n), C-contiguous, as `limited` takes it."""
    return np.ascontiguousarray(weights[:, None] * effect)


def share_scale(effect: Array) -> Wrench:
    """1 / row rms of the effect B (4 × n): what makes the four components of a wrench comparable in `given_share`."""
    thrust, roll, pitch, yaw = (float(w) for w in weights_of(effect, np.ones(4)))
    return Wrench(thrust, Vec3(roll, pitch, yaw))


@law
def given_share(effect: Mixer, scale: Wrench, wanted: Wrench, thrusts: Any) -> Any:
    """Share of a wanted wrench that thrusts give: 1 − ‖B f − τ‖/‖τ‖ in the measure of `scale`, within [0, 1]; 1 at 0.

    Args:
        effect: B, by rows.
        scale: one over the size of each component, as of `share_scale`.
        wanted: τ [N, N·m body axes].
        thrusts: f [N], a set.
    """
    made = wrench(effect, thrusts)
    short, moment = (made.thrust - wanted.thrust) * scale.thrust, (made.moment - wanted.moment) * scale.moment
    whole, turning = wanted.thrust * scale.thrust, wanted.moment * scale.moment
    size = whole * whole + dot(turning, turning)
    lost = (short * short + dot(moment, moment)) / where(size > 0.0, size, 1.0)
    return where(size > 0.0, clip(1.0 - sqrt(lost), 0.0, 1.0), 1.0)


def _placed(limits: Array, active: Array, f: Array) -> None:
    """Make the working set and the thrusts that a solution starts from feasible. A rotor without a limit > 0 stands."""
    for i in range(f.size):
        top = limits[i] if limits[i] > 0.0 else 0.0
        side = (1.0 if active[i] > 0.0 else 0.0) - (1.0 if active[i] < 0.0 else 0.0)
        side = side if top > 0.0 else -1.0
        x = f[i] if f[i] > 0.0 else 0.0
        x = x if x < top else top
        active[i] = side
        f[i] = x if side == 0.0 else (top if side > 0.0 else 0.0)


def _gram(rows: Array, gamma: float, active: Array) -> Ten:
    """γI + C Cᵀ over the free rotors, lower triangle by columns."""
    tt = rr = pp = yy = gamma
    rt = pt = yt = pr = yr = yp = 0.0
    for i in range(active.size):
        free = 1.0 - abs(active[i])
        t, r, p, y = rows[0, i], rows[1, i], rows[2, i], rows[3, i]
        ft, fr, fp, fy = t * free, r * free, p * free, y * free
        tt += ft * t
        rt += fr * t
        pt += fp * t
        yt += fy * t
        rr += fr * r
        pr += fp * r
        yr += fy * r
        pp += fp * p
        yp += fy * p
        yy += fy * y
    return tt, rt, pt, yt, rr, pr, yr, pp, yp, yy


def _factored(rows: Array, gamma: float, active: Array) -> Ten:
    """L D Lᵀ = γI + C Cᵀ: the six numbers of L by columns, then 1/D. No pivot is below γ but for rounding."""
    tt, rt, pt, yt, rr, pr, yr, pp, yp, yy = _gram(rows, gamma, active)
    t = 1.0 / tt
    lrt, lpt, lyt = rt * t, pt * t, yt * t
    r = 1.0 / max(rr - lrt * rt, gamma)
    pr, yr = pr - lpt * rt, yr - lyt * rt
    lpr, lyr = pr * r, yr * r
    p = 1.0 / max(pp - lpt * pt - lpr * pr, gamma)
    yp = yp - lyt * pt - lyr * pr
    lyp = yp * p
    y = 1.0 / max(yy - lyt * yt - lyr * yr - lyp * yp, gamma)
    return lrt, lpt, lyt, lpr, lyr, lyp, t, r, p, y


def _solved(factor: Ten, b: Four) -> Four:
    """(L D Lᵀ)⁻¹ b."""
    lrt, lpt, lyt, lpr, lyr, lyp, t, r, p, y = factor
    u0 = b[0]
    u1 = b[1] - lrt * u0
    u2 = b[2] - lpt * u0 - lpr * u1
    u3 = b[3] - lyt * u0 - lyr * u1 - lyp * u2
    x3 = u3 * y
    x2 = u2 * p - lyp * x3
    x1 = u1 * r - lpr * x2 - lyr * x3
    x0 = u0 * t - lrt * x1 - lpt * x2 - lyt * x3
    return x0, x1, x2, x3


def _missing(rows: Array, weights: Array, wanted: Any, f: Array) -> Four:
    """r = W(τ − B f)."""
    r0, r1, r2, r3 = weights[0] * wanted[0], weights[1] * wanted[1], weights[2] * wanted[2], weights[3] * wanted[3]
    for i in range(f.size):
        r0 -= rows[0, i] * f[i]
        r1 -= rows[1, i] * f[i]
        r2 -= rows[2, i] * f[i]
        r3 -= rows[3, i] * f[i]
    return r0, r1, r2, r3


def _pulled(rows: Array, unlimited: Array, gamma: float, active: Array, f: Array, r: Four, pull: Array) -> Any:
    """Store g of all rotors, half the cost's slope downhill, in `pull`; (C g, largest |g|) of the free ones."""
    h0 = h1 = h2 = h3 = largest = 0.0
    for i in range(f.size):
        c0, c1, c2, c3 = rows[0, i], rows[1, i], rows[2, i], rows[3, i]
        g = c0 * r[0] + c1 * r[1] + c2 * r[2] + c3 * r[3] + gamma * (unlimited[i] - f[i])
        pull[i] = g
        free = g * (1.0 - abs(active[i]))
        h0 += c0 * free
        h1 += c1 * free
        h2 += c2 * free
        h3 += c3 * free
        size = abs(free)
        largest = size if size > largest else largest
    return (h0, h1, h2, h3), largest


def _eased(rows: Array, mu: Four, pull: Array) -> None:
    """g − Cᵀμ in `pull`: γ times a free rotor's step to the optimum, the multiplier there of one that is held."""
    for i in range(pull.size):
        pull[i] -= rows[0, i] * mu[0] + rows[1, i] * mu[1] + rows[2, i] * mu[2] + rows[3, i] * mu[3]


def _clipped(limits: Array, gamma: float, active: Array, f: Array, pull: Array) -> bool:
    """The whole step, every free rotor that would leave its limits held there; whether there is such a rotor."""
    inverse, found = 1.0 / gamma, 0.0
    for i in range(f.size):
        before, top, side = f[i], limits[i], active[i]
        x = before + pull[i] * inverse
        met = -1.0 if x < 0.0 else (1.0 if x > top else 0.0)
        kept = 0.0 if x < 0.0 else (top if x > top else (x if x >= 0.0 else before))
        found += abs(met) * (1.0 - abs(side))
        active[i] = met if side == 0.0 else side
        f[i] = kept if side == 0.0 else before
    return found > 0.0


def _advanced(limits: Array, gamma: float, active: Array, f: Array, pull: Array) -> bool:
    """The step as far as the first limit that a free rotor meets, and that rotor held; whether there is one."""
    inverse, share, first = 1.0 / gamma, 1.0, -1
    for i in range(f.size):
        before, top = f[i], limits[i]
        step = pull[i] * inverse
        x = before + step
        bound = 0.0 if x < 0.0 else (top if x > top else x)
        cut = bound != x and active[i] == 0.0
        part = (bound - before) / (step if cut else 1.0)
        part = part if cut else 1.0
        first = i if part < share else first
        share = part if part < share else share
    for i in range(f.size):
        before, top, side = f[i], limits[i], active[i]
        x = before + share * (pull[i] * inverse)
        kept = 0.0 if x < 0.0 else (top if x > top else (x if x >= 0.0 else before))
        met = -1.0 if pull[i] < 0.0 else 1.0
        kept = kept if i != first else (0.0 if met < 0.0 else top)
        active[i] = met if i == first else side
        f[i] = kept if side == 0.0 else before
    return first >= 0


def _held_in_vain(rows: Array, limits: Array, gamma: float, active: Array, r: Four, pull: Array) -> int:
    """The held rotor that pulls hardest back into its limits; −1 if none does, beyond rounding."""
    hardest, found = gamma * ACCURACY, -1
    for i in range(pull.size):
        size = abs(rows[0, i] * r[0]) + abs(rows[1, i] * r[1]) + abs(rows[2, i] * r[2]) + abs(rows[3, i] * r[3])
        inward = -active[i] * pull[i]
        inward = inward if inward > 4.0 * ROUNDING * size else 0.0
        inward = inward if limits[i] > 0.0 else 0.0
        found = i if inward > hardest else found
        hardest = inward if inward > hardest else hardest
    return found


def limited(
    rows: Array,
    weights: Array,
    wanted: Any,
    unlimited: Array,
    limits: Array,
    gamma: float,
    active: Array,
    f: Array,
    scratch: Array,
    most: int,
) -> int:
    """The thrusts within the limits that come closest to a wanted wrench.

    Whatever happens, it ends after `most` steps with 0 ≤ f ≤ limits exactly. Until the first step that no limit cuts
    short, every rotor that would leave its limits is held; from then on the cost falls from step to step. 8 n steps are
    ample: 1 or 2 from the last working set, 5.4 n at worst from any other among millions of random problems. A NaN in
    the wrench or in `unlimited` leaves `f` as it is but for the limits; a limit that is NaN or not above 0 is 0.

    Args:
        rows: W B (4 × n), `weighted_rows`.
        weights: the diagonal of W (4), `weights_of`.
        wanted: τ, four numbers: thrust [N] and moments about x, y, z [N·m, body axes].
        unlimited: f₀ (n) [N].
        limits: f_max (n) [N], 0 for a rotor that is lost.
        gamma: γ > 0.
        active: (n), the working set to start from (zeros if none is known), and at the end that of the solution:
            −1 at 0, 1 at the limit, 0 free.
        f: (n) [N], thrusts to start from, of any size, and at the end the solution.
        scratch: (n), overwritten.
        most: bound on the number of steps.

    Returns:
        The number of steps taken; `most` if the bound cut the solution short.
    """
    _placed(limits, active, f)
    factor = _factored(rows, gamma, active)
    opening, repeated = True, False
    for step in range(1, most + 1):
        r = _missing(rows, weights, wanted, f)
        Cg, largest = _pulled(rows, unlimited, gamma, active, f, r, scratch)
        _eased(rows, _solved(factor, Cg), scratch)
        if opening:
            changed = _clipped(limits, gamma, active, f, scratch)
        else:
            changed = _advanced(limits, gamma, active, f, scratch)
        if not changed:
            opening = False
            if largest * ROUNDING > gamma * ACCURACY and not repeated:
                repeated = True  # g loses its last digits in a long step: once more, from close by
                continue
            free = _held_in_vain(rows, limits, gamma, active, r, scratch)
            if free < 0:
                return step
            active[free] = 0.0
        factor, repeated = _factored(rows, gamma, active), False
    return most


PARTS = (_placed, _gram, _factored, _solved, _missing, _pulled, _eased, _clipped, _advanced, _held_in_vain)
COMPILED = (*PARTS, limited)
