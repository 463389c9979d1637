"""The figures of a flight, by name: each is one file with one function `draw(flight)`.

The drawing library is loaded when the first figure is drawn, not when this package is imported.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tandemlift.flight import Flight

Draw = Callable[[Flight], Any]
Progress = Callable[[int, int], None]


def _drawing(name: str) -> Draw:
    """The `draw` of a figure's file, which is imported at the first call."""

    def draw(flight: Flight) -> Any:
        return importlib.import_module(f"tandemlift.figures.{name}").draw(flight)

    draw.__name__ = draw.__qualname__ = f"draw_{name}"
    return draw


FIGURES: dict[str, Draw] = {name: _drawing(name) for name in ("reference", "path", "tracking", "inputs", "interaction")}


def save_figures(flight: Flight, folder: str | os.PathLike[str], progress: Progress | None = None) -> list[Path]:
    """Draw every figure of a flight and write each as NAME.png and NAME.pdf; each file appears whole or not at all.

    Args:
        flight: a flight, also one that diverged or has few samples.
        folder: where to; made if it does not exist.
        progress: called after each figure with (figures written, figures in all).

    Returns:
        The files written, in the order of `FIGURES`, PNG before PDF.
    """
    from tandemlift.figures.style import save

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for done, (name, draw) in enumerate(FIGURES.items(), 1):
        figure = draw(flight)
        written += [save(figure, folder / f"{name}.{kind}") for kind in ("png", "pdf")]
        if progress:
            progress(done, len(FIGURES))
    return written
