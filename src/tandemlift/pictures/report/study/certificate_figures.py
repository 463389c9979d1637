"""The figures of a certificate: disk margins, limits, the admittance at the hand, and the map of arms."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from tandemlift.analysis.certification.certificate import Certificate
from tandemlift.analysis.certification.claims import Claim, Tier
from tandemlift.analysis.certification.linear import DISK_PHASE_BAR
from tandemlift.pictures.drawing.figure import Caption
from tandemlift.pictures.drawing.style import (
    BLUE,
    COMPONENTS,
    GREY,
    INK,
    PAPER,
    VERMILLION,
    look,
    page_figure,
    styled,
)

CAPTIONS = {
    "margins": Caption(
        "Disk margins over the frequency",
        "The change of phase that each loop tolerates if its gain changes with it, the other loops closed; and that of "
        "all rotors, each by itself. Grey: the bar. The margin is the lowest point of a curve.",
        "Curves of the disk phase margin in degrees over the frequency, for each axis and for all rotors.",
    ),
    "box": Caption(
        "All parameters at once",
        "Upper bound of the structured singular value over the frequency, for the box of parameters. Below 1 nothing "
        "in it makes the hover oscillate; 1 over the peak is the factor of the box that is proven.",
        "A curve of the upper bound of mu over the frequency, with a line at 1.",
    ),
    "limits": Caption(
        "Limits of parameters, over the values of the mission",
        "Bars: from the value at which the vehicle oscillates below it to that above it, by linear models; an arrow: "
        "no limit on that side.",
        "Horizontal bars of the tolerated range of each parameter, with circles where flights found the limit, if any.",
    ),
    "hand": Caption(
        "Admittance at the hand",
        "Re Y over the frequency along each axis, while a push acts. Where it is negative, the vehicle can give energy "
        "to a hand: it is not passive there, and a stiff arm may make it oscillate.",
        "Curves of the real part of the admittance at the hand over the frequency, along x, y and z.",
    ),
    "shakes": Caption(
        "Largest shake over its frequency",
        "The largest peak of a sine of force along each axis that the vehicle answers for 8 s, by flights: it sinks by "
        "at most 0.1 m, and is at most 0.25 m and 5° off its reference. Grey: larger ones were not tried.",
        "A panel for each place of the hand: curves of the largest peak over the frequency, along x, y and z.",
    ),
    "map": Caption(
        "Stiffest arm over virtual mass and damping",
        "The stiffness [N/m] of a massless arm above which the vehicle that it holds oscillates, by linear models. "
        "Dot: the mission. Black line: the mission's stiffness.",
        "A map of the largest stable arm stiffness over virtual mass and virtual damping.",
    ),
}
FLOWN = {
    "limits": " Circles: the limits that flights found by bisection, without a model.",
    "map": " Circles and crosses: flights with an arm of that stiffness, stable and oscillating.",
}
MOST_PHASE = 120.0  # deg
AXIS_FACTOR = 1.3  # times the farthest limits, where the axis ends
EDGE = 0.03  # of a map's sides, beyond which a contour has no label


def certificate_figures(certificate: Certificate) -> dict[str, Figure]:
    """The figures that a certificate has data for, by name."""
    drawn = dict[str, Figure]()
    tiers = {tier.name: tier for tier in certificate.tiers}
    makers: tuple[tuple[str, str, str, Callable[[Tier], Figure]], ...] = (
        ("margins", "linear", "frequency", draw_margins),
        ("box", "structured", "upper_bound", draw_box),
        ("hand", "person", "frequency", draw_hand),
        ("shakes", "person", "shakes", draw_shakes),
        ("map", "person", "map", draw_map),
    )
    for name, tier, needed, make in makers:
        if tier in tiers and needed in tiers[tier].curves:
            drawn[name] = make(tiers[tier])
    limits = [claim for tier in certificate.tiers for claim in tier.claims if claim.range]
    return {**drawn, "limits": draw_limits(limits)} if limits else drawn


def certificate_captions(certificate: Certificate) -> dict[str, Caption]:
    """The captions of the figures; marks of flights are told where there are any."""
    tiers = certificate.tiers
    flown = {
        "limits": any(claim.range and claim.range[1] for tier in tiers for claim in tier.claims),
        "map": any(tier.curves.get("map", {}).get("flown") for tier in tiers),
    }
    return {n: c._replace(text=c.text + FLOWN[n]) if flown.get(n) else c for n, c in CAPTIONS.items()}


@styled
def draw_margins(tier: Tier) -> Figure:
    """Draw the disk phase margin of each axis and of all rotors over the frequency."""
    figure = page_figure(2.6)
    axes = figure.add_subplot()
    w = tier.curves["frequency"]
    for place, (name, sizes) in enumerate((n, s) for n, s in tier.curves.items() if n != "frequency"):
        axes.semilogx(w, 2.0 * np.degrees(np.arctan(0.5 * np.array(sizes))), label=name, **look(place))
    axes.axhline(DISK_PHASE_BAR, color=GREY, lw=0.8)
    axes.set_ylim(0.0, MOST_PHASE)
    axes.set_xlim(w[0], w[-1])
    axes.set_xlabel("frequency (rad/s)")
    axes.set_ylabel("disk phase margin (°)")
    figure.legend(loc="outside upper center", ncols=5)
    return figure


@styled
def draw_box(tier: Tier) -> Figure:
    """Draw the upper bound of the structured singular value over the frequency."""
    figure = page_figure(2.2)
    axes = figure.add_subplot()
    w = np.array(tier.curves["frequency"], float)
    axes.semilogx(w, tier.curves["upper_bound"], color=BLUE, lw=1.2)
    axes.axhline(1.0, color=GREY, lw=0.8)
    axes.set_ylim(bottom=0.0)
    axes.set_xlim(w[0], w[-1])
    axes.set_xlabel("frequency (rad/s)")
    axes.set_ylabel("upper bound of µ (1)")
    return figure


@styled
def draw_limits(claims: list[Claim]) -> Figure:
    """Draw the range of each parameter that has limits, over its value in the mission."""
    rows = dict[str, list[Claim]]()
    for claim in claims:
        rows.setdefault(claim.parameter, []).append(claim)
    figure = page_figure(0.9 + 0.28 * len(rows))
    axes = figure.add_subplot()
    ends = [1.0, *(end for claim in claims if claim.range for end in claim.range if end)]
    axes.set_xlim(min(ends) / AXIS_FACTOR, max(ends) * AXIS_FACTOR)
    for place, found in enumerate(rows.values()):
        _limit_row(axes, -place, found)
    axes.set_yticks([-place for place in range(len(rows))], list(rows))
    axes.axvline(1.0, color=INK, lw=0.8)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter("{x:g}")
    axes.set_xlabel("limit / nominal value")
    return figure


def _limit_row(axes: Axes, height: float, claims: list[Claim]) -> None:
    low, high = axes.get_xlim()
    ranges = [claim.range for claim in claims if claim.range]
    least, most = min(limit for limit, _ in ranges), max(limit for limit, _ in ranges)
    if least < 1.0:
        low = least
    else:
        axes.plot(low, height, "<", color=BLUE, ms=5.0, clip_on=False, zorder=4)
    if most > 1.0:
        high = most
    else:
        axes.plot(high, height, ">", color=BLUE, ms=5.0, clip_on=False, zorder=4)
    axes.barh(height, high - low, left=low, height=0.5, color=BLUE, alpha=0.35, zorder=2)
    for limit, flown in ranges:
        axes.plot([limit] * 2, [height - 0.3, height + 0.3], color=BLUE, lw=1.4, zorder=3)
        if flown is not None:
            axes.plot(flown, height, "o", color=VERMILLION, ms=4.5, mfc=PAPER, mew=1.0, zorder=4)


@styled
def draw_hand(tier: Tier) -> Figure:
    """Draw the real part of the admittance at the hand."""
    figure = page_figure(2.3)
    axes = figure.add_subplot()
    frequency = np.array(tier.curves["frequency"]) / (2.0 * math.pi)
    for axis, style in zip("xyz", COMPONENTS, strict=True):
        axes.semilogx(frequency, tier.curves[axis], label=axis, **style)
    axes.axhline(0.0, color=GREY, lw=0.8)
    axes.set_xlim(frequency[0], frequency[-1])
    axes.set_xlabel("frequency (Hz)")
    axes.set_ylabel("Re Y (m/(s N))")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


@styled
def draw_shakes(tier: Tier) -> Figure:
    """Draw the largest shakes over their frequency, a panel for each place."""
    figure, data = page_figure(2.4), tier.curves["shakes"]
    places = list(dict.fromkeys(name.rpartition(", ")[0] for name in data["peaks"]))
    panels = figure.subplots(1, len(places), sharey=True, squeeze=False)[0]
    for axes, place in zip(panels, places, strict=True):
        axes.axhline(data["most"], color=GREY, lw=0.8)
        for axis, style in zip("xyz", COMPONENTS, strict=True):
            peaks = np.minimum(data["peaks"][f"{place}, {axis}"], data["most"])
            axes.loglog(data["frequency"], peaks, marker="o", ms=2.0, label=axis, **style)
        for scale in (axes.xaxis, axes.yaxis):
            scale.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            scale.set_major_formatter("{x:g}")
            scale.set_minor_formatter("")
        axes.set_title(place)
        axes.set_xlabel("frequency (Hz)")
    panels[0].set_ylabel("largest peak (N)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


@styled
def draw_map(tier: Tier) -> Figure:
    """Draw the stiffest arm over virtual mass and damping."""
    figure = page_figure(3.0)
    axes = figure.add_subplot()
    axes.set_xscale("log")
    axes.set_yscale("log")
    data = tier.curves["map"]
    stiffness = np.log10(np.maximum(np.array(data["stiffness"], float), 1e-3)).T
    levels = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0]
    over = data["mass"], data["damping"], stiffness
    drawn = axes.contourf(*over, np.log10(levels), extend="both")
    lines = axes.contour(*over, np.log10(levels), colors=PAPER, linewidths=0.7)
    axes.clabel(lines, fmt=lambda level: f"{10.0**level:.4g}", manual=_label_places(axes, lines))
    axes.plot(*data["mission"], "o", color=VERMILLION, ms=6.0, mec=PAPER)
    for x, y, stable in data.get("flown", ()):
        axes.plot(x, y, "o" if stable else "x", color=INK, ms=4.0, mfc=PAPER)
    axes.contour(*over, [math.log10(data["arm_stiffness"])], colors=INK, linewidths=1.4)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("{x:g}")
    axes.set_xlabel("virtual mass (kg)")
    axes.set_ylabel("virtual damping (N s/m)")
    bar = figure.colorbar(drawn, ax=axes, label="arm stiffness (N/m)")
    bar.set_ticks(np.log10(levels).tolist(), labels=[f"{level:g}" for level in levels])
    return figure


def _label_places(axes: Axes, lines: ContourSet) -> list[tuple[float, float]]:
    """The point of each contour that is farthest from the frame, unless it is too near for a label."""
    low, high = np.log10([axes.get_xlim(), axes.get_ylim()]).T
    found = list[tuple[float, float]]()
    for path in lines.get_paths():
        points = np.asarray(path.vertices, float)
        off = np.abs((np.log10(points) - low) / (high - low) - 0.5).max(axis=1)
        if len(off) and off.min() < 0.5 - EDGE:
            x, y = points[int(np.argmin(off))].tolist()
            found.append((x, y))
    return found
