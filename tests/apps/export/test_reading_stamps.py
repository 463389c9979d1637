"""Readings have the times at which they were taken, in every file: by readers of others, they are then the truth."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from exported import mcap_of, numbers, xyz

import tandemlift as tl
from tandemlift.analysis.logs.log import log_of
from tandemlift.apps.export.reading import read_bag
from tandemlift.apps.export.write import export
from tandemlift.flight.channels import STAMP, stamp_of

pytestmark = [pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning"), pytest.mark.thorough]
PUSH = {"force": [3.0, 1.0, 0.0], "time": 0.6, "sigma": 0.1, "point": [0.0, 0.3, 0.0]}
FLOWN = {
    "mission.duration": 1.2,
    "mission.log_interval": 0.001,
    "pushes": [PUSH],
    "sensors.model": "simulated",
    "sensors.gyroscope.noise": 0.0002,
}
CLOCKS = {
    "sensors.delay": 0.003,
    "sensors.motion.delay": 0.007,
    "sensors.interval": 0.002,
    "sensors.joints.interval": 0.005,
    "sensors.joints.first_sample": 0.001,
    "sensors.motion.interval": 0.01,
    "sensors.motion.first_sample": 0.002,
}
STALE = [
    {"sensor": "imu", "kind": "stale", "time": 0.3, "until": 0.45},
    {"sensor": "motion", "kind": "stale", "time": 0.6, "until": 0.7},
]
OTHERS = {
    "as they are": {},
    "slow and late": CLOCKS,
    "stale for a while": CLOCKS | {"sensor_faults": STALE},
    "with another interval from some time on": CLOCKS
    | {"changes": [{"key": "sensors.motion.interval", "value": 0.003, "time": 0.5, "duration": 0.2}]},
    "with a sensor more": CLOCKS
    | {"sensors.additional": [{"name": "altimeter", "interval": 0.02, "first_sample": 0.005, "delay": 0.01}]},
}


def flown(changes, **more):
    return tl.fly(tl.load_mission("hover", FLOWN | changes | more))


@pytest.fixture(scope="module", params=["as they are", "slow and late"])
def flight(request):
    return flown(OTHERS[request.param])


def mcap(flight, folder):
    return mcap_of(export(flight, folder / "flight.mcap"))


def bag(flight, folder):
    """As `mcap_of`, by `rosbags`."""
    from rosbags.highlevel import AnyReader

    found = {}
    with AnyReader([export(flight, folder / "flight.bag")]) as reader:
        for connection, at, data in reader.messages():
            if connection.topic in ("/tandemlift/odometry", "/tandemlift/measured/imu"):
                message = reader.deserialize(data, connection.msgtype)
                stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
                rates = message.twist.twist.angular if hasattr(message, "twist") else message.angular_velocity
                path = "twist.twist.angular" if hasattr(message, "twist") else "angular_velocity"
                leaves = {f"{path}.{axis}": getattr(rates, axis) for axis in "xyz"}
                found.setdefault(connection.topic, []).append(
                    (connection.msgtype, at, {"header.stamp": stamp} | leaves)
                )
    return found


def of_topics(read):
    """(Times [s] and true rates, times and readings of the gyroscope) of the topics of a bag."""
    found = []
    for topic, path in (("odometry", "twist.twist.angular"), ("measured/imu", "angular_velocity")):
        messages = read[f"/tandemlift/{topic}"]
        found += [numbers(messages, "header.stamp")[:, 0] / 1e9, numbers(messages, *xyz(path))]
    return found


def of_table(flight, folder):
    """The same of a table, by pandas."""
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(export(flight, folder / "flight.csv"))
    true, read = (table[[f"{name}[rad/s].{axis}" for axis in "xyz"]] for name in ("rates", "measured_rates"))
    return [table["time[s]"], true.to_numpy(), table["imu_stamp[s]"].to_numpy(), read.to_numpy()]


READERS = {
    "mcap": lambda flight, folder: of_topics(mcap(flight, folder)),
    "rosbags": lambda flight, folder: of_topics(bag(flight, folder)),
    "pandas": of_table,
}


@pytest.mark.parametrize("reader", READERS)
def test_rates_that_others_read_fit_the_truth_best_at_their_stamps(reader, flight, tmp_path):
    pytest.importorskip("rosbags.rosbag1")
    time, true, stamps, read = READERS[reader](flight, tmp_path)
    later = (stamps > time[0] + 0.004) & (stamps < time[len(time) - 1] - 0.004)

    def rms(lag):
        expected = np.array([np.interp(stamps[later] - lag, time, axis) for axis in true.T]).T
        return np.sqrt(np.mean((read[later] - expected) ** 2))

    sizes = {lag: rms(lag) for lag in (-0.003, -0.002, -0.001, 0.0, 0.001, 0.002, 0.003)}
    assert min(sizes, key=sizes.get) == 0.0
    assert sizes[0.0] == pytest.approx(0.0002, rel=0.1)  # the noise alone
    assert min(sizes[-0.001], sizes[0.001]) > 2.0 * sizes[0.0]


@pytest.mark.parametrize("case", OTHERS)
def test_a_perfect_reading_in_a_row_is_the_truth_at_the_stamp_of_its_row(case):
    flight = flown(OTHERS[case], **{"sensors.errors": "none"})
    truth = {"measured_altimeter": flight["position"][:, 2]}
    compared = [name for name in flight if name.startswith("measured_") and name != "measured_specific_force"]
    assert len(compared) == 6 + ("sensor more" in case)
    for name in compared:
        steps = np.round(flight[stamp_of(name)] / 0.001).astype(int)
        later, own = steps >= 0, truth.get(name, flight.channels.get(name.removeprefix("measured_")))
        assert later.sum() > 1000
        np.testing.assert_allclose(flight[name][later], own[steps[later]], rtol=0.0, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("ending", ["mcap", "bag"])
@pytest.mark.parametrize("case", ["as they are", "slow and late"])
def test_a_bag_gives_back_which_readings_the_pilot_had_and_of_when(case, ending, tmp_path):
    pytest.importorskip("rosbags.rosbag1")
    flight = flown(OTHERS[case])
    found = read_bag(export(flight, tmp_path / f"flight.{ending}"))
    assert list(found) == list(flight)
    for name in (*STAMP, *(name for names in STAMP.values() for name in names)):
        np.testing.assert_allclose(found[name], flight[name], rtol=1e-12, atol=1e-9, err_msg=name)


def test_a_topic_of_readings_has_each_sample_once_and_one_that_is_stale_has_none(tmp_path):
    pytest.importorskip("rosbags.rosbag1")
    read = mcap(flown(OTHERS["stale for a while"]), tmp_path)
    for topic, interval in (("measured/imu", 2), ("joint_1/measured", 5), ("measured/odometry", 10)):
        times = numbers(read[f"/tandemlift/{topic}"], "header.stamp")[:, 0] / 1e6
        apart = np.diff(times)
        assert apart.min() > 0.0
        assert np.median(apart) == pytest.approx(interval, abs=1.0)
        assert apart.max() == pytest.approx(105.0 if topic == "measured/odometry" else 151.0, abs=6.0)
        assert len(times) <= 1000 / interval + 60


def test_a_record_of_version_1_0_gets_its_stamps_when_it_is_read(flight, tmp_path):
    old = replace(flight, channels={name: values for name, values in flight.channels.items() if name not in STAMP})
    found = tl.Flight.load(old.save(tmp_path / "old.npz"))
    for name in STAMP:
        assert np.array_equal(found[name], flight[name])


def test_a_bag_of_version_1_0_gives_its_readings_to_the_rows_that_had_them(flight, tmp_path):
    pytest.importorskip("rosbags.rosbag1")
    old = replace(flight, channels={name: values for name, values in flight.channels.items() if name not in STAMP})
    found = read_bag(export(old, tmp_path / "old.bag"))  # without stamps, every message has the time of its row
    for name in ("measured_rates", "measured_position", *STAMP):
        np.testing.assert_allclose(found[name], flight[name], rtol=1e-12, atol=1e-9, err_msg=name)


def test_a_table_of_our_own_is_a_log_by_the_stamps_of_its_readings(flight, tmp_path):
    pytest.importorskip("pandas")
    flight.to_pandas().to_csv(tmp_path / "log.csv")
    axes = [[f"{name}_{axis}" for axis in "xyz"] for name in ("measured_rates", "measured_position")]
    columns = {
        "measured_rates": {"time": "imu_stamp", "columns": axes[0]},
        "measured_position": {"time": "motion_stamp", "columns": axes[1]},
    }
    log, own = tl.read_log(tmp_path / "log.csv", columns), log_of(flight)
    for name in columns:
        shift = own[name].time - log[name].time
        assert np.ptp(shift) < 1e-9
        assert np.array_equal(log[name].values, own[name].values)
    shifts = [own[name].time[0] - log[name].time[0] for name in columns]
    assert shifts[0] == pytest.approx(shifts[1], abs=1e-9)


def test_a_map_says_whether_stamps_are_exact_and_late_ones_of_our_own_tables_are_warned_of(flight, tmp_path):
    path = export(flight, tmp_path / "log.csv")
    columns = {"columns": [f"measured_rates[rad/s].{axis}" for axis in "xyz"]}
    own = {"stamp_offset": 0.0, "measured_rates": columns | {"time": "imu_stamp[s]"}}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert tl.read_log(path, own).stamp_offset == 0.0
    said = r'times of rows, .* taken earlier: measured_rates \(time = "imu_stamp\[s\]"\)'
    with pytest.warns(tl.FlightWarning, match=said):
        assert tl.read_log(path, {"measured_rates": columns | {"time": "time[s]"}}).stamp_offset is None
    assert log_of(flight).stamp_offset == 0.0
    with pytest.raises(tl.InputError, match=r"stamp_offset = 'none': must be a number"):
        tl.read_log(path, own | {"stamp_offset": "none"})
