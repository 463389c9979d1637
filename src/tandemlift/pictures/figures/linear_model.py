"""A linear model on a page: its modes in the plane of s, and how an input moves an output over the frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tandemlift.analysis.linearization.linear_model import LinearModel, Modes, frequency_response
from tandemlift.pictures.figures.drawing.style import (
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

LOWEST, HIGHEST, POINTS = 0.02, 0.45, 300  # Hz, of the sample rate; points of a curve
LINEAR = 0.1  # 1/s, within which the axes of the poles are linear
RATIOS = (0.1, 0.3, 0.7)  # damping ratios that are drawn
ROOM = 2.0  # by how much the axes go beyond the poles
SMALLEST = 1e-9  # of the largest response: a smaller one is rounding, and not drawn


@styled
def draw(model: LinearModel, modes: Modes, input: str, output: str) -> Figure:
    """Draw a model.

    Args:
        model: the model.
        modes: its modes.
        input: beginning of the names of inputs, such as "push_force".
        output: that of outputs, such as "position"; input i is drawn to output i.
    """
    figure: StyledFigure = page_figure(3.1)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.15))
    _poles(figure.add_subplot(grid[:, 0]), modes)
    size, phase = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
    _response(size, phase, model, input, output)
    figure.suptitle(
        f"{model.mission}: the {model.of} at {model.time:g} s, sample time {model.step * 1e3:g} ms",
        fontsize=points(9.5),
    )
    return figure


def _poles(axes: Axes, modes: Modes) -> None:
    s = np.array([mode.s for mode in modes.modes])
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


def _response(size: Axes, phase: Axes, model: LinearModel, input: str, output: str) -> None:
    columns, rows = _named(model.inputs, input), _named(model.outputs, output)
    frequencies = np.geomspace(LOWEST, HIGHEST / model.step, POINTS)
    response = frequency_response(model, frequencies)
    largest = max((np.abs(response[:, i, j]).max() for i, j in zip(rows, columns, strict=False)), default=0.0)
    for i, j, style in zip(rows, columns, COMPONENTS, strict=False):
        curve = np.where(np.abs(response[:, i, j]) > SMALLEST * largest, response[:, i, j], np.nan)
        size.loglog(
            frequencies, np.abs(curve), label=f"{model.inputs[j].name[-1]} → {model.outputs[i].name[-1]}", **style
        )
        phase.semilogx(frequencies, np.degrees(np.unwrap(np.angle(np.nan_to_num(curve)))), **style)
    size.set_title(f"{input.replace('_', ' ')} → {output.replace('_', ' ')}")
    unit_in, unit_out = (
        named[at[0]].unit if at else "" for named, at in ((model.inputs, columns), (model.outputs, rows))
    )
    size.set_ylabel(f"size [{unit_out}/{unit_in}]")
    phase.set_ylabel("phase [deg]")
    phase.set_xlabel("frequency [Hz]")
    size.tick_params(labelbottom=False)
    for axes in (size, phase):
        axes.grid(True)
        axes.set_xlim(frequencies[0], frequencies[-1])
    size.legend(loc="lower left")


def _named(variables: Sequence[Any], beginning: str) -> list[int]:
    return [i for i, v in enumerate(variables) if v.name.startswith(f"{beginning}_")]
