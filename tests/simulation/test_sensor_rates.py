"""Flights whose sensors have rates of their own: estimates by an independent recursion; blocks, C and engines alike."""

import json

import numpy as np
import pytest
from c_flights import CFlight, differences, unfused
from scipy.signal import cont2discrete
from scipy.spatial.transform import Rotation
from wasm_flights import wasm_flights

import tandemlift as tl
from tandemlift.codegen.mission_module import compile_mission
from tandemlift.core.types import GRAVITY
from tandemlift.missions import changed

RATES = {"sensors.interval": 0.004, "sensors.motion.interval": 0.008, "sensors.noise_interval": 0.001}
STAGGERED = {
    **RATES,
    "sensors.first_sample": 0.001,
    "sensors.joints.interval": 0.002,
    "sensors.joints.first_sample": 0.001,
    "sensors.motion.first_sample": 0.006,
    "sensors.additional": [{"name": "altimeter", "interval": 0.01, "first_sample": 0.003, "noise": 0.1}],
}
LATE = {**STAGGERED, "sensors.delay": 0.003, "sensors.motion.delay": 0.01}
REAL = {"sensors.model": "simulated", "pilot.state": "estimate", "pilot.push": "estimate"}
CASES = {"zigzag, staggered": ("zigzag", STAGGERED), "iris, late": ("iris", LATE)}


def mission(name, duration=1.5, **keys):
    return tl.load_mission(name, {"mission.duration": duration, **keys})


@pytest.mark.thorough
@pytest.mark.parametrize("case", CASES)
def test_lanes_that_are_due_at_different_steps_equal_flights_alone_to_the_last_bit(case):
    name, keys = CASES[case]
    lanes, rng = 11, np.random.default_rng(2)
    block = tl.Block(mission(name, 3.0, **keys), lanes)
    sims = [tl.Simulation(mission(name, 3.0, **keys, **{"mission.seed": seed})) for seed in range(lanes)]
    for _ in range(25):
        steps, push = int(rng.integers(1, 180)), rng.uniform(-6.0, 6.0, (lanes, 3))
        if not block.ended.all():
            block.step(push, steps=steps)
        for lane, sim in enumerate(sims):
            if not sim.over:
                sim.step(steps=steps, push=push[lane])
        np.testing.assert_array_equal(block.time, [s.time for s in sims])
        stepped = [i for i, s in enumerate(sims) if s.k]
        for channel in block.channels:
            theirs = [sims[i][channel] for i in stepped]
            np.testing.assert_array_equal(block[channel][stepped], theirs, err_msg=channel)
        for lane in np.flatnonzero(rng.random(lanes) < 0.1).tolist():
            block.reset(lane)
            sims[lane].reset()


@pytest.mark.thorough
def test_c_which_computes_every_step_in_full_has_the_same_bits(tmp_path):
    flown = unfused(mission("paper", 1.0, **STAGGERED, **REAL))
    wrong, _ = differences(CFlight(flown, tmp_path), flown, range(2))
    assert not wrong


@pytest.mark.thorough
def test_webassembly_has_the_same_bits(tmp_path):
    noise = {f"sensors.{of}": 0.01 for of in ("joints.force_noise", "accelerometer.noise", "motion.position_noise")}
    flown = unfused(mission("paper", 2.0, **RATES, **REAL, **noise))
    compile_mission(flown, "wasm32", tmp_path)
    there, here = wasm_flights(tmp_path, "paper", [{"numbers": {}}])[0], tl.fly(flown)
    for channel in json.loads((tmp_path / "paper.json").read_text())["channels"]:
        values = here[channel["name"]].reshape(len(here.time), -1)
        np.testing.assert_array_equal(there.log[: len(values), channel["columns"]], values)


@pytest.mark.thorough
def test_mujoco_reads_the_same_sensors_at_the_same_rates():
    keys = {**STAGGERED, "mission.log_interval": 0.001}
    ours, theirs = (tl.fly(mission("iris", 0.5, **keys), engine=engine) for engine in ("compiled", "mujoco"))
    for channel in ("measured_joint_force", "measured_position", "estimated_position", "measured_altimeter"):
        changes = [np.any(np.diff(f[channel].reshape(len(f.time), -1), axis=0) != 0.0, axis=1) for f in (ours, theirs)]
        np.testing.assert_array_equal(*changes)


