"""A log has the readings of a flight at the times at which they were taken, and refuses what is no log."""

import numpy as np
import pytest
from repository import ROOT

import tandemlift as tl
from tandemlift.analysis.logs.log import (
    COMMANDS,
    IMU,
    JOINTS,
    MOTION,
    STREAMS,
    Log,
    Stream,
    log_of,
    stream_channel,
)

DELAYS = {"sensors.delay": 0.003, "sensors.motion.delay": 0.007}
CLOCKS = {
    "sensors.interval": 0.002,
    "sensors.joints.interval": 0.005,
    "sensors.joints.first_sample": 0.001,
    "sensors.motion.interval": 0.01,
    "sensors.motion.first_sample": 0.004,
}
TIME = np.array([0.0, 0.1, 0.3])
THREE = np.arange(9.0).reshape(3, 3)


@pytest.fixture(scope="module")
def flown():
    """A flight under a push, whose sensors are perfect but slow and late."""
    push = {"force": [3.0, 1.0, 0.0], "time": 0.6, "sigma": 0.1}
    changes = {"mission.duration": 1.2, "mission.log_interval": 0.001, "pushes": [push], "sensors.model": "simulated"}
    return tl.fly(tl.load_mission("hover", changes | DELAYS | CLOCKS))


def truth_at(flight, name, time):
    """A channel at some times, which are steps of the flight."""
    return flight[name][np.round(time / 0.001).astype(int)]


@pytest.mark.parametrize("name", [*MOTION, "measured_rates"])
def test_a_perfect_reading_is_the_truth_at_its_stamp_whatever_the_delay(flown, name):
    time, values = log_of(flown)[name]
    later = time >= 0.0
    assert later.sum() > 100
    assert np.array_equal(values[later], truth_at(flown, name.removeprefix("measured_"), time[later]))


def test_rates_and_duration_are_those_of_the_clocks(flown):
    log = log_of(flown)
    rates = {IMU[0]: 500.0, JOINTS[0]: 200.0, MOTION[0]: 100.0, COMMANDS: 1000.0}
    assert {name: log.rate(name) for name in rates} == pytest.approx(rates)
    assert log.duration == pytest.approx(1.2, abs=0.03)


def test_a_log_of_a_coarse_record_has_the_samples_that_are_in_it():
    mission = tl.load_mission("hover", {"mission.duration": 0.5, "sensors.model": "simulated", **CLOCKS})
    flight = tl.fly(mission)
    time, values = log_of(flight)["measured_rates"]
    assert np.diff(time).min() >= 0.01 - 1e-9
    assert np.isin(values, flight["measured_rates"]).all()


def test_a_part_keeps_the_clock(flown):
    part = log_of(flown).between(0.5, 0.7)
    assert (part.begin, part.end) == pytest.approx((0.511, 0.69), abs=0.011)
    assert np.array_equal(
        part["measured_rates"].values[0], truth_at(flown, "rates", part["measured_rates"].time[:1])[0]
    )
    with pytest.raises(tl.InputError, match=r"stream measured_.* has no sample from 7 to 8 s"):
        part.between(7.0, 8.0)


def test_a_flight_without_sensors_has_no_log():
    with pytest.raises(tl.InputError, match=r'sensors\.model = "simulated"'):
        log_of(tl.fly(tl.load_mission("hover", {"mission.duration": 0.1})))


def test_the_contract_has_every_stream_with_its_unit():
    page = (ROOT / "docs" / "how-to" / "log-a-vehicle.md").read_text("utf-8")
    units = {name: stream_channel(name).unit.replace("^2", "²") for name in STREAMS}
    assert [name for name, unit in units.items() if f"| `{name}` | {unit}" not in page] == []


@pytest.mark.parametrize(
    ("name", "time", "values", "message"),
    [
        ("measured_rate", TIME, THREE, "unknown stream 'measured_rate'.*measured_rates"),
        ("measured_rates", TIME, THREE[:, :2], "stream measured_rates: has 2 columns: must have 3"),
        ("measured_joint_force", TIME, np.ones((3, 4)), "has 4 columns: must have 3 for each quadrotor"),
        ("rotor_commands", TIME, np.ones((3, 6)), "has 6 columns: must have 1 for each rotor"),
        ("measured_rates", TIME, np.where(THREE == 4.0, np.nan, THREE), "row 1 is .* at 0.1 s: must be finite"),
        ("measured_rates", TIME[[0, 2, 1]], THREE, "row 2 is at 0.1 s, the row before at 0.3 s: times must increase"),
        ("measured_rates", TIME[[0, 1, 1]], THREE, "row 2 is at 0.1 s, the row before at 0.1 s"),
        ("measured_rates", TIME[:2], THREE, r"times \(2,\), values \(3, 3\)"),
        ("measured_rates", TIME[:0], THREE[:0], "n ≥ 1"),
    ],
)
def test_what_is_no_stream_is_refused_by_name_and_row(name, time, values, message):
    with pytest.raises(tl.InputError, match=message):
        Log({name: Stream(time, values)}, "my.csv")


def test_a_log_without_a_stream_is_refused_and_a_missing_one_is_named():
    with pytest.raises(tl.InputError, match="has no stream"):
        Log({})
    log = Log({"measured_rates": Stream(TIME, THREE)}, "my.csv")
    with pytest.raises(tl.InputError, match=r"my.csv: has no measured_specific_force \(accelerometer reading"):
        log.require(*IMU)
