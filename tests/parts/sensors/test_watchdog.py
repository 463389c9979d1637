"""Watchdogs against streams of samples whose faults are known, and against what NumPy counts of them."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import ZERO, Quat, Vec3, each, vec3
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotated_by
from tandemlift.parts.sensors.health import (
    FROZEN,
    NO_NUMBER,
    OUT_OF_RANGE,
    WELL,
    AttitudeLimits,
    JointLimits,
    PerSensor,
    SensorHealth,
    VectorLimits,
    check_sample,
)
from tandemlift.parts.sensors.readings import ImuReading, MotionReading, Readings
from tandemlift.parts.sensors.sensor_faults import SensorFaultState, apply_faults, sensor_faults_from
from tandemlift.parts.sensors.sensors_table import SensorFaultTable
from tandemlift.parts.sensors.substitutes import PredictedReadings
from tandemlift.parts.sensors.vehicle_sensors import SENSORS
from tandemlift.parts.sensors.watchdog import (
    Watchdog,
    any_invalid,
    start_watchdog,
    substitute_velocity,
    watchdog_from,
    watchdog_step,
)

DT = 0.005
LEVEL, TWO = Quat(1.0, 0.0, 0.0, 0.0), each(2)
DOG = Watchdog(
    stale_time=0.1,
    invalid_time=0.05,
    sensors=PerSensor(
        joints=JointLimits(100.0, 20.0, 25.0),
        accelerometer=VectorLimits(80.0, 25.0),
        gyroscope=VectorLimits(15.0, 25.0),
        position=VectorLimits(100.0, 25.0),
        velocity=VectorLimits(20.0, 25.0),
        attitude=AttitudeLimits(25.0),
    ),
    forgetting=DT / 0.5,
    attitude_gap=0.1,
    position_gap=0.1,
    velocity_gap=0.3,
    rates_gain=1.0 - math.exp(-60.0 * DT),
    velocity_gain=1.0 - math.exp(-10.0 * DT),
    motion_rate=1.0 / DT,
)
NO_FAULTS = sensor_faults_from([], 2, [], DT)
SIZES = PerSensor(joints=200.0, accelerometer=100.0, gyroscope=20.0, position=200.0, velocity=30.0, attitude=1.0)


def stream(seconds, rates=ZERO, velocity=ZERO, seed=1):
    """Samples with noise of a level or turning vehicle, at DT."""
    chance, attitude, position = np.random.default_rng(seed), LEVEL, ZERO

    def noise(size):
        return vec3(chance.normal(0.0, size, 3))

    def joints(size):
        return Vec3(*[TWO(*row) for row in chance.normal(0.0, size, (3, 2)).tolist()])

    for _ in range(round(seconds / DT)):
        attitude, position = rotated_by(attitude, rates * DT), position + velocity * DT
        unit = ImuReading(
            Vec3(0.0, 0.0, 9.81) + noise(0.03), rates + noise(0.0025), joints(0.05), joints(0.005), LEVEL, 1.0
        )
        yield Readings(
            unit,
            MotionReading(position + noise(0.003), velocity + noise(0.01), rotated_by(attitude, noise(0.002)), 1.0),
        )


def watched(samples, faults=NO_FAULTS, predicted=None):
    """(clean readings, report) after every sample."""
    expected = predicted or PredictedReadings(State(ZERO, ZERO, LEVEL, ZERO), ZERO, ZERO)
    memory = spoiling = None
    for sample in samples:
        if memory is None:
            still = Readings(sample.imu._replace(fresh=0.0), sample.motion._replace(fresh=0.0))
            memory, spoiling = start_watchdog(still), SensorFaultState(still, 0.0)
        given, spoiling = apply_faults(faults, spoiling, sample)
        clean, report, memory = watchdog_step(DOG, memory, given, expected, DT)
        yield clean, report


def numbers(value):
    return [n for part in value for n in (numbers(part) if isinstance(part, tuple) else [part])]


def failing(sensor, kind, size=0.0, until=None, at=1.0):
    """The fault of a sensor or device from a time [s] on; of joints, that of the second."""
    joint = 2 if sensor == "joints" else None
    fault = SensorFaultTable(sensor=sensor, quadrotor=joint, kind=kind, time=at, until=until, size=(size, size, size))
    return sensor_faults_from([fault], 2, [], DT)


def found_at(reports, name):
    """The time at which a part of the report is first above 0, and what it then is."""
    return next(((i * DT, getattr(r, name)) for i, r in enumerate(reports) if getattr(r, name) > 0.0), None)


def test_sound_sensors_with_noise_alarm_nobody_and_pass_as_they_are():
    samples = list(stream(8.0))
    for sample, (clean, report) in zip(samples, watched(samples), strict=True):
        assert clean == sample
        assert report == (0.0,) * 11 + (1.0,)


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize(
    ("kind", "code", "late"), [("frozen", FROZEN, 0.125), ("nan", NO_NUMBER, 0.05), ("range", OUT_OF_RANGE, 0.05)]
)
def test_each_fault_of_each_sensor_is_found_in_time_and_no_other_and_never_gets_through(sensor, kind, code, late):
    fault = failing(sensor, kind, getattr(SIZES, sensor), at=0.3)
    clean, reports = zip(*watched(stream(0.6), fault), strict=True)
    at, what = found_at(reports, sensor)
    assert what == code
    assert at == pytest.approx(0.3 + late, abs=2 * DT)
    others = [name for name in SENSORS if name != sensor and found_at(reports, name)]
    assert others == []
    assert all(map(math.isfinite, (n for c in clean for n in numbers(c))))
    biggest = max(abs(n) for c in clean for n in numbers(c))
    assert biggest < 15.0


@pytest.mark.parametrize("device", ["imu", "motion"])
def test_a_device_that_sends_nothing_is_stale_after_its_time(device):
    faults = failing(device, "stale", until=1.5)
    reports = [r for _, r in watched(stream(2.0), faults)]
    assert found_at(reports, device)[0] == pytest.approx(1.1, abs=2 * DT)
    assert getattr(reports[-1], device) == 0.0  # it has come back


@pytest.mark.parametrize(
    ("sensor", "size", "name", "late"),
    [
        ("gyroscope", 0.4, "attitude_inconsistent", True),
        ("attitude", 0.15, "attitude_inconsistent", False),
        ("velocity", 0.4, "velocity_inconsistent", True),
        ("position", 0.3, "velocity_inconsistent", False),
        ("accelerometer", 1.0, "speed_inconsistent", True),
    ],
)
def test_measurements_that_disagree_are_found_as_the_window_has_it(sensor, size, name, late):
    """A jump at once; a constant error b after −τ ln(1 − d / b τ)."""
    reports = [r for _, r in watched(stream(3.0), failing(sensor, "bias", size / math.sqrt(3.0)))]
    limit = {"attitude_inconsistent": 0.1, "velocity_inconsistent": 0.1, "speed_inconsistent": 0.3}[name]
    wait = 0.0
    if late:
        wait = -0.5 * math.log(1.0 - limit / (size * 0.5))
    assert found_at(reports, name)[0] == pytest.approx(1.0 + wait, abs=0.05)


def test_measurements_agree_while_the_vehicle_turns_and_moves():
    still = Vec3(0.0, 0.0, 0.8)  # about the vertical, so that the accelerometer's reading stays
    reports = [r for _, r in watched(stream(6.0, rates=still, velocity=Vec3(1.0, -0.5, 0.2)))]
    assert not any(r.attitude_inconsistent + r.velocity_inconsistent + r.speed_inconsistent for r in reports)


def test_the_attitude_stands_in_for_a_lost_gyroscope():
    rates = Vec3(0.0, 0.0, 0.5)
    clean = [c for c, _ in watched(stream(3.0, rates=rates), failing("gyroscope", "nan"))]
    late = np.array([c.imu.rates for c in clean[-300:]])
    assert late.mean(axis=0) == pytest.approx(rates, abs=0.01)
    assert late.std(axis=0).max() < 0.15  # noise of 2 mrad at 200 Hz through 60 rad/s


def test_the_position_stands_in_for_a_lost_velocity():
    velocity = Vec3(0.5, 0.0, -0.2)
    clean = [c for c, _ in watched(stream(4.0, velocity=velocity), failing("velocity", "nan"))]
    assert np.mean([c.motion.velocity for c in clean[-300:]], axis=0) == pytest.approx(velocity, abs=0.01)


def test_what_is_predicted_stands_in_for_a_lost_motion_measurement():
    expected = PredictedReadings(
        State(Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3), Quat(0.0, 0.0, 0.0, 1.0), ZERO), ZERO, ZERO
    )
    faults = failing("motion", "stale")
    clean, _ = list(watched(stream(2.0), faults, expected))[-1]
    assert clean.motion == (*expected.state[:3], 0.0)


def test_a_lost_accelerometer_reads_as_if_nothing_accelerated():
    tilted = rotated_by(LEVEL, Vec3(0.3, 0.0, 0.0))
    expected = PredictedReadings(State(ZERO, ZERO, tilted, ZERO), ZERO, Vec3(0.1, 0.0, 0.0))
    clean, _ = list(watched(stream(2.0), failing("accelerometer", "nan"), expected))[-1]
    assert clean.imu.specific_force == pytest.approx((0.1, 9.81 * math.sin(0.3), 9.81 * math.cos(0.3)))


def test_a_fault_ends_when_it_is_over():
    bias = SensorFaultTable(sensor="position", kind="bias", time=10 * DT, until=20 * DT, size=(1.0, 2.0, 3.0))
    faults = sensor_faults_from([bias], 2, [], DT)
    samples = list(stream(0.2))
    spoiling, off = SensorFaultState(samples[0], 0.0), []
    for sample in samples:
        given, spoiling = apply_faults(faults, spoiling, sample)
        off.append(given.motion.position - sample.motion.position)
    assert [i for i, o in enumerate(off) if any(o)] == list(range(10, 20))
    assert off[10] == pytest.approx((1.0, 2.0, 3.0))


VALID = SensorHealth(**dict.fromkeys(SensorHealth._fields, 0.0))


def test_gains_of_the_watchdogs_are_those_of_the_motion_sensors_interval():
    mission = tl.load_mission("iris", {"sensors.motion.interval": 0.01})
    found = watchdog_from(mission.supervision.watchdog, mission.sensors, mission.mission.step)
    w = mission.supervision.watchdog
    assert 1.0 / found.motion_rate == pytest.approx(0.01)
    assert found.rates_gain == pytest.approx(1.0 - math.exp(-0.01 * w.rates_bandwidth))
    assert found.velocity_gain == pytest.approx(1.0 - math.exp(-0.01 * w.velocity_bandwidth))
    assert found.forgetting == pytest.approx(0.01 / w.window)


@pytest.mark.parametrize("sensor", ["attitude", "position", "velocity", "gyroscope", "accelerometer"])
def test_one_invalid_sensor_of_those_that_are_compared_is_enough(sensor):
    health = PerSensor(*[VALID] * len(PerSensor._fields))
    assert any_invalid(health) == 0.0
    assert any_invalid(health._replace(**{sensor: VALID._replace(failure=1.0)})) == 1.0


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("quantity", range(2))
def test_one_bad_number_of_one_joint_is_found_along_any_axis(axis, quantity):
    limits = JointLimits(10.0, 1.0, 5.0)

    def sample(number):
        """Force and torque at two joints, one number of which is given."""
        parts = [[TWO(0.5, 0.25) for _ in range(3)] for _ in range(2)]
        parts[quantity][axis] = TWO(0.5, number)
        return tuple(Vec3(*part) for part in parts)

    sound = sample(0.75)
    assert check_sample(limits, sound, sample(0.75)) == (0.0, 0.0, 1.0)
    assert check_sample(limits, sample(0.8), sound) == (0.0, 0.0, 1.0)  # the other joint stands still
    assert check_sample(limits, sample(float("nan")), sound)[:2] == (1.0, 1.0)
    assert check_sample(limits, sample(-10.5), sound)[:2] == (0.0, 1.0)


BAD, HEALTHY = VALID._replace(failure=NO_NUMBER), PerSensor(*[VALID] * 6)
PLAIN = SimpleNamespace(motion_rate=100.0, velocity_gain=0.25)
BEFORE = SimpleNamespace(
    velocity=Vec3(1.0, 2.0, 3.0), valid=SimpleNamespace(motion=SimpleNamespace(position=Vec3(0.5, 0.5, 0.5)))
)
SAMPLE = SimpleNamespace(position=Vec3(0.53, 0.5, 0.46), velocity=Vec3(9.0, 9.0, 9.0), fresh=1.0)


@pytest.mark.parametrize("lost", [{"healths": HEALTHY._replace(velocity=BAD)}, {"report": WELL._replace(velocity=2.0)}])
def test_the_substituted_velocity_follows_the_derivative_of_the_position_by_the_gain_while_there_is_a_new_one(lost):
    def found(sample=SAMPLE, healths=HEALTHY, report=WELL):
        return substitute_velocity(PLAIN, BEFORE, sample, healths, report)

    assert found() == SAMPLE.velocity
    assert found(**lost) == pytest.approx([1.0 + 0.25 * (3.0 - 1.0), 2.0 * 0.75, 3.0 + 0.25 * (-4.0 - 3.0)])
    held = SimpleNamespace(**{**vars(SAMPLE), "fresh": 0.0})
    assert found(held, **lost) == BEFORE.velocity
    no_position = lost.get("healths", HEALTHY)._replace(position=BAD)
    assert found(**{**lost, "healths": no_position}) == BEFORE.velocity
