"""The margins of `zigzag` against its random persons: prints a table and draws the trade-off.

python evidence/margin_tradeoff.py [--persons 200] [--out FILE.png]

`share` goes from the pilot of `zigzag` (0) to the gains, bandwidths and leads of the wrench of `iris` (1) on straight
lines, with an attitude filter from 15 to 25 rad/s; `smoothed` has a low-pass before this filter too, whose delay grows
to that of 25 rad/s. `lead` changes the lead of the wrench alone. Margins are the least of all axes, by the linear tier
of the certificate; the persons are those of `make validate CHAPTER=persons`.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from validation.persons import random_persons, succeeded
from validation.scenarios import Changes

from tandemlift.analysis.certification.disk_margins import disk_margin
from tandemlift.analysis.certification.linear import loop_as_flown
from tandemlift.analysis.linearization.loop_margins import axis_margins, single_loop
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.core.errors import without_flight_warnings
from tandemlift.missions import Mission, load_mission

BARS = (45.0, 35.0)  # deg: phase margin, disk phase margin
TABLES = {
    "controller": ("filter_bandwidth",),
    "controller.gains": ("xi", "lambda_1", "lambda_2"),
    "observer": ("force_bandwidth", "moment_bandwidth"),
    "allocation": ("lead",),
}
SMOOTHING, FILTER = "controller.smoothing_bandwidth", 25.0  # rad/s: of both filters at the far end
LINES = {
    "share": ("o-", "towards the pilot of iris", (0.0, 0.25, 0.5, 0.75, 1.0)),
    "smoothed": ("^:", "the same, smoothed", (0.5, 1.0)),
    "lead": ("s--", "lead of the wrench alone", (0.25, 0.5, 1.0)),
}


class Point(NamedTuple):
    """A pilot: its margins [deg], and what its persons met; clearances [m], force [N] and work [J/m] are means."""

    line: str
    part: float
    phase: float
    disk: float
    passed: int
    clearance: float
    oscillating: int
    force: float
    work: float


def numbers(mission: Mission) -> dict[str, Any]:
    """The keys that differ between the two pilots, with their values."""
    data = mission.model_dump(mode="json")
    controller = data["controller"]
    tables = {**data, "controller.gains": controller["gains"]}
    found = {f"{table}.{name}": tables[table][name] for table, names in TABLES.items() for name in names}
    return {key: np.broadcast_to(value, 4) if key == "allocation.lead" else value for key, value in found.items()}


def pilot(line: str, part: float) -> Changes:
    """The changes of `zigzag` for a point of a line."""
    near, far = numbers(load_mission("zigzag")), numbers(load_mission("iris"))
    far["controller.filter_bandwidth"] = FILTER
    keys = ["allocation.lead"] if line == "lead" else near
    changes = {
        key: (np.asarray(near[key]) + part * (np.asarray(far[key]) - np.asarray(near[key]))).tolist() for key in keys
    }
    if line == "smoothed":
        changes[SMOOTHING] = FILTER / part  # the delay of a low-pass is proportional to 1/bandwidth
    return changes


def margins(mission: Mission) -> tuple[float, float]:
    """(least phase margin, least disk phase margin) of all axes [deg]."""
    loop = loop_as_flown(mission)
    w, L = loop.open.w, loop.L
    disks = [disk_margin(w, single_loop(L, i)[:, None, None]).phase for i in range(4)]
    return min(abs(m.phase) for m in axis_margins(w, L)), min(disks)


def point(line: str, part: float, count: int) -> Point:
    """Fly the persons of a pilot."""
    changes = pilot(line, part)
    missions = random_persons("zigzag", count, changes=changes)
    flown = fly_each(missions)
    passed = sum(succeeded(m, f) for m, f in zip(missions, flown, strict=True))
    swings = sum("oscillating" in {finding[1] for finding in f["findings"]} for f in flown)
    force, work = (float(np.mean([f[key] for f in flown])) for key in ("human_force_mean_n", "human_work_per_path_j_m"))
    least = min(f["clearance_min_m"] for f in flown)
    return Point(line, part, *margins(load_mission("zigzag", changes)), passed, least, swings, force, work)


def drawn(points: list[Point], count: int) -> plt.Figure:
    """The picture: failures, clearance, oscillations and work over the least disk margin."""
    figure, axes = plt.subplots(2, 2, figsize=(8.0, 6.0), layout="constrained", sharex=True)
    panels = {
        "persons who do not arrive": [count - p.passed for p in points],
        "smallest clearance (m)": [p.clearance for p in points],
        "flights that oscillate": [p.oscillating for p in points],
        "work of a person (J/m)": [p.work for p in points],
    }
    for a, (label, values) in zip(axes.flat, panels.items(), strict=True):
        for line, (style, name, _) in LINES.items():
            of = [i for i, p in enumerate(points) if p.line == line or p.part == 0.0]  # all lines begin at zigzag
            a.plot([points[i].disk for i in of], [values[i] for i in of], style, mfc="white", label=name)
        a.axvline(BARS[1], color="k", lw=0.8, ls=":")
        a.set_ylabel(label)
    axes[0, 0].plot(points[0].disk, count - points[0].passed, "*", color="k", ms=11, label="zigzag")
    axes[0, 0].legend(frameon=False)
    for a in axes[1]:
        a.set_xlabel("least disk margin (deg)")
    return figure


def main() -> None:
    """Print the table, and draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--persons", type=int, default=200)
    parser.add_argument("--out", type=Path, default=Path("out/margin-tradeoff.png"))
    given = parser.parse_args()
    print("| pilot | margin, disk (deg) | arrived | smallest clearance (m) | oscillate | force (N), work (J/m) |")
    print("|---|---|---:|---:|---:|---|")
    points = list[Point]()
    for line, part in ((line, part) for line, (*_, parts) in LINES.items() for part in parts):
        with without_flight_warnings():
            p = point(line, part, given.persons)
        points.append(p)
        print(
            f"| {line} {part:g} | {p.phase:.1f}, {p.disk:.1f} | {p.passed} | {p.clearance:.2f} | {p.oscillating} "
            f"| {p.force:.2f}, {p.work:.2f} |",
            flush=True,
        )
    print("\n`rotor-loss`: margin, disk (deg): {:.1f}, {:.1f}".format(*margins(load_mission("rotor-loss"))))
    given.out.parent.mkdir(parents=True, exist_ok=True)
    drawn(points, given.persons).savefig(given.out, dpi=110)
    print(given.out)


if __name__ == "__main__":
    main()
