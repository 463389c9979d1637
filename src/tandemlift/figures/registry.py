"""The figures of a flight, by name: each is one file with one function `draw(flight)`.

The drawing library is loaded when the first figure is drawn, not when this package is imported.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from tandemlift.common.types import Progress
from tandemlift.flight.record import Flight

Draw = Callable[[Flight], Any]


def _files() -> dict[str, ModuleType]:
    """The file of each figure; with them the drawing library is imported."""
    from tandemlift.figures import (
        corridor,
        disturbance,
        inputs,
        interaction,
        joints,
        path,
        push,
        reference,
        rotors,
        surroundings,
        tracking,
    )

    files = (reference, path, tracking, inputs, interaction, push, disturbance, joints, rotors, surroundings, corridor)
    return dict(zip(NAMES, files, strict=True))


def _drawing(name: str) -> Draw:
    """The `draw` of a figure's file, which is imported at the first call."""

    def draw(flight: Flight) -> Any:
        return _files()[name].draw(flight)

    draw.__name__ = draw.__qualname__ = f"draw_{name}"
    return draw


NAMES = (
    *("reference", "path", "tracking", "inputs", "interaction"),  # in the order of the paper
    *("push", "disturbance", "joints", "rotors", "surroundings", "corridor"),
)
FIGURES: dict[str, Draw] = {name: _drawing(name) for name in NAMES}
"""All figures that there are; a flight has those of `figures_of`."""

VIEWS = "views"
"""Photographs of a flight, by `views.draw_views`: no flight can be drawn that way, so they are not among these."""

SHOWS: dict[str, tuple[str, ...]] = {
    "push": ("push_estimate",),
    "disturbance": ("disturbance_force",),
    "joints": ("joint_force",),
    "rotors": ("rotor_commands",),
    "surroundings": ("wind_velocity", "contact_force"),
}
"""Channels that a figure is about: a flight has it if it has one of them. A figure without is every flight's."""


def among_walls(flight: Flight) -> bool:
    """Whether there were walls around a flight."""
    mission = flight.mission
    return bool(mission.get("walls") or mission.get("corridor", {}).get("centreline"))


def figures_of(flight: Flight) -> dict[str, Draw]:
    """The figures that a flight has, in the order of `FIGURES`."""
    return {
        name: draw
        for name, draw in FIGURES.items()
        if name not in SHOWS or any(channel in flight.channels for channel in SHOWS[name])
        if name != "corridor" or among_walls(flight)
    }


def save_figure(figure: Any, path: Path) -> Path:
    """Write one figure as PNG or PDF, by the ending of the path; its folder is made if it does not exist."""
    from tandemlift.figures.drawing.style import save

    path.parent.mkdir(parents=True, exist_ok=True)
    return save(figure, path)


def save_figures(flight: Flight, folder: str | os.PathLike[str], progress: Progress | None = None) -> list[Path]:
    """Draw every figure that a flight has and write it as NAME.png and NAME.pdf; a file appears whole or not at all.

    Args:
        flight: a flight, also one that diverged or has few samples.
        folder: where to; made if it does not exist.
        progress: called after each figure with (figures written, figures in all).

    Returns:
        The files written, in the order of `FIGURES`, PNG before PDF.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    written, figures = [], figures_of(flight)
    for done, (name, draw) in enumerate(figures.items(), 1):
        figure = draw(flight)
        written += [save_figure(figure, folder / f"{name}.{kind}") for kind in ("png", "pdf")]
        if progress:
            progress(done, len(figures))
    return written
