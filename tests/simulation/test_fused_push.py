"""Joint sensors and motion fused: better than either, and each finds an error of the other."""

from __future__ import annotations

import numpy as np
import pytest
from hands import gusts, steady
from scipy.linalg import solve_continuous_are, solve_discrete_are

import tandemlift as tl
from tandemlift.core.vector import Vec3
from tandemlift.parts.estimation.wrench.fused import fused_filter, turning_gains
from tandemlift.parts.estimation.wrench.kalman import kalman_observer
from tandemlift.parts.estimation.wrench.observation import NominalBody

ONE, T = Vec3(1.0, 1.0, 1.0), 1e-3


def test_gains_of_the_moment_are_those_of_the_kalman_bucy_filter_of_two_measurements():
    q, gyroscope, joints = 0.03, 0.0025, 0.02  # rad/s²/√s, rad/s, rad/s²
    R = np.diag([gyroscope**2, joints**2]) * T
    A = np.array([[0.0, 1.0], [0.0, 0.0]])
    wanted = solve_continuous_are(A.T, np.eye(2), np.diag([0.0, q * q]), R) @ np.linalg.inv(R)
    b, a = np.sqrt(q / (gyroscope * np.sqrt(T))), q / (joints * np.sqrt(T))
    k = turning_gains(ONE * float(b), ONE * float(a), 1e-9)  # of a sample so short that it is a rate
    found = np.array([[k.rates.x, k.rates_by_joints.x], [k.turning.x, k.turning_by_joints.x]]) / 1e-9
    assert found == pytest.approx(wanted, rel=1e-6)


def test_gains_of_the_force_are_those_of_the_riccati_equation_of_two_measurements():
    q, accelerometer, joint = 0.1, 0.03, 0.05
    body = NominalBody(3.5, ONE, ONE)
    alone, _ = kalman_observer(body, ONE * q, ONE, accelerometer, 0.0025, T)
    k, _ = fused_filter(
        alone, (ONE * q, ONE), (0.2, 0.2), (0.0, ONE, ONE), (accelerometer, 0.0025, joint, 0.005), [[0, 1, 0]] * 2, T
    )
    R, C = np.diag([2.0 * joint**2, (3.5 * accelerometer) ** 2]), np.ones((2, 1))
    P = solve_discrete_are(np.eye(1), C.T, np.array([[q * q * T]]), R)
    wanted = (P @ C.T @ np.linalg.inv(C @ P @ C.T + R))[0]
    assert [k.force.x * k.share, k.force.x * (1.0 - k.share)] == pytest.approx(wanted, rel=1e-6)


FAULT = {"sensor": "joints", "kind": "bias", "time": 24.0}
HELD = {"pushes": steady([1.5, -1.0, 0.5], lasts=17.0), "mission.duration": 34.0}
WEAK = [{"quadrotor": 1, "rotor": r, "time": 20.0, "efficiency": 0.95} for r in (1, 2, 3, 4)]
FLIGHTS = {
    **{wrench: {"estimator.wrench": wrench} for wrench in ("joints", "kalman", "fused")},
    "both joints": {**HELD, "sensor_faults": [{**FAULT, "size": [0.5, 0.5, 0.5]}]},
    "one joint": {**HELD, "sensor_faults": [{**FAULT, "size": [0.0, 0.0, 0.6], "quadrotor": 1}]},
    "gust": {"pushes": [], "mission.duration": 34.0, **gusts(([3.0, -2.0, 0.0], 20.0, 0.5, 8.0))},
    "thrust": {"pushes": [], "mission.duration": 34.0, "faults": WEAK},
    "gyroscope": {"pushes": [], "mission.duration": 14.0, "sensors.gyroscope.noise": 0.0},
    "torques": {"pushes": [], "mission.duration": 14.0, "sensors.joints.torque_noise": 0.0},
}


