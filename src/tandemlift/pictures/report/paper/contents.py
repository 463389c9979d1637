"""The report's texts on the paper's figures and open settings, from `data/paper/figures.toml`."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any, NamedTuple

from tandemlift.pictures.figures.drawing.figure import Caption
from tandemlift.pictures.report.paper.errata import DATA


class PaperFigure(NamedTuple):
    """A figure of the paper and its counterpart here.

    Attributes:
        number: of the figure in the paper.
        title: of ours.
        shows: the content of the paper's figure, in our words.
        differs: the differences of ours, with reasons.
        command: that draws ours.
        parts: the name of each drawing, what it draws (`mission`, `paper flight` or `zigzag flight`), and what stands
            behind the number.
    """

    number: int
    title: str
    shows: str
    differs: str
    command: str
    parts: list[tuple[str, str, str]]


class OpenSetting(NamedTuple):
    """A choice that the paper leaves open: its key, the reason, and changes that show its effect."""

    key: str
    why: str
    changes: dict[str, Any]


@cache
def _contents() -> dict[str, Any]:
    return tomllib.loads((DATA / "figures.toml").read_text("utf-8"))


def paper_figures() -> list[PaperFigure]:
    """The paper's figures, in its order."""
    return [PaperFigure(**table) for table in _contents()["figures"]]


def diagram_captions() -> dict[str, Caption]:
    """The captions of the diagrams of the mission `paper`, by the names of their files in `data/paper/diagrams/`."""
    return {name: Caption(**table) for name, table in _contents()["diagrams"].items()}


def open_settings() -> list[OpenSetting]:
    """The choices that the paper leaves open."""
    return [OpenSetting(**table) for table in _contents()["open"]]