def by_hand(flight, k):
    """Position, velocity and attitude [position, velocity, quaternion] at every step by Groves' strapdown equations."""
    T, M = 0.004, 0.008
    a, v = np.exp(-k["attitude"] * M), np.exp(-k["position"] * M)
    get = {name: flight[name] for name in flight.channels}
    r, s, q = (get[f"estimated_{name}"][0] for name in ("position", "velocity", "attitude"))
    turn = Rotation.from_quat(q, scalar_first=True)
    centre, rates = k["centre"], np.zeros(3)
    r, s = r - turn.apply(centre), s - turn.apply(np.cross(rates, centre))
    acceleration, before, gyro, accel, started, out = np.zeros(3), rates, np.zeros(3), np.zeros(3), False, []
    for step in range(len(flight.time)):
        if step % 4 == 1:
            w, f = get["measured_rates"][step], get["measured_specific_force"][step]
            dt = T if started else 0.0
            turn = turn * Rotation.from_rotvec((0.5 * (before + w) - gyro) * dt)
            new = turn.apply(f - accel) - [0.0, 0.0, GRAVITY]
            r, s = r + s * dt + (2.0 * acceleration + new) * dt * dt / 6.0, s + 0.5 * (acceleration + new) * dt
            acceleration, before, rates, started = new, w, w - gyro, True
        if step % 8 == 1:
            measured = Rotation.from_quat(get["measured_attitude"][step], scalar_first=True)
            off = (turn.inv() * measured).as_rotvec()
            faster = get["measured_velocity"][step] - (s + turn.apply(np.cross(rates, centre)))
            farther = get["measured_position"][step] - (r + turn.apply(centre))
            body = turn.inv().apply(faster)
            r, s, turn = (
                r + (1.0 - v) * farther,
                s + (1.0 - v * v) * faster,
                turn * Rotation.from_rotvec((1 - a * a) * off),
            )
            gyro, accel = gyro - (1 - a) ** 2 / M * off, accel - (1 - v) ** 2 / M * body
        out.append(
            [*(r + turn.apply(centre)), *(s + turn.apply(np.cross(rates, centre))), *turn.as_quat(scalar_first=True)]
        )
    return np.array(out)


@pytest.mark.thorough
def test_the_state_is_that_of_a_recursion_at_the_rate_of_the_imu_held_in_between():
    keys = {**RATES, "mission.log_interval": 0.001, "estimator.confirmation": "none"}
    m = mission("iris", 6.0, **keys)
    flight = tl.fly(m)
    bandwidths = {"attitude": m.estimator.attitude_bandwidth, "position": m.estimator.position_bandwidth}
    mine = by_hand(flight, {**bandwidths, "centre": np.array(tl.Vehicle.from_settings(m.vehicle).center_of_mass)})
    theirs = np.hstack([flight[f"estimated_{name}"] for name in ("position", "velocity", "attitude")])
    theirs[:, 6:] *= np.sign(np.sum(theirs[:, 6:] * mine[:, 6:], axis=1))[:, None]
    np.testing.assert_allclose(mine, theirs, atol=1e-9)
    changes = np.flatnonzero(np.any(np.diff(flight["estimated_rates"], axis=0) != 0.0, axis=1)) + 1
    assert set(changes % 4) == {1}


def test_the_push_is_filtered_at_the_rate_of_the_imu():
    keys = {**RATES, "mission.log_interval": 0.001, "estimator.confirmation": "none", "estimator.tare_start": 0.2}
    keys |= {"estimator.tare_duration": 0.2, "estimator.identify_mass": False}
    keys |= {"pushes": [{"force": [5.0, 2.0, -1.0], "time": 4.5, "sigma": 0.3}]}
    m = mission("iris", 6.0, **keys)
    flight = tl.fly(m)
    w = m.estimator.push_bandwidth
    A, B, *_ = cont2discrete(
        (np.array([[0.0, 1.0], [-w * w, -2.0 * w]]), np.array([[0.0], [w * w]]), np.eye(2), np.zeros((2, 1))), 0.004
    )
    state, out = np.zeros((2, 3)), []
    for step in range(401, len(flight.time), 4):  # the first sample behind the tare
        frame = Rotation.from_quat(flight["estimated_attitude"][step - 1], scalar_first=True)
        state = A @ state + B @ frame.inv().apply(flight["push_measured"][step])[None]
        out.append([frame.apply(state[0]), flight["push_estimate"][step]])
    mine, theirs = np.moveaxis(np.array(out), 1, 0)
    assert np.abs(theirs).max() > 1.0
    np.testing.assert_allclose(mine, theirs, atol=1e-9)


def test_a_rate_of_every_step_flies_the_bits_of_a_flight_without_rates():
    plain = mission("iris", 1.5, **{"sensors.motion.interval": 0.0})
    same = changed(plain, "sensors.interval", plain.mission.step)
    a, b = tl.fly(plain), tl.fly(same)
    for channel in a.channels:
        np.testing.assert_array_equal(a[channel], b[channel], err_msg=channel)


@pytest.mark.thorough
def test_linearization_takes_the_common_period_of_all_sensors():
    m = mission("paper", 20.0, **{**RATES, **REAL, "sensors.joints.interval": 0.006})
    assert tl.linearize(m).step == pytest.approx(0.024)


def test_a_lane_may_not_change_to_another_kind_of_rate():
    block = tl.Block(mission("iris"), 2)
    with pytest.raises(tl.InputError, match=r"sensors\.interval"):
        block.reset(1, keys={"sensors.interval": 0.004})


@pytest.mark.thorough
def test_a_watchdog_does_not_take_joints_for_frozen_that_are_held_between_their_samples():
    keys = {"supervision.model": "on", "supervision.watchdog.frozen_samples": 10, "sensors.joints.interval": 0.02}
    flight = tl.fly(mission("iris", 5.0, **keys))
    assert flight.outcome == "flying"
    assert not flight.findings