@pytest.fixture(scope="module")
def flights():
    shared = {"estimator.wrench": "fused", "estimator.error_metrics": True, "mission.log_interval": 0.02}
    missions = [tl.load_mission("iris", {**shared, **changes}) for changes in FLIGHTS.values()]
    return dict(zip(FLIGHTS, tl.fly_many(missions), strict=True))


@pytest.mark.thorough
def test_both_are_better_than_either(flights):
    rmse = {w: flights[w].metrics() for w in ("joints", "kalman", "fused")}
    squares = {w: np.square(m["push_force_rmse_n"]).sum() for w, m in rmse.items()}
    assert squares["fused"] < 0.8 * min(squares["joints"], squares["kalman"])
    delays = {w: m["push_delay_s"] for w, m in rmse.items()}
    assert delays["fused"] < 0.6 * min(delays["joints"], delays["kalman"])
    assert rmse["fused"]["push_triggers_after_10s"] == 8


@pytest.mark.thorough
@pytest.mark.parametrize("wrong", ["both joints", "one joint"])
def test_a_joint_bias_under_a_steady_hand_is_found_and_not_followed(wrong, flights):
    flight = flights[wrong]
    assert [str(finding).split()[0] for finding in flight.findings] == ["push-refuted"]
    t, found = flight.time, np.abs(flight["push_withheld"]).sum(axis=1) > 0.0
    assert 0.0 < t[found][0] - FAULT["time"] < 0.5
    off = np.abs(flight["push_estimate"] - flight["push_force"])
    assert off[(t > 25.0) & (t < 31.0)].max() < 0.2
    assert off[(t > 25.0) & (t < 31.0)].mean(axis=0) == pytest.approx(0.0, abs=0.06)


@pytest.mark.parametrize("error", ["gust", "thrust"])
def test_wind_and_weak_rotors_are_no_error_of_the_joints(error, flights):
    flight = flights[error]
    assert not flight["push_withheld"].any()
    assert not any("push-refuted" in str(finding) for finding in flight.findings)
    late = flight.time > 24.0
    if error == "thrust":
        assert np.abs(flight["push_estimate"][late].mean(axis=0)).max() < 0.1  # N; the rotors lost 0.86


BRIEF = {
    **{"mission.duration": 8.0, "mission.log_interval": 0.01, "phases.lift_start": 0.5, "phases.lift_duration": 2.0},
    **{"phases.land_start": None, "estimator.tare_start": 3.0, "estimator.tare_duration": 1.5},
    "pushes": [{"force": [3.0, 2.0, 1.5], "time": 6.2, "sigma": 0.4}],
}


@pytest.mark.parametrize(("wrench", "joints"), [("fused", "simulated"), ("kalman", "none")])
def test_the_push_on_the_body_of_mujoco_is_found_as_on_ours(wrench, joints):
    """The truth is the wrench that MuJoCo applies; thrusts, motion and joints are those of its bodies."""
    pytest.importorskip("mujoco")
    changes = {"estimator.wrench": wrench, "sensors.joints.model": joints}
    mission, errors = tl.load_mission("iris", BRIEF | changes), []
    for engine in ("compiled", "mujoco"):
        flight = tl.fly(mission, engine)
        hovers = flight.time > 4.6
        assert np.abs(flight["push_force"][hovers]).max() > 2.9
        errors.append(np.sqrt(np.mean((flight["push_estimate"] - flight["push_force"])[hovers] ** 2, axis=0)))
    assert np.max(errors) < 0.1  # N
    assert errors[1] == pytest.approx(errors[0], abs=0.003)


@pytest.mark.parametrize("noiseless", ["gyroscope", "torques"])
def test_a_sensor_without_noise_leaves_the_moment_of_no_push_at_zero(noiseless, flights):
    """The filter would be as fast as it likes, but samples limit it."""
    flight = flights[noiseless]
    assert np.abs(flight["push_moment_estimate"][flight.time > 12.5]).max() < 0.15
    assert flight.findings == ()
