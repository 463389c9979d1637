"""The paper's figures beside ours: texts and open settings from `data/paper/figures.toml`, and the drawings.

A drawing is a diagram of the mission `paper`, an SVG file of the package, or a figure of one of our flights.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from tandemlift.core.errors import InputError
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, load_mission
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.scene import NEAR, on_paper
from tandemlift.pictures.drawing.style import (
    BLUE,
    EDGE,
    GLASS,
    GROUND,
    INK,
    PAPER,
    VERMILLION,
    page_figure,
    points,
    styled,
)
from tandemlift.pictures.drawing.surroundings import walls_in
from tandemlift.pictures.drawing.vehicle import Skeleton, floor_height, skeleton
from tandemlift.pictures.figures.registry import figures, save_figure

DATA = files("tandemlift") / "data" / "paper"


class Erratum(NamedTuple):
    """An erratum: the printed text, the correct one, and the effect of the difference; formulas are between dollars.

    Attributes:
        about: the label of the equation, or the name of the claim or table.
        group: Formulas, Claims, Tables, or a difference of ours.
        kind: typo, notation, substance, or ours.
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
    kind: str
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
        curves: channels in which a reader's curves are laid over ours.
    """

    number: int
    title: str
    shows: str
    differs: str
    command: str
    parts: list[tuple[str, str, str]]
    curves: list[str] = []  # noqa: RUF012


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


def with_settings(name: str, changes: Mapping[str, Any]) -> list[Mission | None]:
    """A mission with each open setting chosen otherwise; None for a setting of the paper's that it does not have."""
    found: list[Mission | None] = []
    for setting in open_settings():
        try:
            found.append(load_mission(name, {**changes, **setting.changes}))
        except InputError:
            found.append(None)
    return found


def future_work() -> list[dict[str, str]]:
    """What the paper leaves to future work: `direction`, what is `here`, and what is `missing`."""
    return list(_contents()["future"])


def caption_of(name: str) -> Caption:
    """The caption of a drawing."""
    if name in diagram_captions():
        return diagram_captions()[name]
    return STAGES_CAPTION if name == STAGES else figures()[name].CAPTION


def write_drawing(name: str, flight: Flight | None, path: Path) -> None:
    """Write a drawing: a figure of a flight as PDF, or a diagram, which is an SVG file of the package."""
    if flight is not None:
        save_figure(draw_stages(flight) if name == STAGES else figures()[name].draw(flight), path)
        return
    with atomic_write(path) as partial:
        partial.write_bytes((DATA / "diagrams" / f"{name}.svg").read_bytes())


def curve_channels() -> list[str]:
    """The channels in which a reader's curves are laid over ours, in the order of the figures."""
    return list(dict.fromkeys(channel for figure in paper_figures() for channel in figure.curves))


def write_curves(figure: PaperFigure, ours: Flight, curves: Flight, path: Path) -> bool:
    """Write a reader's curves over ours, if they have any of the figure's channels; whether they have."""
    shown = [channel for channel in figure.curves if channel in curves]
    if shown:
        save_figure(over_time(*shown)({"here": ours, curves.name: curves}), path)
    return bool(shown)


def file_of(figure: PaperFigure, name: str) -> str:
    """The name of the file of a part of a figure, such as `figure-5b-path.pdf`."""
    names = [part for part, _, _ in figure.parts]
    letter = "abcd"[names.index(name)] if len(names) > 1 else ""
    kind = "svg" if name in diagram_captions() else "pdf"
    return f"figures/figure-{figure.number}{letter}-{name.replace('_', '-')}.{kind}"


# paper: fig9, a to d
STAGES_CAPTION = Caption(
    "The corridor in four stages",
    "The vehicle to scale, the way that its centre of mass has flown so far, the walls, which are transparent, and the "
    "push at that instant as an arrow (1 N is drawn as 0.75 m).",
    "Four views in space of the vehicle between walls: before the corridor, on the way, at its end, landed.",
)

