"""The frequency response of a discrete linear model, and that of a group of outputs to one of inputs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.linearization.linear_model import LinearModel
from tandemlift.core.types import Array

LOWEST, HIGHEST, POINTS = 0.02, 0.45, 300  # Hz, of the sample rate; points of a drawn response


def frequency_response(model: LinearModel, frequencies: Array) -> NDArray[np.complex128]:
    """C (e^{jωT} − A)⁻¹ B + D (F, p, m) at frequencies (F,) [Hz], up to half of the sample rate."""
    unit = np.eye(len(model.A))
    turns = np.exp(2j * np.pi * np.asarray(frequencies) * model.step)
    return np.array([model.C @ np.linalg.solve(turn * unit - model.A, model.B) + model.D for turn in turns])


def axis_responses(model: LinearModel, input: str, output: str) -> tuple[str, Array, dict[str, NDArray[np.complex128]]]:
    """The responses of a group of outputs to one of inputs, each along its own axis.

    Args:
        model: the model.
        input: beginning of the names of inputs, such as "push_force".
        output: that of outputs, such as "position".

    Returns:
        The unit, frequencies (F,) [Hz], and the response (F,) of each axis by its label.
    """
    columns, rows = (
        [i for i, v in enumerate(variables) if v.name.startswith(f"{name}_")]
        for variables, name in ((model.inputs, input), (model.outputs, output))
    )
    frequencies = np.geomspace(LOWEST, HIGHEST / model.step, POINTS)
    response, pairs = frequency_response(model, frequencies), list(zip(rows, columns, strict=False))
    unit_in, unit_out = (v[at[0]].unit if at else "" for v, at in ((model.inputs, columns), (model.outputs, rows)))
    labels = [f"{model.inputs[j].name[-1]} → {model.outputs[i].name[-1]}" for i, j in pairs]
    curves = {label: response[:, i, j] for label, (i, j) in zip(labels, pairs, strict=True)}
    return f"{unit_out}/{unit_in}", frequencies, curves
