"""The drawings of the report: diagrams of the mission `paper`, drawn once, and figures of our flights."""

from __future__ import annotations

from pathlib import Path

from tandemlift.core.files import atomic_write
from tandemlift.flight.record import Flight
from tandemlift.pictures.figures.drawing.figure import Caption
from tandemlift.pictures.figures.registry import figures, save_figure
from tandemlift.pictures.report.paper import corridor_stages
from tandemlift.pictures.report.paper.contents import PaperFigure, diagram_captions
from tandemlift.pictures.report.paper.errata import DATA

STAGES = "corridor_stages"  # the one figure that only this report has


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
