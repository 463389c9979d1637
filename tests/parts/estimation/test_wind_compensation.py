"""The wind on the beam is told from that on the quadrotors: parts solved by Newton and Euler in plain NumPy."""

from typing import Any

import numpy as np
import pytest
from law_values import array
from newton_euler import Given, paper_parts, solved, unit, vehicle_of
from scipy.spatial.transform import Rotation

from tandemlift.missions import load_mission
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.push_estimate import estimate, push_estimator, start_push
from tandemlift.parts.estimation.wind_compensation import (
    payload_drag_from,
)
from tandemlift.parts.mechanics.vehicle import Vehicle

VEHICLE = Vehicle.from_settings(load_mission("iris").vehicle)
DENSITY, STEP = 1.225, 1e-3
BEAM = 0.5 * DENSITY * 1.1 * np.array([0.2, np.pi * 0.05**2, 0.2])  # N/(m/s)²: side, end, top of the cylinder
QUADROTOR = 0.5 * DENSITY * np.array([0.02, 0.02, 0.05])


def drags(R: Rotation, air: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force [N, body axes] on beam and on each quadrotor at rest in air of a velocity [m/s, world axes]."""
    v = R.inv().apply(air)
    speed = np.linalg.norm(v)
    return BEAM * v * speed, QUADROTOR * v * speed


def read(R: Rotation, air: np.ndarray, hand: np.ndarray) -> Any:
    """What the unit says of a vehicle that is held against turning, in a wind, under a hand [N, world axes]."""
    p = paper_parts()
    beam, quadrotor = drags(R, air)
    weight = 9.81 * (p.mass + p.masses.sum())
    push, winds = hand + R.apply(beam), np.tile(R.apply(quadrotor), (2, 1))

    def turning(torque: np.ndarray) -> Any:
        x = Given(np.full(2, weight / 2), np.tile(torque / 2, (2, 1)), push, np.zeros(3), winds)
        return solved(p, R, np.zeros(3), x)

    free = turning(np.zeros(3)).angular
    per_torque = np.array([turning(axis).angular - free for axis in np.eye(3)]).T
    return unit(R, np.zeros(3), turning(-np.linalg.solve(per_torque, free)))


def estimator(**options: Any):
    p, k = paper_parts(), payload_drag_from(VEHICLE, 200.0, STEP)
    return push_estimator(EstimatorTable(**options), vehicle_of(p), STEP)._replace(windage=k)


def settled(k, memory, said, t):
    """The push after a while of the same sample."""
    for i in range(150):
        push, memory = estimate(k, memory, said, t + i * STEP)
    return push, memory


@pytest.mark.parametrize("seed", range(3))
def test_in_any_wind_and_attitude_the_push_is_the_hands_but_for_what_blows_along_body_z(seed):
    rng = np.random.default_rng(seed)
    R, air, hand = Rotation.random(rng=rng), 3.0 * rng.standard_normal(3), rng.standard_normal(3)
    said, k = read(R, air, hand), estimator()
    push, _ = settled(k, start_push(k, said), said, 0.0)
    along = R.apply([0.0, 0.0, drags(R, air)[0][2]])
    assert array(push.measured) == pytest.approx(hand + along, abs=1e-7)


def test_the_wind_of_the_tare_is_in_the_bias_and_is_not_taken_off_twice():
    R, none, hand = Rotation.identity(), np.zeros(3), np.array([0.4, 0.0, 0.0])
    calm, strong = np.array([2.0, 1.0, 0.0]), np.array([4.0, 3.0, 0.0])
    k = estimator(tare_start=0.0, tare_duration=0.1)
    said = read(R, calm, none)
    memory = start_push(k, said)
    for i in range(100):
        _, memory = estimate(k, memory, said, i * STEP)
    push, memory = settled(k, memory, said, 0.1)
    assert array(push.measured) == pytest.approx(none, abs=1e-7)
    push, _ = settled(k, memory, read(R, strong, hand), 1.0)
    assert array(push.measured) == pytest.approx(hand, abs=1e-7)


def test_a_blow_on_a_guard_takes_off_no_more_than_a_wind_of_8_m_s_and_in_a_contact_nothing():
    R, none = Rotation.identity(), np.zeros(3)
    k, calm, blown = estimator(), read(R, none, none), read(R, np.array([30.0, 0.0, 0.0]), none)
    push, memory = settled(k, start_push(k, calm), blown, 0.0)
    assert array(push.measured) == pytest.approx([BEAM[0] * (30.0**2 - 8.0**2), 0.0, 0.0], abs=1e-7)
    push, _ = estimate(k, memory, blown, 0.2, 0.0)
    assert array(push.measured) == pytest.approx([BEAM[0] * 30.0**2, 0.0, 0.0], abs=1e-7)


def test_quadrotors_without_drag_along_z_show_the_wind_along_x_and_y():
    flat = {f"vehicle.quadrotors.{i}.drag_area": [0.02, 0.02, 0.0] for i in range(2)}
    vehicle = Vehicle.from_settings(load_mission("iris", flat).vehicle)
    assert payload_drag_from(vehicle, 200.0, STEP) == payload_drag_from(VEHICLE, 200.0, STEP)
