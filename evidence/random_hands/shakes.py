"""The largest shake as the certificate predicts it, and as flights that know nothing of it find it.

Predicted by flights in blocks. Flown by `tl.Simulation`, step by step, with a true sine in place of Gaussians, another
lift, another seed of all errors and noise, and some in MuJoCo, with rising peaks around the predicted one.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

import tandemlift as tl
from random_hands.drawn import HOVER, START
from tandemlift.analysis.certification.shakes import (
    FREQUENCIES,
    MAX_PEAK,
    REST,
    SECONDS,
    Shake,
    end_of_answers,
    is_answered,
    largest_shakes,
    shaken_hands,
)
from tandemlift.missions import Mission
from tandemlift.parts.flight_checks.authority import HAND_MASS

WITHIN, RATIOS = 0.15, np.geomspace(0.5, 2.0, 15)  # of a flown peak to a predicted one
LOWEST, HIGHEST = 0.5, 10.0  # Hz
HELD = 0.004  # s, for which a force is held


class Compared(NamedTuple):
    """A shake of a mission: engine, the predicted peak [N], infinite beyond all that are tried, and flown over it.

    A ratio of 1 is within 15 %; where no peak is predicted, it is that of the largest that is tried.
    """

    base: str
    engine: str
    hand: Shake
    predicted: float
    ratio: float


def mission_to_shake(base: str) -> Mission:
    """A mission that hovers in calm air until its end."""
    return tl.load_mission(base, {**HOVER, "wind.model": "none", "mission.duration": START + SECONDS + REST})


def answers(sim: tl.Simulation, hand: Shake, peak: float, seed: int) -> bool:
    """Whether a flight answers a true sine of that peak [N]."""
    sim.reset(seed)
    sim.step(steps=round(START / sim.dt))
    count, force = max(1, round(HELD / sim.dt)), np.zeros(3)
    end = round(2.0 * SECONDS * hand.frequency) / (2.0 * hand.frequency)
    while not sim.over:
        t = sim.time - START + 0.5 * count * sim.dt
        force[hand.axis] = peak * math.sin(2.0 * math.pi * hand.frequency * t) if t < end else 0.0
        sim.step(force, point=hand.point, steps=count)
    return is_answered(sim.flight(), START)


def flown_ratio(sim: tl.Simulation, hand: Shake, peak: float, most: bool, seed: int) -> float:
    """The largest answered peak over a predicted one; 1 within 15 %. `most`: no larger one was tried."""
    ratios = RATIOS[RATIOS <= 1.0] if most else RATIOS
    found = end_of_answers(ratios, [answers(sim, hand, peak * ratio, seed) for ratio in ratios.tolist()])
    return 1.0 if abs(found - 1.0) <= WITHIN or (most and found == math.inf) else found


def compared(seed: int, draws: int, mujoco: int, bases: tuple[str, ...]) -> Iterator[Compared]:
    """Draws of mission, frequency, axis and place, predicted and flown; some in MuJoCo, too."""
    rng = np.random.default_rng([seed, 15])
    chosen = sorted(str(rng.choice(bases)) for _ in range(draws))
    others = set(np.linspace(0, draws - 1, mujoco).astype(int).tolist()) if mujoco else set()
    done = 0
    for base in dict.fromkeys(chosen):
        mission = mission_to_shake(base)
        places, tried = shaken_hands(mission)[:: len(FREQUENCIES)], MAX_PEAK * mission.hover.mass / HAND_MASS
        hands = [
            places[rng.integers(len(places))]._replace(
                frequency=math.exp(rng.uniform(math.log(LOWEST), math.log(HIGHEST)))
            )
            for _ in range(chosen.count(base))
        ]
        sim = tl.Simulation(mission)
        for hand, predicted in zip(hands, largest_shakes(mission, hands), strict=True):
            for engine in ["compiled", *["mujoco"] * (done in others)]:
                flown = sim if engine == "compiled" else tl.Simulation(mission, engine)
                own = int(rng.integers(1, 10**6))
                ratio = flown_ratio(flown, hand, min(predicted, tried), predicted == math.inf, own)
                yield Compared(base, engine, hand, predicted, ratio)
            done += 1
            print(f"\r{done} of {draws} shakes", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)


def said(ratio: float) -> str:
    """A ratio; infinite beyond all that are flown."""
    return f"{ratio:.2f}" if ratio < math.inf else f"> {RATIOS[-1]:g}"


def shake_table(found: list[Compared]) -> str:
    """The table of docs/reference/validation.md, after the draws that are farther off."""
    lines = ["| largest shake | draws | of them none | within 15 % | less | more |", "|---|---:|---:|---:|---:|---:|"]
    engines = [e for e in ("compiled", "mujoco") if any(x.engine == e for x in found)]
    groups = [(b, [x for x in found if (x.base, x.engine) == (b, "compiled")]) for b in sorted({x.base for x in found})]
    for name, mine in [*groups, *((f"all, {e}", [x for x in found if x.engine == e]) for e in engines)]:
        less, more = ([said(x.ratio) for x in mine if (x.ratio - 1.0) * way > 0.0] for way in (-1, 1))
        share, none = 1.0 - (len(less) + len(more)) / len(mine), sum(x.predicted == math.inf for x in mine)
        told = (f"{len(side)}" + (": " + ", ".join(side) if 0 < len(side) < 6 else "") for side in (less, more))
        lines.append(f"| {name} | {len(mine)} | {none} | {share:.1%} | {' | '.join(told)} |")
    for x in found:
        if x.ratio != 1.0:
            what = f"{x.base} {x.engine} {'xyz'[x.hand.axis]} {x.hand.place} {x.hand.frequency:.2f} Hz"
            print(f"{what}: {x.predicted:.2f} N predicted, {x.ratio:.2f} times it flown")
    return "\n".join(lines)
