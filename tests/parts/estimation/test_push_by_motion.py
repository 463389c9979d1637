"""A push on a vehicle that hovers, as an observer finds it from motion and thrusts: by Newton, step by step."""

import numpy as np
import pytest
from law_values import array

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Quat, Vec3, each, vec3
from tandemlift.missions import load_mission
from tandemlift.parts.estimation.navigation import navigator_from, start_navigation
from tandemlift.parts.estimation.wrench_push import PushInputs, push_and_state, start_wrench_push
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.readings import ImuReading, MotionReading, Readings

STEP, YAW, BEGIN = 1e-3, 0.7, 0.9  # s, rad, s
PUSH = np.array([1.5, -0.8, 0.4])  # N, world axes


def test_a_steady_push_on_a_hover_is_found_in_world_axes_and_nothing_before_the_tare():
    changes = {"estimator.wrench": "kalman", "estimator.tare": "at-time", "estimator.tare_start": 0.5}
    mission = load_mission("iris", {**changes, "estimator.tare_duration": 0.3, "estimator.identify_mass": False})
    vehicle = Vehicle.from_settings(mission.vehicle)
    q = Quat(np.cos(YAW / 2), 0.0, 0.0, np.sin(YAW / 2))
    R, arm = array(rotation_from_quaternion(q)).reshape(3, 3), np.array(vehicle.center_of_mass)
    k, memory = start_wrench_push(mission.estimator, mission.sensors, vehicle, STEP, 0.0, None)
    navigator = navigator_from(mission.estimator, mission.sensors, arm, STEP)
    navigation = start_navigation(navigator, State(ZERO, ZERO, q, ZERO))
    rotors = each(vehicle.rotor_count)
    thrusts = rotors(*(vehicle.allocation(mission.allocation.weights) @ [vehicle.weight, 0.0, 0.0, 0.0]))
    early = None
    for i in range(2400):
        t = i * STEP
        force = PUSH if t > BEGIN else 0.0 * PUSH
        since = max(t - BEGIN, 0.0)
        a = force / vehicle.mass
        place, velocity = 0.5 * a * since**2 - R @ arm, a * since
        felt = vec3(R.T @ np.add(a, (0.0, 0.0, GRAVITY)))
        imu = ImuReading(felt, ZERO, ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), 1.0)
        motion = MotionReading(vec3(place), vec3(velocity), q, 1.0)
        x = PushInputs(Readings(imu, motion), thrusts, 1.0, t, STEP)
        push, memory, state, navigation = push_and_state(k, memory, navigator, navigation, x)
        early = array(push.force) if t < 0.5 else early
    assert not early.any()
    assert (push.armed, push.trusted) == (1.0, 1.0)
    assert array(push.force) == pytest.approx(PUSH, rel=0.05)
    assert array(push.measured) == pytest.approx(PUSH, rel=0.05)
    assert push.payload_mass == pytest.approx(mission.vehicle.payload.mass)
    assert array(state.velocity) == pytest.approx(PUSH / vehicle.mass * (2.4 - BEGIN), rel=0.05)
    assert isinstance(push.moment, Vec3)
