"""A linear model on a page: its modes in the plane of s, and how an input moves an output over the frequency."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from tandemlift.analysis.linearization.frequency_response import frequency_response
from tandemlift.analysis.linearization.linear_model import MOST_STATES, LinearModel, modes_of, title_of
from tandemlift.core.errors import InputError
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
    save,
    styled,
)

LINEAR_SPAN = 0.1  # 1/s, within which the axes of the poles are linear
RATIOS = (0.1, 0.3, 0.7)  # damping ratios that are drawn
ROOM = 2.0  # by how much the axes go beyond the poles
LOWEST_FREQUENCY, HIGHEST_FREQUENCY, POINTS = 0.02, 0.45, 300  # Hz, of the sample rate; points of a drawn response
RESPONSE_FLOOR = 1e-12  # of the largest response at a frequency: a smaller one is rounding of the model, and not drawn
AXES = {"roll": "x", "pitch": "y", "yaw": "z"}
NAME = re.compile(r"(\w+?)_([a-z]+_\d+|[^_]+)")


class Response(NamedTuple):
    """How an input moves an output.

    Attributes:
        title: names both, and says how many of their responses are drawn.
        unit: of the curves' sizes.
        frequencies: [Hz] (F).
        curves: the drawn responses (F) by label; NaN where one is only rounding.
    """

    title: str
    unit: str
    frequencies: Array
    curves: Mapping[str, NDArray[np.complexfloating]]


def response_of(model: LinearModel, input: str, output: str) -> Response:
    """The responses of a group of outputs to one of inputs: along like axes, else of the first inputs that move any.

    Args:
        model: the model.
        input: name of a group of inputs, such as "push_force".
        output: that of outputs, such as "position".
    """
    columns, rows = (
        [i for i, v in enumerate(variables) if split(v.name)[0] == group]
        for variables, group in ((model.inputs, input), (model.outputs, output))
    )
    frequencies = np.geomspace(LOWEST_FREQUENCY, HIGHEST_FREQUENCY / model.step, POINTS)
    responses = frequency_response(model, frequencies)[:, rows][:, :, columns]
    # coupling that symmetry forbids is as small as the rounding of the flight's state, next to what is allowed
    sizes = np.abs(responses)
    responses[sizes <= RESPONSE_FLOOR * sizes.max(axis=(1, 2), keepdims=True)] = np.nan
    names = [[split(v[i].name)[1] for i in at] for v, at in ((model.inputs, columns), (model.outputs, rows))]
    moved = {
        (f"{a} → {b}".replace("_", " "), AXES.get(a, a) == AXES.get(b, b)): responses[:, i, j]
        for j, a in enumerate(names[0])
        for i, b in enumerate(names[1])
        if np.isfinite(responses[:, i, j]).any()
    }
    alike = {label: curve for (label, like), curve in moved.items() if like}
    curves = alike or {label: curve for (label, _), curve in moved.items()}
    curves = dict(list(curves.items())[: len(COMPONENTS)])
    title = f"{input} → {output}".replace("_", " ") + f": {len(curves)} of {responses[0].size} responses"
    units = [
        f"({u})" if set(u) & set(" /") else u for u in (model.outputs[rows[0]].unit, model.inputs[columns[0]].unit)
    ]
    return Response(title, "/".join(units), frequencies, curves)


def split(name: str) -> tuple[str, str]:
    """The group and the component of a name: "push_force", "x"; "rotor_thrusts", "rotor_1"; of one word, it twice."""
    found = NAME.fullmatch(name)
    return (found[1], found[2]) if found else (name, name)


@styled
def draw(title: str, poles: Sequence[complex], response: Response) -> Figure:
    """Draw the poles [1/s] of a model, and a response."""
    figure: StyledFigure = page_figure(3.1)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.15))
    _poles(figure.add_subplot(grid[:, 0]), np.array(poles))
    _response(figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1]), response)
    figure.suptitle(title, fontsize=points(9.5))
    if response.curves:
        figure.legend(loc="outside lower right", ncols=len(COMPONENTS))
    return figure


def _poles(axes: Axes, s: NDArray[np.complexfloating]) -> None:
    far = ROOM * max(float(np.abs(s).max(initial=1.0)), 1.0)
    axes.set_xscale("symlog", linthresh=LINEAR_SPAN)
    axes.set_yscale("symlog", linthresh=LINEAR_SPAN)
    radius = np.geomspace(1e-3 * LINEAR_SPAN, far, 200)
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
    axes.set_xlim(-far, LINEAR_SPAN if not np.any(s.real > 0.0) else far)
    axes.set_ylim(-far, far)
    axes.set_xlabel("Re s [1/s]")
    axes.set_ylabel("Im s [rad/s]")
    axes.set_title("modes, and lines of damping ratio")


def _response(size: Axes, phase: Axes, response: Response) -> None:
    frequencies = response.frequencies
    for (label, curve), style in zip(response.curves.items(), COMPONENTS, strict=False):
        drawn = np.isfinite(curve)
        angles = np.full(len(curve), np.nan)
        angles[drawn] = np.degrees(np.unwrap(np.angle(curve[drawn])))
        size.loglog(frequencies, np.abs(curve), label=label, **style)
        phase.semilogx(frequencies, angles, **style)
    size.set_title(response.title)
    size.set_ylabel(f"size [{response.unit}]")
    phase.set_ylabel("phase [deg]")
    phase.set_xlabel("frequency [Hz]")
    size.tick_params(labelbottom=False)
    for axes in (size, phase):
        axes.grid(True)
        axes.set_xlim(frequencies[0], frequencies[-1])


def draw_linear_model(connected: LinearModel, path: Path) -> Path:
    """Draw the modes of a model and a response into a file: that of its position to a push, or of what it has first.

    Raises:
        InputError: it has too many states.
    """
    if len(connected.states) > MOST_STATES:
        raise InputError(f"{path}: {len(connected.states)} states are too many to draw; at most {MOST_STATES}")
    inputs, outputs = ([split(v.name)[0] for v in vs] for vs in (connected.inputs, connected.outputs))
    usual = "push_force" if connected.of == "loop" else "disturbance_force"
    names = usual if usual in inputs else inputs[0], "position" if "position" in outputs else outputs[0]
    modes = [mode.s for mode in modes_of(connected).modes]
    return save(draw(title_of(connected), modes, response_of(connected, *names)), path)
