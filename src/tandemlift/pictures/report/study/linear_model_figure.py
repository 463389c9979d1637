"""A linear model on a page: its modes in the plane of s, and how an input moves an output over the frequency."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tandemlift.core.types import Array
from tandemlift.pictures.drawing.style import (
    BLUE,
    COMPONENTS,
    GREY,
    PALE,
    VERMILLION,
    StyledFigure,
    page_figure,
    points,
    styled,
)

LINEAR = 0.1  # 1/s, within which the axes of the poles are linear
RATIOS = (0.1, 0.3, 0.7)  # damping ratios that are drawn
ROOM = 2.0  # by how much the axes go beyond the poles
SMALLEST = 1e-9  # of the largest response: a smaller one is rounding, and not drawn


class Response(NamedTuple):
    """How an input moves an output.

    Attributes:
        title: names both.
        unit: of the curves' sizes.
        frequencies: [Hz] (F).
        curves: the response (F) along each axis, by its label.
    """

    title: str
    unit: str
    frequencies: Array
    curves: Mapping[str, NDArray[np.complexfloating]]


@styled
def draw(title: str, poles: Sequence[complex], response: Response) -> Figure:
    """Draw the poles [1/s] of a model, and a response."""
    figure: StyledFigure = page_figure(3.1)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.15))
    _poles(figure.add_subplot(grid[:, 0]), np.array(poles))
    _response(figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1]), response)
    figure.suptitle(title, fontsize=points(9.5))
    return figure


def _poles(axes: Axes, s: NDArray[np.complexfloating]) -> None:
    far = ROOM * max(float(np.abs(s).max(initial=1.0)), 1.0)
    axes.set_xscale("symlog", linthresh=LINEAR)
    axes.set_yscale("symlog", linthresh=LINEAR)
    radius = np.geomspace(1e-3 * LINEAR, far, 200)
    for ratio in RATIOS:
        x, y = -ratio * radius, np.sqrt(1.0 - ratio * ratio) * radius
        axes.plot(x, y, color=PALE, lw=0.7)
        axes.plot(x, -y, color=PALE, lw=0.7)
        end = int(np.searchsorted(y, far / 1.5))
        axes.text(x[end - 1], y[end - 1], f"{ratio:g}", color=GREY, fontsize=points(7), ha="left", va="center")
    axes.axvline(0.0, color=GREY, lw=0.7)
    for stable, colour in ((True, BLUE), (False, VERMILLION)):
        chosen = s[(s.real < 0.0) == stable]
        for sign in (1.0, -1.0):
            axes.plot(chosen.real, sign * chosen.imag, "x", color=colour, ms=4.5, mew=1.0)
    axes.set_xlim(-far, LINEAR if not np.any(s.real > 0.0) else far)
    axes.set_ylim(-far, far)
    axes.set_xlabel("Re s [1/s]")
    axes.set_ylabel("Im s [rad/s]")
    axes.set_title("modes, and lines of damping ratio")


def _response(size: Axes, phase: Axes, response: Response) -> None:
    frequencies = response.frequencies
    largest = max((np.abs(values).max() for values in response.curves.values()), default=0.0)
    for (label, values), style in zip(response.curves.items(), COMPONENTS, strict=False):
        curve = np.where(np.abs(values) > SMALLEST * largest, values, np.nan)
        size.loglog(frequencies, np.abs(curve), label=label, **style)
        phase.semilogx(frequencies, np.degrees(np.unwrap(np.angle(np.nan_to_num(curve)))), **style)
    size.set_title(response.title)
    size.set_ylabel(f"size [{response.unit}]")
    phase.set_ylabel("phase [deg]")
    phase.set_xlabel("frequency [Hz]")
    size.tick_params(labelbottom=False)
    for axes in (size, phase):
        axes.grid(True)
        axes.set_xlim(frequencies[0], frequencies[-1])
    size.legend(loc="lower left")
