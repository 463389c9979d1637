"""The decision about a lost rotor from the evidence for each rotor."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.algebra import clip, greatest, where
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import total

LEAST_LOSS, MOST_LOSS = 0.5, 1.5  # fraction of a thrust that is lost
PRIOR = 10.0  # evidence added for the rotor that is declared lost already


class DecisionRules(NamedTuple):
    """The rules by which a rotor is declared lost, or restored.

    `threshold` against no fault and `isolation_margin` to the next rotor, as twice a log-likelihood ratio;
    `unexplained_fraction`: of |r|², that may stay unexplained; `dwell` [s]: for which all of it must hold;
    `retest_time` [s]: for which a lost rotor is tried again; `per_spread`: 1/spread².
    """

    threshold: Number
    isolation_margin: Number
    unexplained_fraction: Number
    dwell: Number
    retest_time: Number
    per_spread: Number


class DecisionState(NamedTuple):
    """The lost rotor (1, else 0; a set), its start [s], the count of losses declared; timers [s] of the test.

    `above`: time for which each rotor has met the rules (a set); `alive`: time for which the lost one has had thrust.
    """

    lost: PerRotor
    since: Number
    named: Number
    above: PerRotor
    alive: Number


@elementwise
def share_gone(fit: Number, size: Number, per_spread: Number) -> Number:
    """The most likely fraction of its thrust that a rotor has lost."""
    return clip((fit + per_spread) / (size + per_spread), LEAST_LOSS, MOST_LOSS)


@elementwise
def support(share: Number, fit: Number, size: Number, per_spread: Number) -> Number:
    """The evidence for the loss of this fraction of a rotor's thrust."""
    return share * (2.0 * fit - share * size) - (1.0 - share) * (1.0 - share) * per_spread


@elementwise
def but(value: Number, best: Number) -> Number:
    """A value, or one far below all others if it is the best."""
    return where(value < best, value, -1e18)


@elementwise
def counted(timer: Number, evidence: Number, best: Number, sure: Number, dt: Number) -> Number:
    """The time [s] for which a rotor has met the rules."""
    return where(evidence < best, 0.0, (timer + dt) * sure)


@elementwise
def is_named(lost: Number, above: Number, dwell: Number, renamed: Number) -> Number:
    """1 for the rotor that is lost, else 0; `renamed` is 1 if another one is declared lost now."""
    return where(renamed > 0.0, where(above < dwell, 0.0, 1.0), lost)


@law
def decision_step(
    k: DecisionRules, v: DecisionState, evidence: PerRotor, square: Number, active: Number, t: Number, dt: Number
) -> DecisionState:
    """The decision after a sample with this evidence for every rotor; `square`: |r|² with each component over its σ.

    `active` is 0 while the decision must not change, else 1.
    """
    # a head start, so that noise does not change a decision between two rotors that explain r alike
    held = evidence + v.lost * PRIOR
    best = greatest(held)
    clear = where(best - greatest(but(held, best)) > k.isolation_margin, active, 0.0)
    sure = where(best > k.threshold, where(square - best > k.unexplained_fraction * square, 0.0, clear), 0.0)
    above = counted(v.above, held, best, sure, dt)
    ripe = where(greatest(above) < k.dwell, 0.0, 1.0)
    renamed = ripe * (1.0 - where(total(is_named(v.lost, above, k.dwell, ripe) * v.lost) > 0.0, 1.0, 0.0))
    named = total(v.lost)
    alive = where(total(v.lost * evidence) < -k.threshold, (v.alive + dt) * named * active, 0.0)
    restored = where(alive < k.dwell, 0.0, 1.0)
    return DecisionState(
        is_named(v.lost, above, k.dwell, renamed) * (1.0 - restored),
        where(renamed > 0.0, t, v.since),
        v.named + renamed,
        above,
        alive,
    )
