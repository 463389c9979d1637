"""The page of an identification: estimates with intervals, residuals, correlations, and what was predicted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tandemlift.core.files import versions
from tandemlift.flight.channels import channel_of
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.style import BLUE, GREY, INK, PAPER, look, page_figure, points, styled
from tandemlift.pictures.report.page import DASH, Cell, PageTable, code, number, shown_figures, strong, write_page

PAGE = "identification.html"
WIDEST = 100.0  # %, change of a number that is drawn: a drag that is nearly 0 in the mission changes by thousands
CAPTIONS = {
    "estimates": Caption(
        "Estimates over the values of the mission",
        "Change of each number from the mission's value, with its interval of 95 %. Hollow: not excited by the flight. "
        "Arrows: beyond the figure. Numbers that are 0 in the mission are left out.",
        "A row for each identified number with its relative change and interval.",
    ),
    "misfit": Caption(
        "Residuals over time",
        "Root mean square of the residuals of each window over the noise. Crosses: windows that were held back.",
        "Points near 1 for each stream over the time of the log.",
    ),
    "example": Caption(
        "A window",
        "Measured (points) and predicted (lines) readings in the last window that was used, less the mean.",
        "Panels of measured and predicted readings over a second.",
    ),
    "autocorrelation": Caption(
        "Autocorrelation of residuals",
        "Of block means; grey: the largest bound for white noise.",
        "Curves of the autocorrelation over the lag for each stream.",
    ),
    "correlation": Caption(
        "Correlation of the errors of estimates",
        "Blue: errors of opposite sign; red: of the same sign.",
        "A square map of correlations between minus one and one.",
    ),
}


def write_identification(found: Mapping[str, Any], folder: Path) -> Path:
    """Write the page of an identification, as `identification.json` has it, into a folder that is there."""
    drawn = {
        "estimates": draw_estimates(found["parameters"]),
        "misfit": draw_misfit(found["misfit"], found["held_back"].get("windows", {})),
        "example": draw_example(found["example"]),
        "autocorrelation": draw_autocorrelation(found["whiteness"]),
        "correlation": draw_correlation([r["key"] for r in found["parameters"]], found["correlation"]),
    }
    used, left_out = found["windows"]["used"], found["windows"]["left_out"]
    return write_page(
        folder / PAGE,
        "identification",
        name=found["mission"],
        about=f"From {', '.join(found['logs'])}: {used} windows, {left_out} left out, {found['steps']} steps.",
        verdict=None,
        remarks=found["remarks"],
        parameters=_table(found["parameters"], found["written"]),
        whole=_table(found["whole_vehicle"]),
        residuals=_residuals(found),
        streams=_streams(found["streams"]),
        assumptions=PageTable("setup", ("", "Assumed"), [[a, b] for a, b in found["assumptions"]]),
        figures=shown_figures(drawn, CAPTIONS),
        versions=f"Identified with {', '.join(f'{name} {version}' for name, version in versions('compiled').items())}.",
    )


def _table(rows: Sequence[Mapping[str, Any]], written: Mapping[str, float] | None = None) -> PageTable:
    titles = ("", "Estimate", "95 % from", "to", "Unit", "Mission", *["Written"] * bool(written), "Efficiency")
    lines = [
        [
            code(r["key"]),
            *[number(r[name]) for name in ("value", "low", "high")],
            r["unit"],
            number(r["start"]),
            *([number(written[r["key"]])] if written else ()),
            f"{r['efficiency']:.2f}" if r["excited"] else strong("not excited"),
        ]
        for r in rows
    ]
    return PageTable("compared keys", titles, lines)


def _residuals(found: Mapping[str, Any]) -> PageTable:
    titles = ("Stream", "Noise", "Autocorrelation up to", "Bound", "White", "Factor of variance")
    lines = list[list[Cell]]()
    for name, w in found["whiteness"].items():
        ratios = [found[part].get("ratio", {}).get(name) for part in ("held_back", "predicted")]
        numbers = map(number, (found["noise"][name], max(map(abs, w["autocorrelation"])), w["bound"]))
        predicted = [DASH if ratio is None else number(ratio) for ratio in ratios]
        lines.append([code(name), *numbers, "yes" if w["white"] else strong("no"), number(w["factor"]), *predicted])
    return PageTable("compared keys", (*titles, "Held back", "Another flight"), lines)


def _streams(tests: Sequence[Mapping[str, str]]) -> PageTable:
    titles = ("Streams", "Test", "Found", "Expected", "Verdict")
    lines: list[list[Cell]] = [[t["stream"], t["test"], t["found"], t["expected"] or DASH, t["verdict"]] for t in tests]
    return PageTable("setup", titles, lines)


@styled
def draw_estimates(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw the relative change of each number, with its interval."""
    shown = [r for r in rows if r["start"]]
    figure = page_figure(0.5 + 0.17 * len(shown))
    axes = figure.add_subplot()
    for place, r in enumerate(reversed(shown)):
        low, value, high = (100.0 * (r[name] / r["start"] - 1.0) for name in ("low", "value", "high"))
        axes.plot([low, high], [place, place], color=BLUE, lw=1.6)
        marker = "<" if value < -WIDEST else ">" if value > WIDEST else "o"
        at = min(max(value, -WIDEST), WIDEST)
        face = INK if r["excited"] else PAPER  # above the interval, which would show through a marker without a face
        axes.plot(at, place, marker, color=INK, ms=4.0, mew=0.8, mfc=face, zorder=3, clip_on=False)
    axes.set_yticks(range(len(shown)), [r["key"] for r in reversed(shown)])
    axes.axvline(0.0, color=GREY, lw=0.8)
    axes.set_xlim(-WIDEST, WIDEST)
    axes.set_xlabel("change from the mission (%)")
    return figure


