"""The figure of a linear model: its curves are those of a chain of integrators, which has a closed form."""

import numpy as np
import pytest

from tandemlift.analysis.linearization.linear_model import LinearizationPoint, LinearModel
from tandemlift.analysis.linearization.state_variables import Variable
from tandemlift.pictures.drawing.linear_model_figure import draw, response_of

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


def test_like_axes_are_paired_named_by_their_last_words_and_the_rest_is_counted():
    chain = np.eye(CHAIN)
    inputs, outputs = ["push_moment_x", "push_moment_y", "wind_z"], ["position_z", "euler_pitch", "euler_roll"]
    model = integrators(inputs, outputs, STEP * chain[-1][:, None] * [2.0, 3.0, 5.0], chain[:3])
    response = response_of(model, "push_moment", "euler")
    assert response.title == "push moment → euler: 2 of 4 responses"
    assert response.unit == "(m/s)/(N m)"
    assert list(response.curves) == ["x → roll", "y → pitch"]
    slope = (
        np.abs(response.curves["y → pitch"] / response.curves["x → roll"])
        * 2.0
        * np.sin(np.pi * response.frequencies * STEP)
    )
    assert slope == pytest.approx(np.full(len(slope), 1.5 * STEP), rel=1e-6)
    figure = draw("chain", [0.0], response)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["x → roll", "y → pitch"]
    assert not any(legend.get_window_extent().overlaps(axes.bbox) for axes in figure.axes)


def test_without_like_axes_the_first_inputs_are_drawn_as_far_as_they_move_an_output():
    ends = STEP * np.eye(CHAIN)[-1][:, None] * [1e-17, 1.0, 1.0]
    inputs = [f"rotor_thrusts_rotor_{i}" for i in (1, 2, 3)]
    response = response_of(integrators(inputs, ["position_x"], ends, np.eye(CHAIN)[:1]), "rotor_thrusts", "position")
    assert list(response.curves) == ["rotor 2 → x", "rotor 3 → x"], "the first moves it by rounding alone"
    assert response.title == "rotor thrusts → position: 2 of 3 responses"
