"""The response to a push, as `tl.feel(mission)` writes it: numbers, figure and page."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tandemlift.analysis.studies.closed_form import YAW
from tandemlift.analysis.studies.feel_study import HEADS, FeelStudy, gate_text, study_feel, table_of
from tandemlift.analysis.studies.standard_push import PushedAxis
from tandemlift.core.errors import FAILS, CheckResult
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Progress
from tandemlift.missions import MissionLike, format_toml, mission_of, tables_of
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.panels import fit, line
from tandemlift.pictures.drawing.style import (
    ACTUAL,
    DESIRED,
    GREY,
    INK,
    PALE,
    PAPER,
    StyledFigure,
    page_figure,
    save,
    styled,
)
from tandemlift.pictures.report.page import (
    DASH,
    NO_BREAK,
    PageTable,
    Verdict,
    shown_figures,
    strong,
    versions_of,
    write_page,
)

CAPTION = Caption(
    "Standard push",
    "Speed over time under a push that begins at once, lasts (grey), and ends at once: by the closed form of the "
    "admittance, M v′ + C v = F beyond the threshold, and flown, with filters, delays, limits and rotors. Circles: "
    "95 % of the final speed. Calm air, no walls, from hover.",
    "A panel over time for each axis: the speed that the admittance gives, and the speed of the flight.",
)
COLUMNS, HEIGHT = 2, 1.75  # in
LEAST_SPEED = 0.05  # m/s, span of an axis


@styled
def draw(study: FeelStudy) -> Figure:
    """Draw every axis of a study."""
    rows = math.ceil(len(study.pushed) / COLUMNS)
    figure: StyledFigure = page_figure(0.35 + HEIGHT * rows)
    grid = figure.add_gridspec(rows, COLUMNS)
    handles: list[Any] = []
    for i, pushed in enumerate(study.pushed):
        axes = figure.add_subplot(grid[i // COLUMNS, i % COLUMNS])
        handles = _panel(axes, pushed)
        if i + COLUMNS >= len(study.pushed):
            axes.set_xlabel("time from the beginning of the push (s)")
    names = ("pushed", "closed form", "flown", "95 % of the final speed")
    figure.legend(handles, names, loc="outside upper center", ncols=len(names), columnspacing=1.4)
    return figure


def _panel(axes: Axes, p: PushedAxis) -> list[Any]:
    """Fill the panel of an axis; returns the handles for the legend."""
    turning = p.feel.axis == YAW
    pushed = axes.axvspan(0.0, p.hold, facecolor=PALE, alpha=0.45, lw=0.0, zorder=0)
    closed = line(axes, p.time, p.closed, zorder=4, **DESIRED)
    flown = line(axes, p.time, p.flown, zorder=3, **ACTUAL)
    axes.axhline(0.0, color=GREY, lw=0.4, zorder=1)
    (mark,) = axes.plot([], [], "o", color=INK, ms=3.5, mfc=PAPER, mew=0.8)
    for answer, look in ((p.ideal, DESIRED), (p.real, ACTUAL)):
        if answer.time is not None and answer.final_speed is not None:
            at = (answer.time, 0.95 * answer.final_speed)
            axes.plot(*at, "o", color=look["color"], ms=3.5, mfc=PAPER, mew=0.9, zorder=5)
    fit(axes, p.closed, p.flown, np.zeros(1), least=LEAST_SPEED)
    axes.set_xlim(p.time[0], p.time[-1])
    axes.set_ylabel("yaw rate (rad/s)" if turning else f"$v_{p.feel.axis}$ (m/s)")
    axes.set_title(f"{p.feel.push:g} {'N m in yaw' if turning else f'N along {p.feel.axis}'}")
    return [pushed, closed, flown, mark]


NOTE = """Closed form → flown: a push that begins at once, lasts, and ends at once, in calm air from hover. The lag is
the mean delay of the speed against the push; apart is the largest difference between both speeds."""
FIGURE = "feel"


class FeelReport:
    """The data of a feel report.

    Args:
        study: from `study_feel`.

    Attributes:
        study: axes under the standard push and checks, as numbers.
    """

    def __init__(self, study: FeelStudy) -> None:
        self.study = study

    @property
    def checks(self) -> tuple[CheckResult, ...]:
        """Each check with its number, limit and remedy."""
        return self.study.checks

    def summary(self) -> dict[str, Any]:
        """All numbers in SI units, as in feel.json."""
        return self.study.summary()

    def lines(self) -> list[str]:
        """The table, and a sentence about the gate."""
        rows = [("", *HEADS), *table_of(self.study)]
        widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
        table = ["  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip() for row in rows]
        return [*table, gate_text(self.study)]

    def __str__(self) -> str:
        """The table, a sentence about the gate, and the failed checks."""
        failed = [f"{check.verdict}: {check.text}" for check in self.checks if check.verdict == FAILS]
        return "\n".join([*self.lines(), *failed])

    def figure(self) -> Figure:
        """The speed over time along each axis, by closed form and flown."""
        return draw(self.study)

    def save(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Write feel.json, feel.html, feel.png and feel.pdf atomically into a folder, which is made.

        Returns:
            The files.
        """
        folder, figure = Path(folder), self.figure()
        folder.mkdir(parents=True, exist_ok=True)
        files = [folder / f"{FIGURE}.json", folder / f"{FIGURE}.html"]
        _write(files[0], json.dumps(_plain(self.summary()), indent=1, ensure_ascii=False, allow_nan=False))
        self._write_page(files[1], figure)
        return [*files, *(save(figure, folder / f"{FIGURE}.{kind}") for kind in ("png", "pdf"))]

    def _write_page(self, path: Path, figure: Figure) -> None:
        tables = {"admittance": tables_of(self.study.mission)["admittance"]}
        write_page(
            path,
            "feel",
            name=self.study.mission.mission.name,
            verdict=_verdict(self.checks),
            note=NOTE,
            table=PageTable("axes", ("Axis", *HEADS), table_of(self.study)),
            gate=gate_text(self.study),
            figures=shown_figures({FIGURE: figure}, {FIGURE: CAPTION}),
            checks=_checks(self.checks),
            admittance=format_toml(tables),
            versions=f"Flown with {versions_of(self.study.pushed[0].flight)}.",
        )


