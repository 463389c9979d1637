"""The linear model of a hover against the differential equation of its admittance."""

from __future__ import annotations

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.linearization.frequency_response import frequency_response

MASS, DAMPING, STIFFNESS = 2.5, 3.0, 4.0  # kg, N s/m, N/m
FREQUENCIES = np.geomspace(0.02, 5.0, 24)  # Hz


@pytest.fixture(scope="module")
def model():
    """From a push to the admittance's answer, with another number along each axis."""
    changes = {
        "admittance.threshold": 0.0,
        "admittance.mass": [MASS, 2.0 * MASS, MASS],
        "admittance.damping": [DAMPING, DAMPING, 3.0 * DAMPING],
        "admittance.stiffness": [STIFFNESS, STIFFNESS, 0.5 * STIFFNESS],
    }
    outputs = ["admittance_position", "position"]
    return tl.linearize(tl.load_mission("hover", changes), inputs=["push_force"], outputs=outputs)


def admittance(axis: int) -> np.ndarray:
    s = 2j * np.pi * FREQUENCIES
    m, c, k = MASS * (1.0, 2.0, 1.0)[axis], DAMPING * (1.0, 1.0, 3.0)[axis], STIFFNESS * (1.0, 1.0, 0.5)[axis]
    return 1.0 / (m * s * s + c * s + k)


@pytest.mark.parametrize("axis", range(3))
def test_a_push_moves_the_reference_as_mass_damping_and_spring_say(model, axis):
    """Sampled every millisecond: what is left is the time of a step."""
    found = frequency_response(model, FREQUENCIES)[:, axis, axis]
    assert np.abs(found / admittance(axis) - 1.0).max() < 2.0 * np.pi * FREQUENCIES[-1] * model.step


def test_a_push_along_an_axis_moves_the_reference_along_no_other(model):
    found = frequency_response(model, FREQUENCIES)[:, :3]
    assert np.abs(found[:, ~np.eye(3, dtype=bool)]).max() < 1e-12


def test_a_steady_push_stretches_the_spring_by_force_over_stiffness(model):
    """At rest, the response is C (1 − A)⁻¹ B + D, of the states that a push reaches."""
    still = model.connected()
    gain = still.C @ np.linalg.solve(np.eye(len(still.A)) - still.A, still.B) + still.D
    assert np.diag(gain[:3]) == pytest.approx([1.0 / STIFFNESS, 1.0 / STIFFNESS, 2.0 / STIFFNESS], rel=1e-9)
