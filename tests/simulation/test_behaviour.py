"""What is known of the paper's loop: gates, boundary layers, feedforward, ending; and closed forms of where it ends."""

import contextlib
import math

import numpy as np
import pytest
from scipy.optimize import brentq

import tandemlift as tl

LOW = [0.0, 0.0, -0.0642857142857]  # m: the payload's centre


def late(mission, changes=None):
    return tl.fly(tl.load_mission(mission, changes)).metrics()


def test_a_hard_gate_makes_roll_spikes_that_a_soft_one_does_not():
    moment_with_hard_gate = late("paper")["moment_max_abs_after_10s_n_m"][0]
    moment_with_soft_gate = late("paper", {"admittance.gate": "soft"})["moment_max_abs_after_10s_n_m"][0]
    assert moment_with_hard_gate == pytest.approx(200.0, rel=0.02)
    assert moment_with_soft_gate == pytest.approx(7.3, rel=0.02)


@pytest.mark.parametrize(("width", "chatters"), [(0.06, False), (0.05, True)])
def test_one_kilohertz_bears_a_boundary_layer_of_006_and_chatters_at_005(width, chatters):
    changes = {"controller.boundary_layer": width}
    warned = pytest.warns(tl.FlightWarning, match=r"lambda_1 \+ lambda_2/boundary_layer")
    with warned if chatters else contextlib.nullcontext():
        mission = tl.load_mission("paper", changes)
    flight = tl.fly(mission)
    assert (flight.metrics()["moment_max_abs_after_10s_n_m"][0] > 1000.0) == chatters


@pytest.mark.parametrize(("feedforward", "x", "y"), [(False, 49.0, 60.0), (True, 25.0, 8.0)])
def test_feeding_the_push_forward_shrinks_the_error_of_the_flight_ready_set(feedforward, x, y):
    changes = {f"pushes.{i}.point": LOW for i in range(8)}
    changes["controller.human_force_feedforward"] = feedforward
    rmse = late("flight-ready", changes)["position_rmse_after_10s_m"]
    np.testing.assert_allclose(np.array(rmse[:2]) * 1e3, [x, y], atol=0.6)


def test_weights_move_the_thrusts_between_rotors_and_leave_the_motion():
    base = tl.fly(tl.load_mission("paper"))
    weighted = tl.fly(tl.load_mission("paper", {"allocation.weights": [1.0, 100.0, 1.0, 1.0]}))
    assert np.abs(base["rotor_thrusts"] - weighted["rotor_thrusts"]).max() > 1.0
    np.testing.assert_allclose(weighted["position"], base["position"], atol=1e-9)


def test_a_motion_that_dies_does_not_linger_in_denormal_numbers():
    flight = tl.fly(tl.load_mission("one-push", {"mission.duration": 600.0, "mission.log_interval": 10.0}))
    speed = flight["admittance_velocity"][:, 0]
    assert speed[1] > 0.0
    assert speed[-1] < 1e-100
    assert np.all((speed == 0.0) | (np.abs(speed) > 1e-300))


def test_a_command_that_is_not_finite_stops_the_flight():
    changes = {"controller.gains.lambda_1": 1e308, "controller.gains.xi": 1e200}
    flight = tl.fly(tl.load_mission("paper", changes))
    assert flight.ending.limit == "must be finite"
    assert flight.metrics()["steps"] <= 2
    assert flight.metrics()["final_position_m"] is None


STEP, C = 0.001, 1.6


def displacement(A, sigma, threshold=0.0, gate="hard"):
    """Of T_r by one push with K = 0: the gated impulse over C [m]."""
    if abs(A) <= threshold:
        return 0.0
    d = sigma * math.sqrt(2.0 * math.log(abs(A) / threshold)) if threshold else math.inf
    whole = A * sigma * math.sqrt(2.0 * math.pi) * math.erf(d / (sigma * math.sqrt(2.0)))
    taken = math.copysign(2.0 * d * threshold, A) if gate == "soft" and threshold else 0.0
    return (whole - taken) / C


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
