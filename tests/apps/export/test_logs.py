"""Logs that others wrote are read as what they measured: ULog by its definition, bags by rosbags, CSV by pandas."""

import re
import struct
from pathlib import Path

import numpy as np
import pandas
import pytest
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, log_of
from tandemlift.apps.export.write import export

TIME = np.arange(40) * 0.005  # s
RNG = np.random.default_rng(2)
RATES, FORCE, POSITION, VELOCITY = RNG.standard_normal((4, len(TIME), 3))
ATTITUDE = Rotation.from_rotvec(RNG.standard_normal((len(TIME), 3)))
DOWN = Rotation.from_euler("x", 180.0, degrees=True)  # front, left, up to front, right, down; north-west-up to NED
LINEAR = np.arange(1.0, 7.0) * 10.0 * TIME[:, None]  # so that interpolation is exact
EPOCH = 1_700_000_000_000_000_000  # ns


def quaternions(rotation):
    q = rotation.as_quat(scalar_first=True)
    return q * np.where(q[:, :1] < 0.0, -1.0, 1.0)


def same_attitude(values):
    return np.abs(np.sum(values * quaternions(ATTITUDE), axis=1)) == pytest.approx(1.0, abs=1e-6)


# ---- ULog, written by the definition of the format


def ulog_of(path, topics):
    """A ULog; topics: name → (fields as in the format, stamps [µs], 3 ms before they are logged, rows of numbers)."""

    def message(kind, payload):
        return struct.pack("<HB", len(payload), ord(kind)) + payload

    parts = [b"\x55\x4c\x6f\x67\x01\x12\x35\x01" + struct.pack("<Q", 0), message("B", bytes(40))]
    for name, (fields, _, _) in topics.items():
        parts.append(message("F", f"{name}:uint64_t timestamp;uint64_t timestamp_sample;{fields};".encode()))
    for number, (name, (_, stamps, rows)) in enumerate(topics.items()):
        parts.append(message("A", struct.pack("<BH", 0, number) + name.encode()))
        for stamp, row in zip(stamps, rows, strict=True):
            parts.append(message("D", struct.pack(f"<HQQ{len(row)}f", number, stamp + 3000, stamp, *row)))
    path.write_bytes(b"".join(parts))
    return path


