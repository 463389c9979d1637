"""The drawings of the report: diagrams of the mission `paper`, and figures of our flights."""

from __future__ import annotations

from typing import Any

from tandemlift.figures.diagrams.registry import diagrams
from tandemlift.figures.registry import figures
from tandemlift.report.paper.contents import PaperFigure


def drawing_for(name: str) -> Any:
    """The module that draws a part of a figure: it has a CAPTION and `draw`."""
    return {**figures(), **diagrams()}[name]


def file_of(figure: PaperFigure, name: str) -> str:
    """The name of the file of a part of a figure, such as `figure-5a-vehicle_sizes.pdf`."""
    names = [part for part, _, _ in figure.parts]
    letter = "abcd"[names.index(name)] if len(names) > 1 else ""
    return f"figures/figure-{figure.number}{letter}-{name.replace('_', '-')}.pdf"
