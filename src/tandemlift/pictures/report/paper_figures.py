"""The paper's figures beside ours: texts and open settings from `data/paper/figures.toml`, and the drawings.

A drawing is a diagram of the mission `paper`, an SVG file of the package, or a figure of one of our flights.
"""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.core.files import atomic_write
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.figures.registry import figures, save_figure
from tandemlift.pictures.report import corridor_stages
from tandemlift.pictures.report.errata import DATA

STAGES = "corridor_stages"  # the one figure that only this report has


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


def caption_of(name: str) -> Caption:
    """The caption of a drawing."""
    if name in diagram_captions():
        return diagram_captions()[name]
    return corridor_stages.CAPTION if name == STAGES else figures()[name].CAPTION


def write_drawing(name: str, flight: Flight | None, path: Path) -> None:
    """Write a drawing: a figure of a flight as PDF, or a diagram, which is an SVG file of the package."""
    if flight is not None:
        save_figure((corridor_stages if name == STAGES else figures()[name]).draw(flight), path)
        return
    with atomic_write(path) as partial:
        partial.write_bytes((DATA / "diagrams" / f"{name}.svg").read_bytes())


def file_of(figure: PaperFigure, name: str) -> str:
    """The name of the file of a part of a figure, such as `figure-5b-path.pdf`."""
    names = [part for part, _, _ in figure.parts]
    letter = "abcd"[names.index(name)] if len(names) > 1 else ""
    kind = "svg" if name in diagram_captions() else "pdf"
    return f"figures/figure-{figure.number}{letter}-{name.replace('_', '-')}.{kind}"
