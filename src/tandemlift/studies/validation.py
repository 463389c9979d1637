"""What the pilot is held to, measured: each row of the table is flown, in either engine, and put beside its target.

`tandemlift validate` prints it; docs/validation.md holds it with the machine and the versions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from tandemlift.common.errors import InputError, unknown
from tandemlift.studies import compliance, persons, rotor_losses, tracking, triggers
from tandemlift.studies.rows import Row
from tandemlift.studies.scenarios import Bench

__all__ = ["CHAPTERS", "Bench", "Chapter", "Row", "chosen", "rows_of", "table"]


class Chapter(NamedTuple):
    """Rows that belong together: what they are about, and how they are measured."""

    summary: str
    rows: Callable[[Bench], Iterator[Row]]


CHAPTERS: dict[str, Chapter] = {
    "tracking": Chapter(
        "the reference followed: calm, in wind, with wrong beliefs, with slow rotors", tracking.nominal
    ),
    "observers": Chapter("what an observer of the disturbance is worth", tracking.observers),
    "draws": Chapter("all of it at once, drawn at random", tracking.draws),
    "losses": Chapter("a rotor lost at any moment: found, and landed with", rotor_losses.losses),
    "triggers": Chapter("wind that is not to be taken for a hand, and a hand that is", triggers.triggers),
    "persons": Chapter("corridors, led through by a person; random persons", persons.persons),
    "yaw": Chapter("a push at the beam's end turns the vehicle", compliance.yaw),
}


def chosen(names: list[str]) -> list[str]:
    """The chapters of these names, all of them if there is none.

    Raises:
        InputError: there is no such chapter.
    """
    for name in names:
        if name not in CHAPTERS:
            raise InputError(str(unknown("chapter", name, list(CHAPTERS))))
    return names or list(CHAPTERS)


def rows_of(bench: Bench, names: list[str], told: Callable[[str], None] = lambda _: None) -> list[Row]:
    """Every row of some chapters, measured; `told` is given each chapter's name as it begins."""
    rows = []
    for name in chosen(names):
        told(name)
        rows += list(CHAPTERS[name].rows(bench))
    return rows


def table(rows: list[Row]) -> str:
    """The rows as a Markdown table."""
    lines = ["| what | target | measured | |", "|---|---|---|---|"]
    return "\n".join([*lines, *[f"| {r.what} | {r.target} | {r.measured} | {r.mark} |" for r in rows]])
