"""Ten crashes in several engines: `python benchmarks/crashes.py [mujoco] [gazebo]`; prints Markdown.

The first touch in each engine (part and surface, time, place), and where the vehicle comes to rest. Ends with status 1
if the outcome, the part, the time (20 ms) or the place (5 cm) differs from the compiled engine.
"""

from __future__ import annotations

import sys

from machine import describe, heading, table

from tandemlift.studies.crashes import CRASHES, Crash, apart, crash_in

TIME, PLACE = 0.02, 0.05  # s, m


def place_of(place: tuple[float, ...]) -> str:
    """A place [m] in text."""
    return ", ".join(f"{v + 0.0:.2f}" for v in place)


def cells_of(name: str, found: dict[str, Crash]) -> list[str]:
    """A line of the table."""
    own, *others = found.values()
    first, differences = own.first, list[str]()
    for other in others:
        if first is None or other.first is None:
            differences.append("")
        else:
            time, place = apart(first, other.first)
            differences.append(f"{1e3 * time:.0f} ms, {1e2 * place:.1f} cm")
    touch = "feet only" if first is None else f"{first.part}, {first.surface}, {first.time:.3f} s"
    return [name, touch, *differences, *(place_of(crash.rest) for crash in found.values())]


def alike(a: Crash, b: Crash) -> bool:
    """Whether two crashes have the same outcome, and begin with the same part at the same time and place."""
    if a.outcome != b.outcome or a.first is None or b.first is None:
        return a.outcome == b.outcome and a.first is b.first
    time, place = apart(a.first, b.first)
    return a.first[:2] == b.first[:2] and time < TIME and place < PLACE


def main(engines: list[str]) -> int:
    print(heading(describe(("tandemlift", "numpy"))), end="\n\n")
    rows, differ, flown = [], 0, ("compiled", *engines)
    for name in CRASHES:
        found = {engine: crash_in(name, engine) for engine in flown}
        rows.append(cells_of(name, found))
        differ += sum(not alike(found["compiled"], crash) for crash in found.values())
    rests = [f"rest [m], {engine}" for engine in flown]
    print(table(["crash", "first touch", *engines, *rests], rows))
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or ["mujoco"]))
