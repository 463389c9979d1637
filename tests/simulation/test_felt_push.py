"""The person's push as the joints feel it, through a whole flight; and what joints transmit."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.vehicle import Vehicle

PERFECT = {
    "mission.duration": 6.0,
    "mission.log_interval": 0.001,
    "sensors.model": "simulated",
    "vehicle.drag": {"force": 0.0, "moment": 0.0},
    "phases": {"lift_start": 0.0, "lift_duration": 2.0, "height": 1.0, "land_start": 30.0, "land_duration": 1.0},
    "pushes": [{"force": [3.0, -1.0, 1.0], "time": 3.0, "sigma": 0.4, "point": [0.0, 0.6, -0.0642857142857143]}],
}
NOISY = {
    "sensors.joints.force_noise": 0.05,
    "sensors.accelerometer.noise": 0.03,
    "sensors.joints.torque_noise": 0.005,
    "sensors.gyroscope.noise": 0.0025,
}


@pytest.fixture(scope="module")
def perfect():
    return tl.fly(tl.load_mission("flight-ready", PERFECT))


def test_perfect_sensors_feel_the_push_exactly_whatever_the_motion(perfect):
    felt, true = perfect["push_measured"][2:], perfect["push_force"][1:-1]  # known one step after it was felt
    assert np.abs(perfect["rates"]).max() > 0.1
    assert np.abs(true).max() > 2.9
    assert np.abs(felt - true).max() < 1e-9


def test_noise_of_the_sensors_shows_in_the_push_as_predicted():
    flight = tl.fly(tl.load_mission("flight-ready", {**PERFECT, **NOISY}))
    errors = flight["push_measured"][2:] - flight["push_force"][1:-1]
    predicted = np.sqrt(2.0 * 0.05**2 + (0.5 * 0.03) ** 2)
    assert errors.std(axis=0) == pytest.approx([predicted] * 3, rel=0.05)
    assert np.abs(errors.mean(axis=0)).max() < 5.0 * predicted / np.sqrt(len(errors))


def test_the_place_of_a_push_is_found_within_two_centimetres():
    long = [{"force": [3.2, 0.0, 0.0], "time": 4.0, "sigma": 1.5, "point": [0.0, 0.35, -0.0642857142857143]}]
    flight = tl.fly(tl.load_mission("flight-ready", {**PERFECT, **NOISY, "pushes": long}))
    strong = (flight["push_force"][:, 0] >= 3.0) & (flight.time > 1.0)
    assert strong.sum() > 500
    assert np.abs(flight["push_point_estimate"][strong] - 0.35).max() < 0.02


def test_what_the_joints_transmit_moves_the_payload_as_newton_says(perfect):
    mission = tl.load_mission("flight-ready", PERFECT)
    vehicle = Vehicle.from_settings(mission.vehicle)
    force = perfect["joint_force"].reshape(len(perfect.time), vehicle.count, 3).sum(axis=1)
    w, x, y, z = perfect["attitude"].T
    R = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)
    payload = perfect["position"] - R @ vehicle.center_of_mass
    acceleration = (payload[2:] - 2.0 * payload[1:-1] + payload[:-2]) / 1e-6
    held = (R @ force[:, :, None])[:, :, 0]
    total = (held + perfect["push_force"])[1:-1] - [0.0, 0.0, 0.5 * 9.81]
    late = slice(1000, None)  # the start is disturbed, and thrusts jump from step to step
    assert np.abs(total - 0.5 * acceleration)[late].max() < 2e-2
    assert np.abs((total - 0.5 * acceleration)[late].mean(axis=0)).max() < 1e-4


def test_in_hover_each_joint_carries_half_of_the_payload():
    hover = tl.fly(tl.load_mission("hover", {"mission.duration": 6.0}))
    assert hover["joint_force"][-1] == pytest.approx([0.0, 0.0, 2.4525, 0.0, 0.0, 2.4525], abs=1e-3)