@styled
def draw_misfit(used: Mapping[str, Any], held: Mapping[str, Any]) -> Figure:
    """Draw the residuals of every window over the noise."""
    figure = page_figure(2.4)
    axes = figure.add_subplot()
    for place, (name, windows) in enumerate(used.items()):
        style = look(place, ls="none", ms=3.0)
        axes.plot(*np.transpose(windows), marker=".", label=name.removeprefix("measured_").replace("_", " "), **style)
        if name in held:
            axes.plot(*np.transpose(held[name]), marker="x", **style)
    axes.margins(x=0.02)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("residuals over noise (1)")
    figure.legend(loc="outside upper center", ncols=4)
    return figure


@styled
def draw_example(panels: Mapping[str, Any]) -> Figure:
    """Draw measured and predicted readings of a window."""
    figure = page_figure(1.4 * len(panels))
    every = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (name, panel) in zip(every, panels.items(), strict=True):
        measured, predicted = np.array(panel["measured"]), np.array(panel["predicted"])
        middle = predicted.mean(axis=0)
        for place in range(min(measured.shape[1], 3)):
            axes.plot(panel["time"], measured[:, place] - middle[place], **look(place, ls="none", marker=".", ms=2.0))
            axes.plot(panel["time"], predicted[:, place] - middle[place], label="xyz"[place], **look(place))
        axes.set_ylabel(f"{name.removeprefix('measured_').replace('_', chr(10))}\n({channel_of(name).unit})")
    every[0].legend(ncols=3)
    every[-1].set_xlabel("time (s)")
    return figure


@styled
def draw_autocorrelation(white: Mapping[str, Any]) -> Figure:
    """Draw the autocorrelation of the residuals of each stream."""
    figure = page_figure(2.2)
    axes = figure.add_subplot()
    bound = max(w["bound"] for w in white.values())
    for place, (name, w) in enumerate(white.items()):
        lags = range(1, len(w["autocorrelation"]) + 1)
        axes.plot(lags, w["autocorrelation"], label=name.removeprefix("measured_").replace("_", " "), **look(place))
    for side in (-bound, bound):
        axes.axhline(side, color=GREY, lw=0.8)
    axes.set_xlabel("lag (blocks)")
    axes.set_ylabel("autocorrelation (1)")
    figure.legend(loc="outside upper center", ncols=4)
    return figure


@styled
def draw_correlation(keys: Sequence[str], matrix: Sequence[Sequence[float]]) -> Figure:
    """Draw the correlations of the errors of estimates as a map."""
    figure = page_figure(2.2 + 0.14 * len(keys))
    axes: Axes = figure.add_subplot()
    image = axes.imshow(matrix, cmap="RdBu_r", vmin=-1.0, vmax=1.0, interpolation="nearest")
    figure.colorbar(image, ax=axes, label="correlation (1)")
    axes.set_xticks(range(len(keys)), keys, rotation="vertical", fontsize=points(6.5))
    axes.set_yticks(range(len(keys)), keys, fontsize=points(6.5))
    return figure
