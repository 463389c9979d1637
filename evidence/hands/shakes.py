"""The largest shake as the certificate predicts it, and as flights that know nothing of it find it.

Predicted by flights in blocks from a calm hover, and between their frequencies along straight lines of log peak over
log frequency. Flown by `tl.Simulation`, step by step, with a true sine, the mission's own lift, errors and noise,
another seed, and some in MuJoCo; bisection from 0.6 to 1.67 times the predicted peak.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

import tandemlift as tl
from hands.drawn import HOVER, START
from tandemlift.analysis.certification.shakes import (
    FREQUENCIES,
    MOST,
    RESTS,
    SECONDS,
    Shake,
    answer_of,
    largest_shakes,
    shaken_hands,
)
from tandemlift.missions import Mission
from tandemlift.parts.rotors.authority import PUSHED

AROUND, HALVINGS, WITHIN = 1.0 / 0.6, 5, 0.15
HELD = 0.004  # s, for which a force is held


class Compared(NamedTuple):
    """A shake of a mission: engine, the predicted peak [N], infinite beyond all that are tried, and the flown one."""

    base: str
    engine: str
    hand: Shake
    predicted: float
    flown: float
    tried: float

    @property
    def ratio(self) -> float:
        """Flown over predicted; 1 where both are beyond what is tried."""
        if self.predicted == math.inf:
            return 1.0 if self.flown == math.inf else self.flown / self.tried
        return self.flown / self.predicted


def mission_to_shake(base: str) -> Mission:
    """A mission that hovers in calm air until its end."""
    return tl.load_mission(base, {**HOVER, "wind.model": "none", "mission.duration": START + SECONDS + RESTS})


def is_answered(sim: tl.Simulation, hand: Shake, peak: float, seed: int) -> bool:
    """Whether a flight answers a true sine of that peak [N]."""
    sim.reset(seed)
    sim.step(steps=round(START / sim.dt))
    count, force = max(1, round(HELD / sim.dt)), np.zeros(3)
    end = round(2.0 * SECONDS * hand.frequency) / (2.0 * hand.frequency)
    while not sim.over:
        t = sim.time - START + 0.5 * count * sim.dt
        force[hand.axis] = peak * math.sin(2.0 * math.pi * hand.frequency * t) if t < end else 0.0
        sim.step(force, point=hand.point, steps=count)
    return answer_of(sim.flight(), START).is_calm


def flown_peak(sim: tl.Simulation, hand: Shake, predicted: float, tried: float, seed: int) -> float:
    """The largest answered peak around a predicted one; infinite if all that is tried is."""
    if predicted == math.inf:
        return math.inf if is_answered(sim, hand, tried * (1.0 - WITHIN), seed) else tried * 0.5
    low, high = predicted / AROUND, predicted * AROUND
    for _ in range(HALVINGS):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if is_answered(sim, hand, middle, seed) else (low, middle)
    return math.sqrt(low * high)


def compared(seed: int, draws: int, mujoco: int, bases: tuple[str, ...]) -> Iterator[Compared]:
    """Draws of mission, frequency, axis and place, predicted and flown; the first of each mission in MuJoCo, too."""
    rng = np.random.default_rng([seed, 15])
    chosen = sorted(str(rng.choice(bases)) for _ in range(draws))
    others = set(np.linspace(0, draws - 1, mujoco).astype(int).tolist()) if mujoco else set()
    before = ""
    for number, base in enumerate(chosen):
        if base != before:
            mission, before = mission_to_shake(base), base
            hands = shaken_hands(mission)
            peaks = np.array(largest_shakes(mission, hands)).reshape(-1, len(FREQUENCIES))
            sims = {"compiled": tl.Simulation(mission)}
        row, tried = int(rng.integers(len(peaks))), MOST * mission.hover.mass / PUSHED
        frequency = math.exp(rng.uniform(math.log(FREQUENCIES[0]), math.log(FREQUENCIES[-1])))
        hand = hands[row * len(FREQUENCIES)]._replace(frequency=frequency)
        log = np.interp(math.log(frequency), np.log(FREQUENCIES), np.log(np.minimum(peaks[row], tried)))
        near = np.searchsorted(FREQUENCIES, frequency)
        predicted = math.inf if np.isinf(peaks[row][near - 1 : near + 1]).all() else math.exp(float(log))
        for engine in ["compiled", *["mujoco"] * (number in others)]:
            sim = sims["compiled"] if engine == "compiled" else tl.Simulation(mission, engine)
            flown = flown_peak(sim, hand, predicted, tried, int(rng.integers(1, 10**6)))
            yield Compared(base, engine, hand, predicted, flown, tried)
        print(f"\r{number + 1} of {draws} shakes", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)


def shake_table(found: list[Compared]) -> str:
    """The table of docs/reference/validation.md."""
    head = "| largest shake | draws | within 15 % | flown over predicted: least, median, largest |"
    lines = [head, "|---|---:|---:|---:|"]
    engines = [e for e in ("compiled", "mujoco") if any(x.engine == e for x in found)]
    groups = [
        (b, [x for x in found if x.base == b and x.engine == "compiled"]) for b in sorted({x.base for x in found})
    ]
    for name, mine in [*groups, *((f"all, {e}", [x for x in found if x.engine == e]) for e in engines)]:
        ratio = np.array([x.ratio for x in mine])
        near = np.mean(np.abs(ratio - 1.0) <= WITHIN)
        lines.append(
            f"| {name} | {len(mine)} | {near:.1%} | {ratio.min():.2f}, {np.median(ratio):.2f}, {ratio.max():.2f} |"
        )
    off = [x for x in found if abs(x.ratio - 1.0) > WITHIN]
    print(*(f"{x.base} {x.engine} {'xyz'[x.hand.axis]} {x.hand.place} {x.hand.frequency:.2f} Hz: {x.predicted:.2f} "
            f"predicted, {x.flown:.2f} flown" for x in off), sep="\n")  # fmt: skip
    return "\n".join(lines)
