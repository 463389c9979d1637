"""The errata of the paper, from `data/paper/errata.toml`, as records and as Markdown."""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib.resources import files
from itertools import groupby
from typing import NamedTuple

DATA = files("tandemlift") / "data" / "paper"
INDEXED = re.compile(r"(?<!\w)(\w[\u0300-\u036f]*)_(\w+)")  # a letter, be it with dots, and its index


class Erratum(NamedTuple):
    """An erratum: the printed text, the correct one, and the effect of the difference.

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


def errata_markdown() -> str:
    """A section for each group of errata, and one for each erratum."""
    parts: list[str] = []
    for group, members in groupby(errata(), key=lambda erratum: erratum.group):
        parts += [f"## {group}", *(_section(erratum) for erratum in members)]
    return "\n\n".join(parts) + "\n"


def _section(erratum: Erratum) -> str:
    setting = f" Setting: `{erratum.setting}`." if erratum.setting else ""
    return "\n".join(
        (
            f"### `{erratum.about}`: {erratum.title}",
            "",
            f"- Printed: {_with_indices(erratum.printed)}",
            f"- Right: {_with_indices(erratum.right)}",
            f"- Shows: {_with_indices(erratum.shows)}{setting}",
            f"- Evidence: {', '.join(f'`{test}`' for test in erratum.evidence)}",
        )
    )


def _with_indices(text: str) -> str:
    """A text with x_y as x and a lowered y, code apart."""
    parts = text.split("`")
    parts[::2] = [INDEXED.sub(r"\1<sub>\2</sub>", part) for part in parts[::2]]
    return "`".join(parts)
