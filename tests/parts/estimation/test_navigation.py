"""The state estimate against trajectories in closed form: exactness, convergence, noise, bias, delay."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from law_values import array
from perceived import STEP, happening, onboard, perceived, rows, sensors
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import Vec3, vec3
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.navigation import Navigator, navigator_from
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotated_by
from tandemlift.parts.sensors.noise_bias_drift import SensorGrade
from tandemlift.parts.sensors.readings import Sensors
from tandemlift.parts.sensors.sensors_table import SensorsTable

CENTRE = np.array([0.02, -0.03, 0.0642857])
LEVEL = np.array([0.0, 0.0, 9.81])
RAW = {"position_noise": 0.003, "velocity_noise": 0.01, "attitude_noise": 0.002}


def navigator(imu_period: int = 1, motion_period: int = 1, **bandwidths: float) -> Navigator:
    """The observer with sensors that are sampled every so many steps."""
    clocks = SensorsTable(interval=imu_period * STEP, motion={"interval": motion_period * STEP})
    return navigator_from(EstimatorTable(**bandwidths), clocks, CENTRE, STEP)


def smoothed(k: Navigator, bandwidth: float) -> Navigator:
    """The observer with rates behind a low-pass of a bandwidth [rad/s]."""
    return k._replace(rates=1.0 - np.exp(-bandwidth * STEP))


def truth_of(R: Rotation, rates: Any, position: Any, velocity: Any, acceleration: Any) -> np.ndarray:
    """Numbers of (State, Felt) at every step, from the motion of the unit's point."""
    n = len(position)
    centre = position + R.apply(CENTRE), velocity + R.apply(np.cross(rates, CENTRE))
    specific = R.inv().apply(acceleration + LEVEL)
    return np.hstack([*centre, R.as_quat(scalar_first=True), rates, specific, np.zeros((n, 15))])


def times(duration: float) -> np.ndarray:
    return STEP * np.arange(round(duration / STEP))


def steady(duration: float, rates: Any, acceleration: Any, jerk: Any = (0.0, 0.0, 0.0)) -> np.ndarray:
    """Constant rates, and in world axes an acceleration that grows with the time."""
    t = times(duration)[:, None]
    R = Rotation.from_rotvec([0.3, -0.2, 1.0]) * Rotation.from_rotvec(t * np.array(rates))
    v, a, j = np.array([0.5, 0.0, -0.5]), np.array(acceleration), np.array(jerk)
    position = np.array([1.0, 2.0, 3.0]) + v * t + a * t**2 / 2.0 + j * t**3 / 6.0
    return truth_of(R, np.tile(rates, (len(t), 1)), position, v + a * t + j * t**2 / 2.0, a + j * t)


def swaying(duration: float) -> np.ndarray:
    """Sines in all axes, the rates by differences of the attitude (to 1e-11)."""
    t, h = times(duration), 1e-3

    def attitude(t: np.ndarray) -> Rotation:
        angles = np.stack([0.5 * np.sin(0.7 * t), 0.15 * np.sin(1.9 * t + 1.0), 0.2 * np.sin(2.3 * t)], axis=-1)
        return Rotation.from_euler("ZXY", angles)

    def over(h: float) -> np.ndarray:
        return (attitude(t - h).inv() * attitude(t + h)).as_rotvec() / (2.0 * h)

    rates = attitude(t).inv().apply(attitude(t).apply((4.0 * over(h) - over(2.0 * h)) / 3.0))
    size, pace, phase = np.array([1.0, 0.7, 0.3]), np.array([0.9, 1.1, 1.7]), np.array([0.0, 1.0, 2.0])
    turn = pace * t[:, None] + phase
    motion = size * np.sin(turn), size * pace * np.cos(turn), -size * pace**2 * np.sin(turn)
    return truth_of(attitude(t), rates, *motion)


def estimated(truth: np.ndarray, k: Navigator, devices: Sensors, off: Any = None, seed: int = 1) -> Any:
    """What is seen on a flight; the observer begins at the truth, or at what `off` makes of it."""
    first = happening(truth[0])
    believed = first.state if off is None else off(first.state)
    return perceived(onboard(first, devices, observer=k, believed=believed), truth, seed)


def errors(seen: Any, truth: np.ndarray) -> dict[str, np.ndarray]:
    """Estimate less truth: position, velocity, turn (body axes) and rates (steps × 3 each)."""
    s = seen.state
    found, true = (Rotation.from_quat(q, scalar_first=True) for q in (rows(s.attitude), truth[:, 6:10]))
    return {
        "position": rows(s.position) - truth[:, :3],
        "velocity": rows(s.velocity) - truth[:, 3:6],
        "turn": (true.inv() * found).as_rotvec(),
        "rates": rows(s.rates) - truth[:, 10:13],
    }


@pytest.mark.parametrize(("imu_period", "motion_period"), [(1, 1), (1, 10), (4, 8)])
def test_constant_rates_and_an_acceleration_that_grows_evenly_are_carried_exactly(imu_period, motion_period):
    periods = {"imu_period": imu_period, "motion_period": motion_period}
    truth = steady(3.0, (0.3, -0.4, 1.2), (1.0, -2.0, 0.5), (0.5, 0.2, -0.4))
    off = errors(estimated(truth, navigator(**periods), sensors(2, STEP, **periods)), truth)
    assert max(np.abs(e[::imu_period]).max() for e in off.values()) < 1e-11


