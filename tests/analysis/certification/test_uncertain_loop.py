"""The uncertain loop as M and Δ, against the same loop written out with the deviations in it."""

from __future__ import annotations

import numpy as np
import pytest

from tandemlift.analysis.certification.uncertain_loop import uncertain_loop
from tandemlift.analysis.certification.uncertainty import INERTIAS, Family, Span

COUNT, LAGS, DELAY = 8, np.array([0.02] * 4 + [0.05] * 4), 0.01  # rotors; s; s
FREQUENCIES = np.array([0.7, 6.0, 31.0])  # rad/s
BOX = {
    **{name: Span(0.0, 0.15) for name in INERTIAS},
    "thrust": Span(0.02, 0.1),
    "lag": Span(0.1, 0.3),
    "delay": Span(0.003, 0.003),
    "rotor.2": Span(0.0, 0.05),
    "rotor.7": Span(-0.01, 0.04),
}


def a_family(rng: np.random.Generator) -> Family:
    """Any responses: the algebra of a loop does not ask for a vehicle."""
    shape = (len(FREQUENCIES), 7, 4 + COUNT + 3)
    H = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
    spread, effect = rng.standard_normal((COUNT, 4)), rng.standard_normal((4, COUNT))
    return Family(FREQUENCIES, 0.2 * H, {}, spread, effect, LAGS, DELAY)


def written_out(family: Family, k: int, p: dict[str, float]) -> complex:
    """det(I − G H) at a frequency, where G answers the commanded wrench and J ω̇ with what rotors and inertias add."""
    w, n = family.w[k], COUNT
    answer = (1.0 + p["thrust"]) * np.exp(-1j * w * (p["delay"] + DELAY)) / (1.0 + 1j * w * LAGS * (1.0 + p["lag"]))
    thrusts = answer[:, None] * family.spread  # of each rotor, by the commanded wrench
    G = np.zeros((4 + n + 3, 7), dtype=complex)
    G[:4, :4] = family.effect @ thrusts - np.eye(4)
    for i in range(n):
        G[4 + i, :4] = p.get(f"rotor.{i + 1}", 0.0) * thrusts[i]
    G[4 + n :, 4:] = -np.diag([p[name] for name in INERTIAS])
    return complex(np.linalg.det(np.eye(7) - family.H[k] @ G))


@pytest.mark.parametrize("seed", range(5))
def test_its_determinant_is_that_of_the_loop_with_the_deviations_over_that_of_the_middle(seed):
    """Beside it stand what is divided out of four signals each: the poles of lags, and of the delay's fraction."""
    rng = np.random.default_rng(seed)
    family, deltas = a_family(rng), {name: float(rng.uniform(-1.0, 1.0)) for name in BOX}
    loop = uncertain_loop(family, BOX)
    middle = {name: span.middle for name, span in BOX.items()}
    p = {name: span.middle + span.half * deltas[name] for name, span in BOX.items()}
    for k, w in enumerate(FREQUENCIES):
        t = np.tan(0.5 * w * BOX["delay"].half)
        p["delay"] = middle["delay"] + 2.0 * np.arctan(t * deltas["delay"]) / w
        poles = (1.0 + 1j * t * deltas["delay"]) ** 4
        for tau in set(LAGS):
            poles *= ((1.0 + 1j * w * tau * (1.0 + p["lag"])) / (1.0 + 1j * w * tau * (1.0 + middle["lag"]))) ** 4
        delta = np.concatenate([np.full(b.size, deltas[name]) for b, name in zip(loop.blocks, BOX, strict=True)])
        found = np.linalg.det(np.eye(len(delta)) - loop.M[k] * delta)
        expected = poles * written_out(family, k, p) / written_out(family, k, middle)
        assert found == pytest.approx(expected, rel=1e-8)


def test_a_delay_at_the_ends_of_its_range_is_that_delay_exactly():
    """δ = ±1 stand for e^(−jωp) at the least and at the longest, whatever the frequency."""
    family, only = a_family(np.random.default_rng(4)), {"delay": BOX["delay"]}
    loop = uncertain_loop(family, only)
    rest = dict.fromkeys((*INERTIAS, "thrust", "lag"), 0.0)
    for k, w in enumerate(FREQUENCIES):
        t = np.tan(0.5 * w * BOX["delay"].half)
        for side in (-1.0, 1.0):
            delay = BOX["delay"].middle + side * BOX["delay"].half
            found = np.linalg.det(np.eye(4) - side * loop.M[k]) / (1.0 + 1j * t * side) ** 4
            ratio = [written_out(family, k, {**rest, "delay": d}) for d in (delay, BOX["delay"].middle)]
            assert found == pytest.approx(ratio[0] / ratio[1], rel=1e-9)