def feel(mission: MissionLike, *, progress: Progress | None = None) -> FeelReport:
    """The feel of a mission's admittance: flown, checked, and ready to be shown.

    Args:
        mission: from `load_mission`, or its name or path.
        progress: called with (axes flown, axes in all).

    Raises:
        InputError: the mission cannot be flown without its surroundings.
    """
    return FeelReport(study_feel(mission_of(mission), progress))


def _write(path: Path, text: str) -> None:
    with atomic_write(path) as partial:
        partial.write_text(f"{text}\n", "utf-8")


def _plain(value: object) -> object:
    """A value for JSON, which has no infinity."""
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and abs(value) == float("inf") else value


def _verdict(checks: Iterable[CheckResult]) -> Verdict:
    failed = [check for check in checks if check.verdict == FAILS]
    if not failed:
        return Verdict("No check fails")
    named = ", ".join(dict.fromkeys(f"{check.check} {check.subject}".strip() for check in failed))
    count = "1 check fails" if len(failed) == 1 else f"{len(failed)} checks fail"
    return Verdict(count, f": {named}.", "missed")


def _checks(checks: Iterable[CheckResult]) -> PageTable:
    rows = []
    for c in checks:
        margin = DASH if c.margin is None else f"{100.0 * c.margin:.0f} %".replace("-", "−")
        said = strong(c.verdict) + f": {c.text}" if c.text else c.verdict
        name = f"{c.check} {c.subject}".replace(" ", NO_BREAK)
        rows.append((name, *(_with_unit(x, c.unit) for x in (c.value, c.limit)), margin, said))
    return PageTable("compared", ("Check", "Value", "Limit", "Margin", "What to do"), rows)


def _with_unit(value: float | None, unit: str) -> str:
    """A number with its unit, a fraction in percent."""
    if value is None:
        return DASH
    scale, shown = (100.0, "%") if unit == "1" else (1.0, unit)
    return f"{scale * value:.3g} {shown}".replace("-", "−").replace(" ", NO_BREAK)
