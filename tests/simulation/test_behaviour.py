"""What is known of the paper's loop: gates, boundary layers, feedforward, ending."""

import contextlib
import math

import numpy as np
import pytest

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


def test_a_diverging_flight_stops_at_once_and_says_which_quantity_when():
    weak = {"controller.gains.lambda_1": 0.0, "controller.gains.lambda_2": 0.0}
    flight = tl.fly(tl.load_mission("paper", {**weak, "controller.gains.xi": [4, 2, 11, 0.1, 0.1, 0.1]}))
    metrics = flight.metrics()
    assert flight.ending.quantity.startswith("distance")
    assert metrics["steps"] == round(flight.ending.time / 0.001)
    assert flight.time[-1] == pytest.approx(math.floor(flight.ending.time * 100.0) / 100.0, abs=0.011)
    assert math.hypot(*metrics["final_position_m"]) == pytest.approx(flight.ending.value)
    assert np.linalg.norm(flight["position"], axis=1).max() < 1000.0
    assert metrics["final_reference_m"] is None


def test_a_command_that_is_not_finite_stops_the_flight():
    changes = {"controller.gains.lambda_1": 1e308, "controller.gains.xi": 1e200}
    flight = tl.fly(tl.load_mission("paper", changes))
    assert flight.ending.limit == "must be finite"
    assert flight.metrics()["steps"] <= 2
    assert flight.metrics()["final_position_m"] is None
