"""The figure of a linear model: its curves are those of a chain of integrators, which has a closed form."""

import numpy as np
import pytest

from tandemlift.analysis.linearization.linear_model import LinearizationPoint, LinearModel
from tandemlift.flight.state_variables import Variable
from tandemlift.pictures.report.study.linear_model_figure import draw, response_of

STEP, CHAIN = 1e-3, 4
NONE = np.zeros(0)


def integrators(inputs, outputs, B, C):
    """A chain of integrators, each one step late, with those inputs and outputs of unit N m and m/s."""
    A = np.eye(CHAIN) + STEP * np.eye(CHAIN, k=1)
    named = [tuple(Variable(name, unit) for name in names) for names, unit in ((inputs, "N m"), (outputs, "m/s"))]
    point = LinearizationPoint(NONE, NONE, NONE, NONE)
    D = np.zeros((len(outputs), len(inputs)))
    return LinearModel(A, np.array(B), np.array(C), D, (), *named, STEP, 0.0, point, (), (), {}, "chain", "body")


def curves(figure):
    """The drawn curves of size and of phase."""
    return [[line.get_ydata() for line in axes.get_lines()] for axes in figure.axes[1:]]


def test_size_and_phase_are_right_over_the_whole_band():
    # the response falls by 17 decades over the band
    ends, first = np.eye(CHAIN)[[-1]].T * STEP, np.eye(CHAIN)[0]
    model = integrators(["push_y"], ["position_y"], ends, [first])
    response = response_of(model, "push", "position")
    angle = np.pi * response.frequencies * STEP
    sizes, phases = curves(draw("chain", [0.0], response))
    assert sizes[0] == pytest.approx((STEP / (2.0 * np.sin(angle))) ** CHAIN, rel=1e-6)
    turns = phases[0] + np.degrees(CHAIN * (0.5 * np.pi + angle))
    assert turns == pytest.approx(np.full(len(turns), 360.0 * np.round(turns[0] / 360.0)), abs=1e-4)