WORDS = ("standing before the corridor", "on the way", "at the end of the corridor", "landed")
VIEW = np.array([3.8, 4.2])  # m of the corridor shown around the vehicle, along x and y
NEWTON = 0.75  # m of the view, for a newton
FLYING = 0.97  # of the height: lower samples are of lift or landing
MIN_PUSH = 0.05  # N: a weaker push is not drawn


def stages(flight: Flight) -> list[int]:
    """The samples of the four stages: the first; half of the way; the last before landing; the last of all."""
    path = flight["position"]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1))])
    high = np.flatnonzero(path[:, 2] > path[0, 2] + FLYING * (path[:, 2].max() - path[0, 2]))
    last = int(high[-1]) if len(high) else len(path) - 1
    return [0, int(np.searchsorted(way, way[-1] / 2.0)), last, len(path) - 1]


def _vehicle(ax: Axes, body: Skeleton) -> None:
    discs = PolyCollection(list(on_paper(body.rotors)), facecolor=(PAPER, 0.85), edgecolor=INK, lw=0.7, zorder=10)
    bars = LineCollection(list(on_paper([*body.arms, *body.struts])), colors=INK, lw=0.9, zorder=10)
    ax.add_collection(discs)
    ax.add_collection(bars)
    ax.plot(*on_paper(body.beam).T, color=INK, lw=body.width(3.0), solid_capstyle="round", zorder=10)


def _walls(ax: Axes, flight: Flight, place: Array, floor: float) -> list[Array]:
    """Draw the walls around a place (3) [m], before the vehicle or behind it. Returns their rims (2, 3) [m]."""
    reach = np.append(VIEW, 10.0)
    rims, low, high = [], place - reach, place + reach
    for wall in walls_in(flight.walls, low, high):
        foot = np.column_stack([wall.rim[:, :2], np.full(2, floor)])
        nearer = (wall.rim.mean(axis=0) - place)[:2] @ NEAR[:2] > 0.0
        face = PolyCollection([on_paper([*wall.rim, *foot[::-1]])], facecolor=(GLASS, 0.35), lw=0.0)
        edges = LineCollection(list(on_paper([wall.rim, foot])), colors=EDGE, lw=0.6)
        for part in (face, edges):
            part.set_zorder(20 if nearer else 2)
            ax.add_collection(part)
        rims.append(wall.rim)
    return rims


def _stage(ax: Axes, flight: Flight, k: int) -> None:
    """Draw one instant."""
    place, floor = flight["position"][k], floor_height(flight) or 0.0
    ground = place + np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * [*VIEW, 0.0]
    ground[:, 2] = floor
    ax.add_collection(PolyCollection([on_paper(ground)], facecolor=GROUND, lw=0.0, zorder=0))
    flown = flight["position"][: k + 1]
    near = flown[(np.abs(flown - place)[:, :2] <= VIEW).all(axis=1)][::10]
    ax.plot(*on_paper(near).T, color=BLUE, lw=1.1, zorder=5)
    rims = _walls(ax, flight, place, floor)
    body = skeleton(flight.vehicle)
    _vehicle(ax, body.placed(place, flight["attitude"][k]))
    push = flight["push_force"][k]
    if np.linalg.norm(push) > MIN_PUSH:
        tail, tip = on_paper([place, place + NEWTON * push])
        arrow = {"arrowstyle": "-|>,head_length=0.35,head_width=0.16", "color": VERMILLION, "lw": 1.6, "shrinkA": 0}
        ax.annotate("", tip, tail, arrowprops={**arrow, "shrinkB": 0}, zorder=30)
    seen = on_paper([*ground, *(point for rim in rims for point in rim)])
    low, high = seen.min(axis=0), seen.max(axis=0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", anchor="N")
    ax.set_axis_off()


@styled
def draw_stages(flight: Flight) -> Figure:
    """Draw four instants of a flight that has walls."""
    figure = page_figure(4.9)
    axes = figure.subplots(2, 2)
    for ax, k, letter, words in zip(axes.flat, stages(flight), "abcd", WORDS, strict=True):
        _stage(ax, flight, k)
        ax.set_title(f"({letter})  {flight.time[k]:.1f} s: {words}", fontsize=points(8.5), loc="left")
    return figure
