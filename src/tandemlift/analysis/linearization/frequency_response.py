"""The frequency response of a discrete linear model."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.linearization.linear_model import LinearModel
from tandemlift.core.types import Array


def frequency_response(model: LinearModel, frequencies: Array) -> NDArray[np.complex128]:
    """C (e^{jωT} − A)⁻¹ B + D (F, p, m) at frequencies (F,) [Hz], up to half of the sample rate."""
    unit = np.eye(len(model.A))
    turns = np.exp(2j * np.pi * np.asarray(frequencies) * model.step)
    return np.array([model.C @ np.linalg.solve(turn * unit - model.A, model.B) + model.D for turn in turns])