def px4(topics):
    """Topics of PX4 with the motion in its axes."""
    stamps = [5_000_000 + round(1e6 * t) for t in TIME]
    turned = quaternions(DOWN * ATTITUDE * DOWN)
    known = {
        "sensor_combined": ("float[3] gyro_rad;float[3] accelerometer_m_s2", np.hstack([RATES, FORCE])),
        "vehicle_angular_velocity": ("float[3] xyz", RATES),
        "vehicle_acceleration": ("float[3] xyz", FORCE),
        "vehicle_local_position": (
            "float x;float y;float z;float vx;float vy;float vz",
            np.hstack([POSITION, VELOCITY]),
        ),
        "vehicle_attitude": ("float[4] q", turned),
        "vehicle_visual_odometry": ("float[3] position;float[4] q;float[3] velocity", None),
    }
    flipped = {name: (f, None if rows is None else rows.copy()) for name, (f, rows) in known.items()}
    for name, (_, rows) in flipped.items():
        if name != "vehicle_attitude" and rows is not None:
            rows[:] = np.hstack([DOWN.apply(part) for part in np.split(rows, rows.shape[1] // 3, axis=1)])
    visual = np.hstack([DOWN.apply(POSITION), turned, np.full((len(TIME), 3), np.nan)])
    flipped["vehicle_visual_odometry"] = (known["vehicle_visual_odometry"][0], visual)
    return {name: (flipped[name][0], stamps, flipped[name][1]) for name in topics}


@pytest.mark.parametrize(
    "topics",
    [
        ("sensor_combined", "vehicle_local_position", "vehicle_attitude"),
        ("vehicle_angular_velocity", "vehicle_acceleration", "vehicle_visual_odometry", "vehicle_local_position"),
    ],
)
def test_a_ulog_is_read_in_our_axes_whichever_topics_it_has(topics, tmp_path):
    pytest.importorskip("pyulog")
    log = tl.read_log(ulog_of(tmp_path / "flight.ulg", px4(topics)))
    expected = dict(zip((*IMU, *MOTION[:2]), (FORCE, RATES, POSITION, VELOCITY), strict=True))
    for name, values in expected.items():
        assert log[name].values == pytest.approx(values, abs=1e-6)
        assert log[name].time == pytest.approx(TIME, abs=1e-9)
    assert same_attitude(log[MOTION[2]].values)


def test_a_ulog_without_our_topics_or_damaged_is_refused_by_name(tmp_path):
    pytest.importorskip("pyulog")
    other = ulog_of(tmp_path / "other.ulg", {"battery_status": ("float v", [1, 2], [[1.0], [2.0]])})
    with pytest.raises(tl.InputError, match=r"no samples for .* in .*; it has battery_status"):
        tl.read_log(other)
    with pytest.raises(tl.InputError, match=r"has no column|unknown column 'speed'"):
        tl.read_log(
            other, {"measured_rates": {"topic": "battery_status", "columns": ["speed"] * 3, "time": "timestamp"}}
        )
    (tmp_path / "no.ulg").write_bytes(b"nothing")
    with pytest.raises(tl.InputError, match="cannot be read as a ULog"):
        tl.read_log(tmp_path / "no.ulg")


def test_a_ulog_of_a_flight_makes_the_shadow_command_what_was_flown(tmp_path):
    """With the map of docs/how-to/coming-from-autopilots.md: rotors as fractions, joints from `debug_array`."""
    pytest.importorskip("pyulog")
    mission = tl.load_mission("iris", {"mission.duration": 12.0, "mission.log_interval": 0.001})
    log = log_of(tl.fly(mission))
    imu, motion, joints = log[IMU[0]].time, log[MOTION[0]].time, log[JOINTS[0]].time
    weight, largest = 3.5 * 9.81, 5.84e-6 * 1100.0**2
    turned = quaternions(DOWN * Rotation.from_quat(log[MOTION[2]].values, scalar_first=True) * DOWN)
    down = {name: DOWN.apply(log[name].values) for name in (*IMU, *MOTION[:2])}
    loads = np.hstack([log[name].values for name in JOINTS])
    topics = {
        "sensor_combined": (
            "float[3] gyro_rad;float[3] accelerometer_m_s2",
            imu,
            np.hstack([down[n] for n in IMU[::-1]]),
        ),
        "vehicle_local_position": (
            "float x;float y;float z;float vx;float vy;float vz",
            motion,
            np.hstack([down[n] for n in MOTION[:2]]),
        ),
        "vehicle_attitude": ("float[4] q", motion, turned),
        "actuator_motors": ("float[12] control", log["rotor_commands"].time, log["rotor_commands"].values / largest),
        "debug_array": ("float[58] data", joints, loads),
    }
    for name, width in (("actuator_motors", 12), ("debug_array", 58)):
        fields, time, rows = topics[name]
        topics[name] = fields, time, np.pad(rows, ((0, 0), (0, width - rows.shape[1])))
    stamped = {name: (f, [5_000_000 + round(1e6 * t) for t in time], rows) for name, (f, time, rows) in topics.items()}
    text = (Path(__file__).parents[3] / "docs" / "how-to" / "coming-from-autopilots.md").read_text("utf-8")
    (tmp_path / "map.toml").write_text(re.search(r"<!-- map.toml -->\n```toml\n(.*?)```", text, re.S)[1], "utf-8")
    shadow = tl.shadow(tl.read_log(ulog_of(tmp_path / "flight.ulg", stamped), tmp_path / "map.toml"), mission)
    hover = (shadow.time > 9.0) & (shadow.time < 12.0)
    thrusts, flown = shadow["rotor_commands"][hover], shadow["flown_rotor_commands"][hover]
    assert thrusts == pytest.approx(flown, abs=5e-3)  # N
    assert thrusts.sum(axis=1).mean() == pytest.approx(weight, rel=0.01)  # less ground effect


def test_a_topic_that_ends_early_or_has_a_gap_is_not_held_beside_another_one(tmp_path):
    stamps = 1_000_000 + 5000 * np.arange(200)
    second = stamps[(np.arange(200) < 50) | (np.arange(200) > 70)][:-60] + 1000
    topics = {n: ("float x", at.tolist(), 1e-6 * at[:, None]) for n, at in (("left", stamps), ("right", second))}
    columns = {"measured_joint_force": {"topic": ["left", "right"], "columns": ["x", "x", "x"]}}
    time, values = tl.read_log(ulog_of(tmp_path / "joints.ulg", topics), columns)["measured_joint_force"]
    assert values == pytest.approx(np.tile(1.0 + 5e-3 + time[:, None], 6), abs=1e-5)
    assert np.round(time / 5e-3).tolist() == [*range(49), *range(71, 139)]


# ---- bags, written by rosbags


def messages_of(store, names):
    """Messages (topic, type, stamp [ns], message): IMU, odometry, and two joints, the second half a sample later."""
    T = store.types

    def header(at):
        stamp = T["builtin_interfaces/msg/Time"](*divmod(EPOCH + round(1e9 * at), 10**9))
        number = (0,) if "seq" in T["std_msgs/msg/Header"].__annotations__ else ()
        return T["std_msgs/msg/Header"](*number, stamp, "")

    def vector(values, kind="Vector3"):
        return T[f"geometry_msgs/msg/{kind}"](*map(float, values))

    def quaternion(q):
        return T["geometry_msgs/msg/Quaternion"](*map(float, q[[1, 2, 3, 0]]))

    nine, many = np.zeros(9), np.zeros(36)
    for k, at in enumerate(TIME):
        turned, stamp = quaternions(ATTITUDE)[k], header(at)
        yield (
            names[0],
            T["sensor_msgs/msg/Imu"](stamp, quaternion(turned), nine, vector(RATES[k]), nine, vector(FORCE[k]), nine),
        )
        pose = T["geometry_msgs/msg/Pose"](vector(POSITION[k], "Point"), quaternion(turned))
        twist = T["geometry_msgs/msg/Twist"](vector(ATTITUDE[k].inv().apply(VELOCITY[k])), vector(RATES[k]))
        yield (
            names[1],
            T["nav_msgs/msg/Odometry"](
                stamp,
                "",
                T["geometry_msgs/msg/PoseWithCovariance"](pose, many),
                T["geometry_msgs/msg/TwistWithCovariance"](twist, many),
            ),
        )
        for i, late in enumerate((0.0, 0.0025)):
            felt = 100.0 * i + LINEAR[k] + np.arange(1.0, 7.0) * 10.0 * late
            wrench = T["geometry_msgs/msg/Wrench"](vector(felt[:3]), vector(felt[3:]))
            yield names[2 + i], T["geometry_msgs/msg/WrenchStamped"](header(at + late), wrench)


OURS = ("measured/imu", "measured/odometry", "joint_1/measured", "joint_2/measured")
OTHERS = ("/mavros/imu/data", "/vrpn/odom", "/ft_left", "/ft_right")


def mcap_of(folder, names):
    store = get_typestore(Stores.ROS2_HUMBLE)
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connections = {}
        for topic, message in messages_of(store, names):
            kind = message.__msgtype__
            connections.setdefault(topic, None)
            connections[topic] = connections[topic] or writer.add_connection(topic, kind, typestore=store)
            stamp = message.header.stamp
            arrival = stamp.sec * 10**9 + stamp.nanosec + 7_000_000  # messages arrive late; their stamps count
            writer.write(connections[topic], arrival, store.serialize_cdr(message, kind))
    return folder


def ros1_of(path, names):
    store = get_typestore(Stores.ROS1_NOETIC)
    with Writer1(path) as writer:
        connections = {}
        for topic, message in messages_of(store, names):
            kind = message.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            stamp = message.header.stamp
            writer.write(connections[topic], stamp.sec * 10**9 + stamp.nanosec, store.serialize_ros1(message, kind))
    return path


def holds_the_motion(log):
    for name, values in zip((*IMU, *MOTION[:2]), (FORCE, RATES, POSITION, VELOCITY), strict=True):
        assert log[name].values == pytest.approx(values, abs=1e-9)
        assert log[name].time == pytest.approx(TIME, abs=1e-9)
    assert same_attitude(log[MOTION[2]].values)
    felt = LINEAR[1:]  # the second joint begins after the first
    assert log[JOINTS[0]].time == pytest.approx(TIME[1:])
    assert log[JOINTS[0]].values == pytest.approx(np.hstack([felt[:, :3], 100.0 + felt[:, :3]]))
    assert log[JOINTS[1]].values == pytest.approx(np.hstack([felt[:, 3:], 100.0 + felt[:, 3:]]))


def test_bags_of_a_vehicle_with_our_topics_are_read_by_their_stamps(tmp_path):
    names = [f"/tandemlift/{name}" for name in OURS]
    folder = mcap_of(tmp_path / "flight", names)
    holds_the_motion(tl.read_log(folder))
    holds_the_motion(tl.read_log(next(folder.glob("*.mcap"))))
    holds_the_motion(tl.read_log(ros1_of(tmp_path / "flight.bag", names)))


MAP = """
[measured_rates]
topic = "/mavros/imu/data"
columns = ["angular_velocity.x", "angular_velocity.y", "angular_velocity.z"]
[measured_specific_force]
topic = "/mavros/imu/data"
columns = ["linear_acceleration.x", "linear_acceleration.y", "linear_acceleration.z"]
[measured_position]
topic = "/vrpn/odom"
columns = ["pose.pose.position.x", "pose.pose.position.y", "pose.pose.position.z"]
[measured_velocity]
topic = "/vrpn/odom"
columns = ["twist.twist.linear.x", "twist.twist.linear.y", "twist.twist.linear.z"]
frame = "body"
[measured_attitude]
topic = "/vrpn/odom"
columns = ["pose.pose.orientation.w", "pose.pose.orientation.x", "pose.pose.orientation.y", "pose.pose.orientation.z"]
[measured_joint_force]
topic = ["/ft_left", "/ft_right"]
columns = ["wrench.force.x", "wrench.force.y", "wrench.force.z"]
[measured_joint_torque]
topic = ["/ft_left", "/ft_right"]
columns = ["wrench.torque.x", "wrench.torque.y", "wrench.torque.z"]
"""


def test_a_map_names_other_topics_and_a_missing_one_is_named(tmp_path):
    folder = mcap_of(tmp_path / "flight", OTHERS)
    (tmp_path / "map.toml").write_text(MAP, "utf-8-sig")  # as editors of Windows do
    holds_the_motion(tl.read_log(folder, tmp_path / "map.toml"))
    with pytest.raises(
        tl.InputError, match=r"no samples for .* in /tandemlift/.*; it has /ft_left, /ft_right, /mavros"
    ):
        tl.read_log(folder)
    wrong = {"measured_rates": {"topic": "/imu", "columns": ["angular_velocity.x"] * 3}}
    with pytest.raises(tl.InputError, match="no samples for measured_rates in /imu; it has /ft_left"):
        tl.read_log(folder, wrong)
    wrong["measured_rates"] = {"topic": "/mavros/imu/data", "columns": ["gyro.x"] * 3}
    with pytest.raises(tl.InputError, match=r"unknown column 'gyro.x'; there are time, header, .*angular_velocity"):
        tl.read_log(folder, wrong)


# ---- tables, written by pandas


@pytest.fixture
def table(tmp_path):
    """Rates in deg/s at every row, a pose at every fourth one, with z down and the quaternion as x, y, z, w."""
    columns = {"ms": 1e3 * TIME + 250.0} | dict(zip("pqr", np.degrees(RATES).T, strict=True))
    frame = pandas.DataFrame(columns)
    rows = np.arange(len(TIME)) % 4 == 0
    for name, v in zip(("X", "Y", "Z"), (POSITION * [1.0, 1.0, -1.0]).T, strict=True):
        frame[name] = np.where(rows, v, np.nan)
    for name, v in zip(("qx", "qy", "qz", "qw"), quaternions(ATTITUDE)[:, [1, 2, 3, 0]].T, strict=True):
        frame[name] = np.where(rows, v, np.nan)
    path = tmp_path / "flight.csv"
    pandas.concat([frame, frame[-1:]]).to_csv(path, index=False)  # the last stamp comes twice
    return path


COLUMNS = {
    "time": "ms",
    "time_unit": "ms",
    "measured_rates": {"columns": ["p", "q", "r"], "unit": "deg/s"},
    "measured_position": {"columns": ["X", "Y", "Z"], "scale": [1, 1, -1]},
    "measured_attitude": {"columns": ["qw", "qx", "qy", "qz"]},
}


def test_a_table_is_read_by_its_map_each_stream_at_its_own_rate(table):
    log = tl.read_log(table, COLUMNS)
    assert log["measured_rates"].values == pytest.approx(RATES, abs=1e-12)
    assert log["measured_rates"].time == pytest.approx(TIME, abs=1e-12)
    assert log[MOTION[0]].values == pytest.approx(POSITION[::4], abs=1e-12)
    assert log[MOTION[0]].time == pytest.approx(TIME[::4], abs=1e-12)
    assert {name: round(log.rate(name)) for name in log} == {n: 200 if n == IMU[1] else 50 for n in log}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"measured_rates": {"columns": ["p", "q", "R"]}},
            "stream measured_rates: .*unknown column 'R'; .* Did you mean",
        ),
        ({"measured_rates": {"columns": ["p", "q"]}}, "has 2 columns: must have 3"),
        ({"measured_rates": {"unit": "deg/s"}}, r"measured_rates\.columns is missing"),
        ({"measured_rates": {"columns": ["p"], "units": "deg"}}, r"measured_rates\.units = .*Did you mean \S+unit\?"),
        ({"measured_rates": {"columns": ["p"], "unit": "deg/min"}}, 'measured_rates.unit = "deg/min": must be one of'),
        ({"measured_position": {"columns": ["p"], "unit": "deg/s"}}, "unit = .*: must be one of m, mm, cm, in, ft, 1"),
        ({"measured_rates": {"columns": ["p"], "unit": ["deg/s"]}}, r"measured_rates\.unit = .*: must be text"),
        (
            {"measured_rates": {"columns": ["p"], "scale": "2"}},
            r'\.scale = "2": must be a number or a list',
        ),
        ({"measured_rates": {"columns": "pqr"}}, r'measured_rates\.columns = "pqr": must be a list'),
        ({"time": 5}, r"measured_rates\.time = 5: must be text"),
        ({"gyro": {"columns": ["p"]}}, "unknown stream 'gyro'"),
        ({"measured_position": {"columns": ["X", "Y", "Z"], "scale": [1, -1]}}, "scale has 2 numbers for 3 columns"),
        ({"time": "t"}, "unknown column 't'"),
    ],
)
def test_a_map_that_does_not_fit_is_refused_with_what_is_there(table, change, message):
    with pytest.raises(tl.InputError, match=message):
        tl.read_log(table, COLUMNS | change)


