"""The errata of the paper, from `data/paper/errata.toml`."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files
from typing import NamedTuple

DATA = files("tandemlift") / "data" / "paper"


class Erratum(NamedTuple):
    """An erratum: the printed text, the correct one, and the effect of the difference; formulas are between dollars.

    Attributes:
        about: the label of the equation, or the name of the claim or table.
        group: Formulas, Claims or Tables.
        title: the error.
        printed: the paper's text.
        right: the correction.
        shows: a number that shows the difference.
        figures: those of the paper that it concerns.
        evidence: the tests that hold the numbers, below `tests/`.
        tables: those of the paper that it concerns.
        setting: the key that selects the printed form, if that can fly.
    """

    about: str
    group: str
    title: str
    printed: str
    right: str
    shows: str
    figures: list[int]
    evidence: list[str]
    tables: list[str] = []  # noqa: RUF012
    setting: str = ""


@cache
def errata() -> tuple[Erratum, ...]:
    """All errata: those of formulas in the paper's order, then of claims and of tables."""
    tables = tomllib.loads((DATA / "errata.toml").read_text("utf-8"))["errata"]
    return tuple(Erratum(**table) for table in tables)
