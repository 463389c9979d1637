"""Offset and drift of a clock are found, within the stated uncertainty, from motions in closed form."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.logs.clocks import clock_of, synchronised
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Log, Stream
from tandemlift.analysis.logs.stamps import distinct

DURATION = 30.0  # s
STEP = 0.001  # s
MASS = 0.8  # kg
FAST = np.arange(0.0, DURATION, STEP)


def sums_of_sines(rng, size, fastest):
    """Three smooth random signals over `FAST`, and their derivatives."""
    w, phase = 6.28 * rng.uniform(0.2, fastest, (3, 6, 1)), rng.uniform(0.0, 6.28, (3, 6, 1))
    signals, slopes = size * np.sin(w * FAST + phase), size * w * np.cos(w * FAST + phase)
    return signals.sum(axis=1), slopes.sum(axis=1)


def turning(rng):
    """Rates (n, 3) and attitudes of a body, w, x, y, z: yaw, pitch, roll in closed form, and their kinematics."""
    (roll, pitch, yaw), (p, q, r) = sums_of_sines(rng, 0.03, 1.5)
    turned = Rotation.from_euler("ZYX", np.array([1.0 + yaw, pitch, roll]).T)
    rates = p - r * np.sin(pitch), q * np.cos(roll) + r * np.sin(roll) * np.cos(pitch)
    last = r * np.cos(roll) * np.cos(pitch) - q * np.sin(roll)
    return np.array([*rates, last]).T, turned.as_quat(scalar_first=True)


def on_a_clock(stamps, offset, drift):
    """The stamps of another clock: offset and drift turn them into the true ones again."""
    return (stamps - offset) / (1.0 + drift)


@pytest.fixture(scope="module")
def motions():
    return [turning(np.random.default_rng(seed)) for seed in range(3)]


def moving(motions, seed, offset, drift, every=5):
    """A log with a gyroscope and an attitude, each with noise, on clocks of their own."""
    rng, (rates, attitude) = np.random.default_rng(100 + seed), motions[seed % len(motions)]
    noisy = Rotation.from_quat(attitude[::every], scalar_first=True)
    noisy = noisy * Rotation.from_rotvec(0.002 * rng.standard_normal((len(noisy), 3)))
    measured = rates + 0.01 + 0.0025 * rng.standard_normal(rates.shape)
    values = noisy.as_quat(scalar_first=True) * rng.choice([-1.0, 1.0], (len(noisy), 1))  # both signs are the attitude
    stamps = on_a_clock(FAST[::every], offset, drift)
    force = np.tile([0.0, 0.0, 9.81], (len(FAST), 1))
    return {MOTION[2]: Stream(stamps, values), IMU[1]: Stream(FAST, measured), IMU[0]: Stream(FAST, force)}


@pytest.mark.parametrize(("offset", "drift"), [(0.0, 0.0), (0.0321, 60e-6), (-7.4, -200e-6), (12.0, 0.0)])
def test_the_clock_of_motion_capture_is_found_to_a_fraction_of_a_millisecond(motions, offset, drift):
    clock = clock_of(Log(moving(motions, 1, offset, drift)), "motion")
    assert clock.offset == pytest.approx(offset + drift * clock.about, abs=4.0 * clock.offset_sigma)
    assert clock.drift == pytest.approx(drift, abs=4.0 * clock.drift_sigma)
    assert clock.offset_sigma < 5e-4
    assert clock.scale == pytest.approx(1.0, abs=0.02)


def test_the_stated_uncertainty_is_that_of_many_logs(motions):
    errors = []
    for seed in range(16):
        clock = clock_of(Log(moving(motions, seed, 0.01, 0.0)), "motion")
        errors.append([(clock.offset - 0.01) / clock.offset_sigma, clock.drift / clock.drift_sigma])
    assert 0.5 < np.mean(np.square(errors)) < 1.8  # 95 % of 32 squared standard normals: 0.57 to 1.55


def test_gaps_and_repeated_stamps_are_bridged(motions):
    streams = moving(motions, 2, 0.02, 0.0)
    for name, (begin, end) in ((MOTION[2], (8.0, 9.1)), (IMU[1], (17.0, 17.6))):
        time, values = streams[name]
        kept = (time < begin) | (time > end)
        repeated = np.repeat(np.arange(kept.sum()), 1 + (np.arange(kept.sum()) % 50 == 0))
        streams[name], _ = distinct(name, Stream(time[kept][repeated], values[kept][repeated]))
    clock = clock_of(Log(streams), "motion")
    assert clock.offset == pytest.approx(0.02, abs=4.0 * clock.offset_sigma)
    assert clock.offset_sigma < 5e-4


def test_the_clock_of_joints_and_the_mass_they_carry_are_found_beside_slow_pushes():
    rng = np.random.default_rng(5)
    acceleration = sums_of_sines(rng, 0.1, 8.0)[0].T + np.array([0.0, 0.0, 9.81])
    push = 3.0 * np.exp(-0.5 * ((FAST[:, None] - 10.0) / 0.6) ** 2) * [1.0, -0.5, 0.3]
    both = np.hstack([0.4 * MASS * acceleration - push, 0.6 * MASS * acceleration])
    forces = Stream(on_a_clock(FAST[::2], -0.05, 30e-6), (both + 0.05 * rng.standard_normal(both.shape))[::2])
    streams = {JOINTS[0]: forces, IMU[1]: Stream(FAST, rng.standard_normal((len(FAST), 3)))}
    streams[IMU[0]] = Stream(FAST, acceleration + 0.03 * rng.standard_normal(acceleration.shape))
    clock = clock_of(Log(streams), "joints")
    assert clock.offset == pytest.approx(-0.05 + 30e-6 * clock.about, abs=4.0 * clock.offset_sigma)
    assert clock.offset_sigma < 2e-4
    assert clock.scale == pytest.approx(MASS, rel=0.02)
    del streams[IMU[1]]
    assert synchronised(Log(streams))[JOINTS[0]].time == pytest.approx(FAST[::2], abs=1e-3)


def test_stamps_are_corrected_where_the_motion_tells_and_kept_where_it_does_not(motions):
    streams = moving(motions, 0, 0.3, 50e-6)
    streams[MOTION[0]] = Stream(streams[MOTION[2]].time, np.ones((len(FAST[::5]), 3)))
    aligned = synchronised(Log(streams))
    (line,) = aligned.notes
    assert aligned[MOTION[0]].time == pytest.approx(FAST[::5], abs=2e-3)
    assert line.startswith("motion: offset 30")
    assert "ppm" in line
    still = {**streams, IMU[1]: Stream(FAST, np.random.default_rng(3).standard_normal((len(FAST), 3)))}
    kept = synchronised(Log(still))
    (line,) = kept.notes
    assert np.array_equal(kept[MOTION[0]].time, streams[MOTION[0]].time)
    assert "its stamps are kept" in line


def test_perfect_readings_tell_the_clock_exactly_and_still_ones_nothing(motions):
    rates, attitude = motions[0]
    streams = {MOTION[2]: Stream(FAST[::5] - 0.04, attitude[::5]), IMU[1]: Stream(FAST, rates)}
    streams[IMU[0]] = Stream(FAST, np.tile([0.0, 0.0, 9.81], (len(FAST), 1)))
    assert clock_of(Log(streams), "motion").offset == pytest.approx(0.04, abs=1e-5)
    still = {name: Stream(time, np.zeros_like(values) + values[0]) for name, (time, values) in streams.items()}
    assert clock_of(Log(still), "motion").correlation == pytest.approx(0.0, abs=1e-6)


def test_a_log_without_an_attitude_has_no_clock_of_motion_capture(motions):
    streams = moving(motions, 0, 0.0, 0.0)
    del streams[MOTION[2]]
    streams[MOTION[1]] = Stream(FAST, np.ones((len(FAST), 3)))
    with pytest.raises(tl.InputError, match="has no measured_attitude"):
        clock_of(Log(streams), "motion")
    assert synchronised(Log(streams)).notes == ("motion: the log has no measured_attitude; its stamps are kept",)
