"""The figures of a flight, in their order. Each is a file with a caption, the flights that have it, and `draw(flight)`.

The drawing library is loaded on first use, not when this file is imported.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tandemlift.core.errors import InputError, suggestion, unknown
from tandemlift.core.plugs import PLUGS, Plug
from tandemlift.core.types import Progress
from tandemlift.flight.channels import CHANNELS
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.figure import Caption, all_flights, current_style, figure_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.pictures.drawing.figure import FlightFigure


class OwnFigure(NamedTuple):
    """A figure that a user has brought, of every flight."""

    CAPTION: Caption
    draw: Callable[[Flight], Figure]
    IN_FLIGHTS: Callable[[Flight], bool] = all_flights
    OVERLAY: None = None


def taken_in(made: Plug) -> OwnFigure:
    """The figure of a function of a `Flight`; the first line of its docstring is the caption."""
    if made.name in _built_in() or made.name in CHANNELS:
        raise InputError(f"the name {made.name!r} is taken by a figure or channel of the package; choose another")
    return OwnFigure(Caption(made.name, made.summary, made.summary), made.start)


PLUGS["figure"].open(taken_in)


def figures() -> dict[str, FlightFigure]:
    """All figures of flights by name: those of the paper in its order, the others, and those of users."""
    return {**_built_in(), **PLUGS["figure"]}


@cache
def _built_in() -> dict[str, FlightFigure]:
    from tandemlift.pictures.figures import (
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
    return {file.__name__.rpartition(".")[2]: file for file in files}


def captions() -> dict[str, Caption]:
    """The captions of all figures by name, in the order in which a report shows them."""
    return {name: figure.CAPTION for name, figure in figures().items()}


def figures_for(flight: Flight) -> dict[str, FlightFigure]:
    """The figures that a flight has, in the order of `figures`."""
    return {name: figure for name, figure in figures().items() if figure.IN_FLIGHTS(flight)}


def plot(flights: Flight | Sequence[Flight] | Mapping[str, Flight], name: str, *, style: str | None = None) -> Figure:
    """Draw a figure of a flight, or a figure or channel of several over each other; returns matplotlib's figure.

    Args:
        flights: one or several; the legend has their missions' names, or the names of a mapping.
        name: of a figure (`tracking`, `path`, …) or of a channel (`position`, …).
        style: `ieee`, `elsevier`, `slides` or `dark`; by default that of `figure_style`, which is IEEE's.

    Raises:
        InputError: no flight has such a figure or channel, it can only be drawn of one, or there is no such style.
    """
    from tandemlift.pictures.drawing.overlay import over_time

    given = _named([flights] if isinstance(flights, Flight) else flights)
    if not given:
        raise InputError("no flight to draw; give one at least")
    drawable = {name for flight in given.values() for name in figures_for(flight)}
    with figure_style(style):
        if any(name in flight for flight in given.values()):
            return over_time(name)(given)
        if name not in drawable:
            also = f" Channels can be drawn, too, such as position.{suggestion(name, CHANNELS)}"
            raise InputError(f"{unknown('figure', name, [n for n in figures() if n in drawable])}{also}")
        figure = figures()[name]
        if len(given) == 1:
            return figure.draw(*given.values())
        if figure.OVERLAY is None:
            raise InputError(f"{name}: cannot be drawn of several flights; draw `path`, or a channel such as position")
        return figure.OVERLAY({label: flight for label, flight in given.items() if figure.IN_FLIGHTS(flight)})


def _named(flights: Sequence[Flight] | Mapping[str, Flight]) -> dict[str, Flight]:
    """The flights by name; of flights of one mission, with their number."""
    if isinstance(flights, Mapping):
        return dict(flights)
    names = [flight.name for flight in flights]
    numbers = [f" {names[:i].count(name) + 1}" if names.count(name) > 1 else "" for i, name in enumerate(names)]
    return {flight.name + number: flight for flight, number in zip(flights, numbers, strict=True)}


def save_figure(figure: Figure, path: Path) -> Path:
    """Write one figure as PNG or PDF, by the ending of the path; its folder is made if it does not exist."""
    from tandemlift.pictures.drawing.style import save

    path.parent.mkdir(parents=True, exist_ok=True)
    return save(figure, path)


def save_flight_figure(flight: Flight, name: str, folder: Path) -> list[Path]:
    """Draw a figure that a flight has and write it atomically as NAME.png and NAME.pdf."""
    from tandemlift.pictures.drawing.style import under

    with under(current_style()):
        page = figures()[name].draw(flight)
        return [save_figure(page, folder / f"{name}.{kind}") for kind in ("png", "pdf")]


def save_figures(
    flight: Flight, folder: str | os.PathLike[str], progress: Progress | None = None, *, style: str | None = None
) -> list[Path]:
    """Draw every figure that a flight has and write it atomically as NAME.png and NAME.pdf.

    Args:
        flight: a flight, also one that diverged or has few samples.
        folder: where to; made if it does not exist.
        progress: called with (figures written, figures in all), first before any is drawn.
        style: `ieee`, `elsevier`, `slides` or `dark`; by default that of `figure_style`, which is IEEE's.

    Raises:
        InputError: there is no such style.

    Returns:
        The files written, in the order of `figures`, PNG before PDF.
    """
    folder = Path(folder)
    written, drawn = [], figures_for(flight)
    with figure_style(style):
        folder.mkdir(parents=True, exist_ok=True)
        if progress:
            progress(0, len(drawn))
        for done, name in enumerate(drawn, 1):
            written += save_flight_figure(flight, name, folder)
            if progress:
                progress(done, len(drawn))
    return written