def test_an_error_at_the_start_dies_as_two_equal_poles_and_one_say():
    """ë + 2ω ė + ω² e = 0 from ė = −2ω e: e = e₀ (1 − ω t) exp(−ω t); position alone exp(−ω t)."""
    truth, t = steady(4.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), times(4.0)
    k = navigator(position_bandwidth=2.0, attitude_bandwidth=1.5)
    wrong = estimated(truth, k, sensors(2, STEP), lambda s: s._replace(velocity=s.velocity + Vec3(0.1, 0.0, 0.0)))
    assert errors(wrong, truth)["velocity"][:, 0] == pytest.approx(0.1 * (1 - 2.0 * t) * np.exp(-2.0 * t), abs=5e-4)
    wrong = estimated(truth, k, sensors(2, STEP), lambda s: s._replace(position=s.position + Vec3(0.0, 0.1, 0.0)))
    assert errors(wrong, truth)["position"][:, 1] == pytest.approx(0.1 * np.exp(-2.0 * t), abs=5e-4)
    turn = Vec3(0.0, 0.0, 0.1)
    wrong = estimated(truth, k, sensors(2, STEP), lambda s: s._replace(attitude=rotated_by(s.attitude, turn)))
    assert errors(wrong, truth)["turn"][:, 2] == pytest.approx(0.1 * (1 - 1.5 * t) * np.exp(-1.5 * t), abs=5e-4)


def test_a_constant_bias_is_learnt_and_leaves_no_error():
    """From rest at e = 0 with ė = b: e = b t exp(−ω t)."""
    truth, t = steady(8.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), times(8.0)
    k = navigator(motion_period=2, position_bandwidth=3.0, attitude_bandwidth=2.0)
    devices = sensors(2, STEP, accelerometer=SensorGrade(bias=(0.0, 0.0, 0.05)), motion_period=2)
    seen = estimated(truth, k, devices)
    R = Rotation.from_quat(truth[0, 6:10], scalar_first=True)
    found = R.inv().apply(errors(seen, truth)["velocity"])
    assert found[:, 2] == pytest.approx(0.05 * t * np.exp(-3.0 * t), abs=2e-4)
    assert rows(seen.navigation.accelerometer_bias)[-1] == pytest.approx([0.0, 0.0, 0.05], abs=1e-6)
    bias = (0.02, -0.01, 0.015)
    seen = estimated(truth, k, sensors(2, STEP, gyroscope=SensorGrade(bias=bias), motion_period=2))
    off = errors(seen, truth)
    assert off["turn"] == pytest.approx(np.array(bias) * (t * np.exp(-2.0 * t))[:, None], abs=1e-4)
    assert rows(seen.navigation.gyroscope_bias)[-1] == pytest.approx(np.array(bias), abs=1e-5)
    assert max(np.abs(e[-1]).max() for e in off.values()) < 1e-4


def test_it_finds_its_way_from_far_off():
    """Half a radian, a metre and a metre per second wrong, with biased and noisy sensors."""
    truth = swaying(20.0)
    devices = sensors(2, STEP, gyroscope=SensorGrade(noise=0.003, bias=(0.02, 0.0, -0.02)), motion_period=10, **RAW)

    def lost(s: State) -> State:
        return State(s.position + vec3([1.0, -1.0, 1.0]), s.velocity - vec3([1.0, 1.0, 1.0]),
                     rotated_by(s.attitude, vec3([0.5, -0.5, 0.5])), s.rates)  # fmt: skip

    seen = estimated(truth, navigator(motion_period=10), devices, lost)
    off = errors(seen, truth)
    assert np.abs(off["position"][12000:]).max() < 0.004
    assert np.abs(off["velocity"][12000:]).max() < 0.02
    assert np.abs(off["turn"][12000:]).max() < 0.004
    assert np.sum(rows(seen.state.attitude) ** 2, axis=1) == pytest.approx(1.0, abs=1e-14)


def test_a_motion_measurement_that_is_late_is_compared_with_the_state_of_then():
    late = 20
    now = steady(6.0, (0.0, 0.0, 0.5), (0.0, 0.0, 0.0))
    truth = now[late:].copy()
    truth[:, :10] = now[:-late, :10]  # what motion sees is of 20 ms ago
    now, devices, imu = now[late:], sensors(2, STEP), 0.005
    clocks = SensorsTable(interval=STEP, delay=imu, motion={"interval": STEP, "delay": imu + late * STEP})
    known = errors(estimated(truth, navigator_from(EstimatorTable(), clocks, CENTRE, STEP), devices), now)
    unknown = errors(estimated(truth, navigator(), devices), now)
    assert np.abs(known["position"][-1]).max() < 1e-4
    assert np.abs(known["velocity"][-1]).max() < 2e-4
    assert np.abs(known["turn"][-1]).max() < 1e-6
    assert np.abs(unknown["turn"][-1]).max() == pytest.approx(0.5 * late * STEP, rel=0.01)
    assert array(unknown["position"][-1]) == pytest.approx(-late * STEP * now[-1, 3:6], abs=0.001)


def test_smoothed_rates_follow_one_time_constant_late():
    t = times(2.0)[:, None]
    turn = np.hstack([np.zeros_like(t), np.zeros_like(t), 0.5 * t**2])
    still = np.zeros((len(t), 3))
    truth = truth_of(Rotation.from_rotvec(turn), np.hstack([0.0 * t, 0.0 * t, t]), still, still, still)
    k = smoothed(navigator(), 100.0)
    off = errors(estimated(truth, k, sensors(2, STEP)), truth)
    assert off["rates"][-1, 2] == pytest.approx(-0.01, abs=STEP)