def test_what_is_no_table_or_no_log_is_refused(table, tmp_path):
    with pytest.raises(tl.InputError, match="needs a map"):
        tl.read_log(table)
    table.write_text("ms,p,q,r\n1,2,3,4\n3,four,3,4\n")
    with pytest.raises(tl.InputError, match="line 3: could not convert string to float: 'four'"):
        tl.read_log(table, COLUMNS)
    table.write_text("ms,p\n1,2\n3\n")
    with pytest.raises(tl.InputError, match="line 3 has 1 cells, the line of names 2"):
        tl.read_log(table, COLUMNS)
    with pytest.raises(tl.InputError, match=r"must be a flight \(.npz\), a bag"):
        tl.read_log(tmp_path / "flight.doc")
    (tmp_path / "map.toml").write_text("no toml")
    with pytest.raises(tl.InputError, match=r"map\.toml: "):
        tl.read_log(table, tmp_path / "map.toml")


# ---- our own flights


@pytest.mark.thorough
def test_our_own_flight_is_the_same_log_from_its_file_and_from_its_bag(tmp_path):
    flight = tl.fly(tl.load_mission("iris", {"mission.duration": 0.3, "mission.log_interval": 0.001}))
    log = log_of(flight)
    for path in (flight.save(tmp_path / "flight.npz"), export(flight, tmp_path / "flight.mcap")):
        read = tl.read_log(path)
        assert {*read} == {*log}
        for name in log:
            assert read[name].time == pytest.approx(log[name].time, abs=1e-9)
            assert read[name].values == pytest.approx(log[name].values, abs=1e-9), name


def test_a_table_with_two_columns_of_one_name_is_refused(tmp_path):
    (tmp_path / "twice.csv").write_text("ms,p,q, p,r,s,s\n1,2,3,4,5,6,7\n", "utf-8")
    with pytest.raises(tl.InputError, match="has 2 columns p: one that is read must have its own name"):
        tl.read_log(tmp_path / "twice.csv", COLUMNS)
    rates = {"time": "ms", "measured_rates": {"columns": ["q", "r", "q"]}}
    assert tl.read_log(tmp_path / "twice.csv", rates)["measured_rates"].values.tolist() == [[3.0, 5.0, 3.0]]
