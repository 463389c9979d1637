"""Random missions flown in single and in double precision: prints the table of the validation.

python evidence/single_precision.py [--families 125] [--members 8] [--seed 16] [--first 0] [--out FILE.jsonl]

The missions are those of `fly_random_missions.py`. Two flights agree if outcome and kinds of findings are the same.
Where they do not, the mission is flown in double precision with a mass that differs by 1e-12 to 1e-6 of itself: if one
of these flights ends as the one in single precision, rounding decides the mission in any precision. Rows are written as
they come; families whose rows FILE.jsonl holds are not flown again, so the same command resumes.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

os.environ.setdefault("TANDEMLIFT_OPTIMISE", "0")  # many loops, each flown for seconds only

import numpy as np
from random_missions.generate import random_family

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.missions import Mission, changed

LEAST = 0.002  # m: below, an error is that of the sensors, and its change is told in m
REFUSED = "refused"
NEARBY = (1e-12, -1e-12, 6e-8, -6e-8, 2e-7, -2e-7, 1e-6)  # relative changes of the mass
CHAOS = 0.1


def in_single(mission: Mission) -> Mission:
    """The mission in single precision."""
    return mission.model_copy(update={"mission": mission.mission.model_copy(update={"precision": "single"})})


def told(flown: Any) -> dict[str, Any]:
    """What is compared of a flight's metrics."""
    if isinstance(flown, InputError):
        return {"outcome": REFUSED, "findings": [], "text": str(flown)}
    error = flown["position_rmse_m"]
    rmse = float(np.linalg.norm(error)) if error and all(isinstance(x, float) for x in error) else None
    findings = [[time, kind] for time, kind, _ in flown["findings"]]
    return {
        **{"outcome": flown["outcome"], "findings": findings, "rmse": rmse, "steps": flown["steps"]},
        **{"final": flown["final_position_m"], "failure": flown["failure"]},
    }


def compared(seed: int, family: int, members: int) -> Iterator[dict[str, Any]]:
    """A row for each member of a family."""
    drawn = list(random_family(seed, family, members))
    missions = [d.mission for d in drawn]
    flown = [
        tl.fly_many(own, "metrics", threads=1, refusals=True) for own in (missions, list(map(in_single, missions)))
    ]
    for one, double, single in zip(drawn, *flown, strict=True):
        row = {"family": family, "member": one.member, "base": one.base, "double": told(double), "single": told(single)}
        if row["single"]["outcome"] != REFUSED and not agrees(row):
            scale = one.mission.plant.mass_scale
            nearby = [changed(one.mission, "plant.mass_scale", scale * (1.0 + more)) for more in NEARBY]
            row["nearby"] = [told(flight) for flight in tl.fly_many(nearby, "metrics", threads=1)]
        yield row


def end_of(flight: dict[str, Any]) -> tuple[str, tuple[str, ...]]:
    """Outcome and kinds of findings of a flight."""
    return flight["outcome"], tuple(sorted({kind for _, kind in flight["findings"]}))


def agrees(row: dict[str, Any]) -> bool:
    """Whether outcome and kinds of findings are the same."""
    return end_of(row["double"]) == end_of(row["single"])


def explained(row: dict[str, Any]) -> bool:
    """Whether a flight in double precision of nearly the same mass ends as the one in single precision."""
    return end_of(row["single"]) in map(end_of, row["nearby"])


def chaotic(row: dict[str, Any]) -> bool:
    """Whether flights in double precision of nearly the same mass differ in their RMSE by more than `CHAOS`."""
    errors = [flight["rmse"] for flight in row["nearby"]]
    return None in errors or max(errors) > (1.0 + CHAOS) * min(errors)


def summary(rows: list[dict[str, Any]]) -> str:
    """The numbers of the comparison, and each disagreement."""
    flown = [r for r in rows if r["single"]["outcome"] != REFUSED]
    refused = [r for r in rows if r["single"]["outcome"] == REFUSED and r["double"]["outcome"] != REFUSED]
    same, others = [r for r in flown if agrees(r)], [r for r in flown if not agrees(r)]
    pairs = [
        (r["double"]["rmse"], r["single"]["rmse"])
        for r in same
        if None not in (r["double"]["rmse"], r["single"]["rmse"])
    ]
    relative = np.array([abs(b / a - 1.0) for a, b in pairs if a >= LEAST])
    absolute = np.array([abs(b - a) for a, b in pairs if a < LEAST])
    lines = [
        f"{len(rows)} missions; {len(refused)} that single precision refuses; {len(flown)} flown in both.",
        f"Same outcome and kinds of findings: {len(same)} of {len(flown)}, {len(same) / max(len(flown), 1):.2%}.",
        f"Of the other {len(others)}: {sum(map(explained, others))} end so in double, too, with nearly the same mass;"
        f" of the rest {sum(chaotic(r) and not explained(r) for r in others)} have an RMSE that changes by more than "
        f"{CHAOS:.0%} with it.",
    ]
    if relative.size:
        within = int((relative <= 0.01).sum())
        lines.append(
            f"RMSE of the position within 1 %: {within} of {relative.size} of at least {1e3 * LEAST:g} mm; median "
            f"change {100 * np.median(relative):.2g} %, largest {100 * relative.max():.2g} %; below that, the largest "
            f"change is {1e3 * absolute.max(initial=0.0):.2g} mm."
        )
    for r in others:
        (one, *_), (two, *_) = double, single = end_of(r["double"]), end_of(r["single"])
        only = [", ".join(sorted({*x[1]} - {*y[1]})) or "none" for x, y in ((double, single), (single, double))]
        nearby = sum(end_of(flight) == single for flight in r["nearby"])
        lines.append(
            f"{r['family']}/{r['member']} {r['base']}: {one}, in single precision {two}; findings of double alone: "
            f"{only[0]}; of single alone: {only[1]}; {nearby} of {len(NEARBY)} nearby flights in double end as single"
        )
    for text in sorted({r["single"]["text"] for r in refused}):
        lines.append(f"refused: {text}")
    return "\n".join(lines)


def main() -> int:
    """Draw, fly twice, compare, print; 1 if of more than 0.2 % the difference is not explained."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in {"families": 125, "members": 8, "seed": 16, "first": 0}.items():
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--out", type=Path, default=Path("out", "single-precision.jsonl"), help="file of the rows")
    a = parser.parse_args()
    a.out.parent.mkdir(parents=True, exist_ok=True)
    rows = [json.loads(line) for line in a.out.read_text().splitlines()] if a.out.exists() else []
    known = {row["family"] for row in rows}
    for family in range(a.first, a.first + a.families):
        if family not in known:
            rows += (new := list(compared(a.seed, family, a.members)))
            with a.out.open("a") as file:
                file.writelines(json.dumps(row) + "\n" for row in new)
            print(f"\r{family + 1 - a.first} of {a.families}", end="", file=sys.stderr, flush=True)
    text = summary(rows)
    print("\n" + text)
    flown = [r for r in rows if r["single"]["outcome"] != REFUSED]
    return int(sum(not agrees(r) and not explained(r) and not chaotic(r) for r in flown) > 0.002 * len(flown))


if __name__ == "__main__":
    sys.exit(main())
