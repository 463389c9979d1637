"""Flights against closed forms: displacement by pushes, and the offset that a constant disturbance leaves."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import tandemlift as tl

STEP, C = 0.001, 1.6


def displacement(A, sigma, threshold=0.0, gate="hard"):
    """Of T_r by one push with K = 0: the gated impulse over C [m]."""
    if abs(A) <= threshold:
        return 0.0
    d = sigma * math.sqrt(2.0 * math.log(abs(A) / threshold)) if threshold else math.inf
    whole = A * sigma * math.sqrt(2.0 * math.pi) * math.erf(d / (sigma * math.sqrt(2.0)))
    taken = math.copysign(2.0 * d * threshold, A) if gate == "soft" and threshold else 0.0
    return (whole - taken) / C


def one_push(axis, A, sigma, **changes):
    force = [0.0, 0.0, 0.0]
    force[axis] = A
    pushes = [{"force": force, "time": 9.0 * sigma + 1.0, "sigma": sigma}]
    return tl.load_mission(
        "one-push", {"pushes": pushes, "mission.duration": 40.0, "mission.log_interval": 1.0, **changes}
    )


PUSHES = [(0, 3.0, 0.6), (1, -2.0, 0.8), (2, 1.5, 0.5), (0, 0.31, 0.3), (1, 5.0, 0.2)]


@pytest.mark.parametrize(
    ("gate", "threshold", "tolerance"), [("hard", 0.0, 1e-9), ("soft", 0.3, 1e-6), ("hard", 0.3, 0.3 * STEP / C)]
)
def test_each_push_displaces_the_reference_by_its_gated_impulse_over_the_damping(gate, threshold, tolerance):
    changes = {"admittance.gate": gate, "admittance.threshold": threshold}
    flights = tl.fly_many([one_push(*push, **changes) for push in PUSHES])
    for (axis, A, sigma), flight in zip(PUSHES, flights, strict=True):
        moved = flight["admittance_position"][-1]
        expected = np.zeros(3)
        expected[axis] = displacement(A, sigma, threshold, gate)
        np.testing.assert_allclose(moved, expected, rtol=0, atol=tolerance)


@pytest.mark.parametrize(
    ("mission", "gate", "tolerance"), [("paper", "hard", 8 * 0.3 * STEP / C), ("flight-ready", "soft", 8e-6)]
)
def test_the_whole_mission_ends_at_the_sum_of_its_pushes(mission, gate, tolerance):
    flight = tl.fly(tl.load_mission(mission))
    expected = np.zeros(3)
    for push in flight.mission["pushes"]:
        for axis, A in enumerate(push["force"]):
            expected[axis] += displacement(A, push["sigma"], 0.3, gate)
    np.testing.assert_allclose(flight["admittance_position"][-1], expected, rtol=0, atol=tolerance)
    np.testing.assert_allclose(flight.metrics()["final_position_m"][:2], expected[:2], rtol=0, atol=1e-3)


def test_a_push_below_the_threshold_moves_nothing():
    flight = tl.fly(one_push(0, 0.29, 0.5))
    assert np.all(flight["admittance_position"] == 0.0)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_constant_force_leaves_the_offset_at_which_the_surface_carries_it(axis):
    force = [0.0, 0.0, 0.0]
    force[axis] = 3.0
    mission = tl.load_mission("hover", {"disturbance.force": force, "mission.duration": 60.0})
    gains = mission.controller.gains

    def unbalanced(e):
        S = gains.xi[axis] * e + gains.eta[axis] * abs(e) ** gains.a[axis] * np.sign(e)
        held = gains.lambda_1[axis] * S + gains.lambda_2[axis] * math.tanh(S / mission.controller.boundary_layer[axis])
        return 3.5 * held + 3.0

    error = tl.fly(mission)["position_error"][-1]
    assert error[axis] == pytest.approx(brentq(unbalanced, -2.0, 0.0, xtol=1e-14), abs=1e-6)
    if axis < 2:
        assert abs(error[axis]) == pytest.approx(0.40, abs=0.01)
