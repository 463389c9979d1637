"""Validation of the pilot: every row of the table is a measurement on flights, beside its target.

`tandemlift validate` prints it; docs/reference/validation.md holds it with the machine and the versions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from tandemlift.common.errors import InputError, unknown
from tandemlift.studies.validation import compliance, contacts, persons, rotor_losses, tracking, triggers
from tandemlift.studies.validation.rows import Row
from tandemlift.studies.validation.scenarios import Bench

__all__ = ["CHAPTERS", "Bench", "Chapter", "Row", "chosen", "rows_of", "table"]


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
    "contacts": Chapter("touches of walls told from hands and from broken sensors", contacts.contacts),
}


def chosen(names: list[str]) -> list[str]:
    """The names of the chapters to run: those given, or all.

    Raises:
        InputError: there is no such chapter.
    """
    for name in names:
        if name not in CHAPTERS:
            raise InputError(str(unknown("chapter", name, list(CHAPTERS))))
    return names or list(CHAPTERS)


def rows_of(bench: Bench, names: list[str], report: Callable[[str], None] = lambda _: None) -> list[Row]:
    """Measure all rows of some chapters; `report` is called with the name of each chapter as it begins."""
    rows = []
    for name in chosen(names):
        report(name)
        rows += list(CHAPTERS[name].rows(bench))
    return rows


def table(rows: list[Row]) -> str:
    """The rows as a Markdown table."""
    lines = ["| what | target | measured | |", "|---|---|---|---|"]
    return "\n".join([*lines, *[f"| {r.what} | {r.target} | {r.measured} | {r.mark} |" for r in rows]])
