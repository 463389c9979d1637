"""Flies hands of every kind, drawn at random, and the largest shake, predicted and flown; prints their tables.

python evidence/gentle_hands.py [--draws 2000] [--mission NAME ...] [--seed 52] [--shakes 200] [--mujoco 10] [--write]

A hand is within what rotors can give if an ideal pilot with their limits holds it (`random_hands/ability.py`). Bad is
what its flight does, by its samples: a crash, the floor, sinking by more than 0.1 m or turning by more than 5°. It is
silent if it crashes, is on the floor, sinks by more than 0.1 m or turns by more than the 20° that are promised, without
a finding, and without a warning at load that the mission without the hand does not have. Ctrl-C ends the flights, and
prints the tables of those that are done.
"""

from __future__ import annotations

import argparse
import datetime
import os
import re
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import NamedTuple, TypeVar

os.environ.setdefault("TANDEMLIFT_OPTIMISE", "0")  # many loops, each flown for minutes at most

import numpy as np
from random_hands.ability import SINKS, TURNS, is_within
from random_hands.drawn import KINDS, LASTS, MISSIONS, RESTS, START, Family, Hand, drawn_hand, families
from random_hands.shakes import compared, shake_table

import tandemlift as tl
from tandemlift.analysis.certification.shakes import deviations
from tandemlift.core.phases import FAILURES
from tandemlift.flight.record import Flight

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reference" / "validation.md"
MARK, END = (f"<!-- {edge} of what `gentle_hands.py` prints -->" for edge in ("begin", "end"))
T = TypeVar("T")
FAMILY = 25  # hands of a family
PROMISED = 20.0  # deg
ON_FLOOR = 0.01  # m above where it stands


class Outcome(NamedTuple):
    """What a hand did to the vehicle: sinking below its reference [m], turning off it [deg], and what is bad of it."""

    hand: Hand
    within: bool
    sinks: float
    turns: float
    floor: bool
    crashed: bool
    findings: tuple[str, ...]

    @property
    def bad(self) -> bool:
        """Whether it is bad."""
        return self.crashed or self.floor or self.sinks > SINKS or self.turns > np.degrees(TURNS)

    @property
    def silent(self) -> bool:
        """Whether it is bad, and nothing told it."""
        worst = self.crashed or self.floor or self.sinks > SINKS or self.turns > PROMISED
        return worst and not self.findings and not self.hand.warnings


def outcome_of(hand: Hand, flight: Flight) -> Outcome:
    """Measure a flight by its samples from the hand's begin on."""
    on, off = flight.time >= START, deviations(flight, START)
    stands = hand.mission.initial.position[2] if hand.mission.ground.model == "floor" else -np.inf
    return Outcome(
        hand=hand,
        within=is_within(hand.mission, START, START + LASTS + RESTS),
        sinks=off.sinks,
        turns=off.turns,
        floor=bool((flight["position"][on, 2] < stands + ON_FLOOR).any()),
        crashed=flight.outcome in FAILURES,
        findings=tuple(f.kind for f in flight.findings if f.time >= START),
    )


def flown_family(seed: int, family: Family, count: int) -> list[Outcome]:
    """The hands of a family, flown."""
    hands = [drawn_hand(seed, family, member) for member in range(count)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        flights = tl.fly_many([hand.mission for hand in hands], threads=1)
    return [outcome_of(hand, flight) for hand, flight in zip(hands, flights, strict=True)]


def table(rows: list[Outcome]) -> str:
    """The table of docs/reference/validation.md."""
    head = ("hand", "flown", "within", "sinks at most", "sinks > 0.1 m", "turns > 5°", "floor", "crashed", "silent")
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    for kind in (*KINDS, "all", "all beyond"):
        mine = [r for r in rows if kind in (r.hand.kind, "all") or kind == "all beyond"]
        inside = [r for r in mine if r.within is (kind != "all beyond")]
        cells = [
            f"{len(mine)}",
            f"{len(inside)}" if kind != "all beyond" else "",
            f"{max((r.sinks for r in inside), default=0.0):.2f} m",
            *(str(sum(map(what, inside))) for what in (
                lambda r: r.sinks > SINKS, lambda r: r.turns > np.degrees(TURNS),
                lambda r: r.floor, lambda r: r.crashed, lambda r: r.silent,
            )),
        ]  # fmt: skip
        lines.append(f"| {kind} | {' | '.join(cells)} |")
    return "\n".join(lines)


def outcomes(seed: int, draws: int, bases: tuple[str, ...]) -> Iterator[Outcome]:
    """So many hands, family by family, with a bar."""
    count = -(-draws // FAMILY)
    for done, family in enumerate(families(seed, count, bases)):
        print(f"\r{done} of {count} families", end="", file=sys.stderr, flush=True)
        yield from flown_family(seed, family, FAMILY)
    print(f"\r{count} of {count} families", file=sys.stderr)


def until_stopped(rows: Iterable[T]) -> list[T]:
    """All rows, or those until Ctrl-C."""
    found = list[T]()
    with suppress(KeyboardInterrupt):
        for row in rows:
            found.append(row)
    return found


def main() -> int:
    """Draw, fly, measure, print; 1 if a hand within what rotors can give fells the vehicle, or is silent."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in {"draws": 2000, "seed": 52, "shakes": 200, "mujoco": 10}.items():
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--mission", nargs="+", choices=MISSIONS, default=list(MISSIONS))
    parser.add_argument("--every", action="store_true", help="print each bad hand")
    parser.add_argument("--write", action="store_true", help="write the tables into docs/reference/validation.md")
    a = parser.parse_args()
    bases = tuple(a.mission)
    rows = until_stopped(islice(outcomes(a.seed, a.draws, bases), a.draws))
    for r in rows:
        if r.silent or (r.within and (r.floor or r.crashed)) or (a.every and r.bad):
            h, f = r.hand, r.hand.family
            push = h.changes["pushes"][len(h.changes["pushes"]) // 2]
            print(
                f"{f.number} {f.base} {f.observer or 'own'}{' windy' * f.windy} {h.kind} {h.condition}: "
                f"{'within' if r.within else 'beyond'}{', silent' * r.silent}{', floor' * r.floor}"
                f"{', crashed' * r.crashed}, sinks {r.sinks:.2f} m, turns {r.turns:.1f}°, {set(r.findings) or ''} "
                f"{len(h.changes['pushes'])} × {np.round(push['force'], 2)} σ {push['sigma']:.3f} "
                f"at {np.round(push['point'], 2)}; {len(h.warnings)} warnings"
            )
    found = until_stopped(compared(a.seed, a.shakes, a.mujoco, bases)) if a.shakes else []
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d")
    head = f"{day} · `python evidence/gentle_hands.py`, seed {a.seed} · tandemlift {tl.__version__}"
    parts = [MARK, head, *([table(rows)] if rows else []), *([shake_table(found)] if found else []), END]
    text = "\n\n".join(parts)
    print("\n" + text)
    if a.write:
        page = PAGE.read_text("utf-8")
        PAGE.write_text(re.sub(f"{MARK}.*{END}", lambda _: text, page, flags=re.DOTALL), "utf-8")
    return int(any(r.silent or (r.within and (r.floor or r.crashed)) for r in rows))


if __name__ == "__main__":
    warnings.simplefilter("ignore", tl.FlightWarning)
    sys.exit(main())
