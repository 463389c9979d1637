"""Validation of the pilot: every row of the table is a measurement on flights, beside its target.

`make validate` prints it; docs/reference/validation.md holds it with the machine and the versions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from validation import compliance, contacts, persons, rotor_losses, tracking, triggers
from validation.rows import Row
from validation.scenarios import Bench


class Chapter(NamedTuple):
    """A chapter of the table: its summary, and the function that measures its rows."""

    summary: str
    rows: Callable[[Bench], Iterator[Row]]


CHAPTERS: dict[str, Chapter] = {
    "tracking": Chapter(
        "tracking of the reference: calm, in wind, with model errors, with slow rotors", tracking.nominal
    ),
    "observers": Chapter("comparison of disturbance observers", tracking.observers),
    "draws": Chapter("random missions with all deviations together", tracking.draws),
    "losses": Chapter("rotor-loss detection and emergency landing", rotor_losses.losses),
    "triggers": Chapter("push detection in wind", triggers.triggers),
    "persons": Chapter("corridors with a person; random persons", persons.persons),
    "yaw": Chapter("compliance in yaw", compliance.yaw),
    "contacts": Chapter("contacts with walls, distinguished from pushes and from faulty sensors", contacts.contacts),
}


def rows_of(bench: Bench, names: list[str], report: Callable[[str], None] = lambda _: None) -> list[Row]:
    """Measure all rows of some chapters; `report` is called with the name of each chapter as it begins."""
    rows = []
    for name in names:
        report(name)
        rows += list(CHAPTERS[name].rows(bench))
    return rows


def table(rows: list[Row]) -> str:
    """The rows as a Markdown table."""
    lines = ["| what | target | measured | |", "|---|---|---|---|"]
    return "\n".join([*lines, *[f"| {r.what} | {r.target} | {r.measured} | {r.mark} |" for r in rows]])
