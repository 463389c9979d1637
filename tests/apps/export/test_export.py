"""Bags of flights, read back by others: ROS 2 bags by MCAP's own reader, ROS 1 bags by ROS itself."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from exported import SAMPLES, flight_of, mcap_of, numbers, stamps, xyz
from patience import completed
from reference_tables.topics import other_topics, topics_of_every_flight, topics_of_some_flights
from repository import SUPPORT
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.apps.export.write import export
from tandemlift.missions import tables_of

MD5 = {  # as ROS Noetic's own packages have them
    "diagnostic_msgs/DiagnosticArray": "60810da900de1dd6ddd437c3503511da",
    "geometry_msgs/PointStamped": "c63aecb41bfdfd6b7e1fac37c7cbe7bf",
    "geometry_msgs/PoseStamped": "d3812c3cbc69362b77dc0b19b345f8f5",
    "geometry_msgs/Vector3Stamped": "7b324c7325e683bf02a9b14b01090ec7",
    "geometry_msgs/WrenchStamped": "d78d3cb249ce23087ade7e7d0c40cfa7",
    "nav_msgs/Odometry": "cd5e73d190d741a2f92e81eda573aca7",
    "sensor_msgs/Imu": "6a62c6daae103f4ff57a132d6f95cec2",
    "sensor_msgs/JointState": "3066dcd76a6cfaef579bd0f34173e9fd",
    "std_msgs/String": "992ce8a1687cec8c8bd883ec73ca41d1",
    "tf2_msgs/TFMessage": "94810edda583a504dfda3829e70d7eec",
}


@pytest.fixture(scope="module")
def ros1(program):
    """ROS 1's own reader, by the Python that it belongs to: what it reads of a bag, as `mcap_of`."""
    python = Path(program("rosbag")).read_text("utf-8").splitlines()[0].removeprefix("#!").strip()
    script = SUPPORT / "messages_as_numbers.py"

    def read(path):
        done = completed([*python.split(), str(script), str(path)], capture_output=True, check=True, text=True)
        found = {}
        for line in done.stdout.splitlines():
            topic, kind, time, leaves = json.loads(line)
            found.setdefault(topic, []).append((kind, time, leaves))
        return found

    return read


@pytest.fixture(scope="module", params=["mcap", "bag"])
def read(request, flight, folder):
    """The messages of the flight's export to each kind of bag, with types as ROS 1 calls them."""
    path = export(flight, folder / f"flight.{request.param}")
    found = request.getfixturevalue("ros1")(path) if request.param == "bag" else mcap_of(path)
    return {topic: [(k.replace("/msg/", "/"), t, v) for k, t, v in all_of] for topic, all_of in found.items()}


def turned(flight, name, by="attitude", inverse=False):
    """Vectors of a channel turned from body to world axes, or the other way."""
    q = flight[by]
    good = np.isfinite(q).all(axis=1)
    result = np.full((len(q), 3), np.nan)
    result[good] = Rotation.from_quat(q[good], scalar_first=True).apply(flight[name][good], inverse=inverse)
    return result


ODOMETRY, IMU, POSE = "nav_msgs/Odometry", "sensor_msgs/Imu", "geometry_msgs/PoseStamped"
VECTOR, POINT = "geometry_msgs/Vector3Stamped", "geometry_msgs/PointStamped"
WRENCH, ROTORS = "geometry_msgs/WrenchStamped", "sensor_msgs/JointState"
PLACE, TURN = "pose.pose.position", "twist.twist.angular"
COPIED = {  # topic: type, frame, {where in the message: channel}
    "odometry": (ODOMETRY, "world", {PLACE: "position", TURN: "rates"}),
    "estimated/odometry": (ODOMETRY, "world", {PLACE: "estimated_position", TURN: "estimated_rates"}),
    "measured/odometry": (ODOMETRY, "world", {PLACE: "measured_position"}),
    "measured/imu": (
        IMU,
        "payload",
        {"angular_velocity": "measured_rates", "linear_acceleration": "measured_specific_force"},
    ),
    "reference/pose": (POSE, "world", {"pose.position": "reference_position"}),
    "reference/velocity": (VECTOR, "world", {"vector": "reference_velocity"}),
    "reference/acceleration": (VECTOR, "world", {"vector": "reference_acceleration"}),
    "admittance/position": (POINT, "world", {"point": "admittance_position"}),
    "admittance/velocity": (VECTOR, "world", {"vector": "admittance_velocity"}),
    "admittance/acceleration": (VECTOR, "world", {"vector": "admittance_acceleration"}),
    "wind/velocity": (VECTOR, "world", {"vector": "wind_velocity"}),
    "command/wrench": (WRENCH, "base_link", {"wrench.torque": "moment"}),
    "command/allocated": (WRENCH, "base_link", {"wrench.torque": "allocated_moment"}),
    "push/true": (WRENCH, "base_world", {"wrench.force": "push_force"}),
    "push/gated": (WRENCH, "base_world", {"wrench.force": "admittance_force"}),
    "push/measured": (WRENCH, "base_world", {"wrench.force": "push_measured"}),
    "push/estimated": (WRENCH, "base_world", {"wrench.force": "push_estimate"}),
    "push/filtered": (WRENCH, "base_world", {"wrench.force": "push_filtered"}),
    "disturbance": (WRENCH, "base_world", {"wrench.force": "disturbance_force"}),
    "wind/force": (WRENCH, "base_world", {"wrench.force": "wind_force"}),
    "contact/force": (WRENCH, "base_world", {"wrench.force": "contact_force"}),
}
OTHERS = {
    "push/point": (POINT, "payload"),
    "rotors/thrusts": (ROTORS, "base_link"),
    "rotors/commands": (ROTORS, "base_link"),
    "joint_1/wrench": (WRENCH, "joint_1"),
    "joint_2/wrench": (WRENCH, "joint_2"),
    "joint_1/measured": (WRENCH, "joint_1"),
    "joint_2/measured": (WRENCH, "joint_2"),
    "pilot": (ROTORS, ""),
}
ONCE = {"/tandemlift/mission": "std_msgs/String", "/tf_static": "tf2_msgs/TFMessage"}
STAMP = {  # topics of readings, and the channel with the times at which they were taken
    "measured/odometry": "motion_stamp",
    "measured/imu": "imu_stamp",
    "joint_1/measured": "joints_stamp",
    "joint_2/measured": "joints_stamp",
}
MOVING = {"/tf": "tf2_msgs/TFMessage", "/diagnostics": "diagnostic_msgs/DiagnosticArray"}


def sent(topic):
    """The rows of which a topic has messages: a reading that is held over two rows comes once."""
    return slice(None, None, 2 if topic == "measured/odometry" else 1)


def test_every_topic_is_there_with_its_type_and_frame_and_a_message_for_every_sample(read, flight):
    expected = {f"/tandemlift/{name}": value[:2] for name, value in {**COPIED, **OTHERS}.items()}
    assert set(read) == {*expected, *ONCE, *MOVING}
    for topic, (kind, frame) in expected.items():
        assert {(k, v["header.frame_id"]) for k, _, v in read[topic]} == {(kind, frame)}, topic
        assert len(read[topic]) == len(range(SAMPLES)[sent(topic.removeprefix("/tandemlift/"))])
    assert {topic: read[topic][0][0] for topic in (*ONCE, *MOVING)} == {**ONCE, **MOVING}
    assert [len(read[topic]) for topic in ONCE] == [1, 1]


def test_every_message_bears_the_time_of_its_sample_to_the_nanosecond(read, flight):
    for name in {**COPIED, **OTHERS}:
        messages, taken = read[f"/tandemlift/{name}"], flight[STAMP.get(name, "time")]
        assert [time for _, time, _ in messages] == stamps(flight.time[sent(name)])
        assert [v["header.stamp"] for _, _, v in messages] == stamps(taken[sent(name)])
    assert [time for _, time, _ in read["/tf"]] == stamps(flight.time)
    for i in range(2):
        assert [v[f"transforms.{i}.header.stamp"] for _, _, v in read["/tf"]] == stamps(flight.time)


def test_what_a_message_tells_as_a_channel_does_is_the_same_number(read, flight):
    for topic, (_, _, parts) in COPIED.items():
        for path, channel in parts.items():
            found = numbers(read[f"/tandemlift/{topic}"], *xyz(path))
            np.testing.assert_array_equal(found, flight[channel][sent(topic)])


@pytest.mark.parametrize("prefix", ["", "measured_", "estimated_"])
def test_odometry_has_the_attitude_and_its_velocity_in_body_axes(read, flight, prefix):
    messages = read["/tandemlift/" + (f"{prefix[:-1]}/odometry" if prefix else "odometry")]
    q, v = numbers(messages, *xyz("pose.pose.orientation", "w")), numbers(messages, *xyz("twist.twist.linear"))
    rows = sent("measured/odometry" if prefix == "measured_" else "")
    np.testing.assert_array_equal(q, np.roll(flight[f"{prefix}attitude"], -1, axis=1)[rows])
    expected = turned(flight, f"{prefix}velocity", f"{prefix}attitude", inverse=True)[rows]
    np.testing.assert_allclose(v, expected, rtol=0, atol=1e-14)
    assert {leaves["child_frame_id"] for _, _, leaves in messages} == {"base_link"}
    assert not numbers(messages, *(f"{p}.covariance.{i}" for p in ("pose", "twist") for i in range(36))).any()


def test_the_reference_is_turned_by_its_euler_angles(read, flight):
    q = numbers(read["/tandemlift/reference/pose"], *xyz("pose.orientation", "w"))
    roll, pitch, yaw = flight["reference_euler"].T
    expected = Rotation.from_euler("ZXY", np.stack([yaw, roll, pitch], axis=1))
    np.testing.assert_allclose((Rotation.from_quat(q) * expected.inv()).magnitude(), 0.0, atol=1e-14)


@pytest.mark.parametrize(("topic", "moment"), [("push/true", "push_moment"), ("disturbance", "disturbance_moment")])
def test_a_wrench_in_world_axes_has_its_moment_in_world_axes_too(read, flight, topic, moment):
    found = numbers(read[f"/tandemlift/{topic}"], *xyz("wrench.torque"))
    np.testing.assert_allclose(found, turned(flight, moment), rtol=0, atol=1e-14)


@pytest.mark.parametrize("topic", ["push/gated", "push/measured", "push/filtered", "wind/force", "contact/force"])
def test_a_force_alone_has_no_torque(read, topic):
    assert not numbers(read[f"/tandemlift/{topic}"], *xyz("wrench.torque")).any()


def center_of_mass(flight):
    """Of the vehicle, from the payload's, by its definition."""
    vehicle = flight.mission["vehicle"]
    parts = [(vehicle["payload"]["mass"], [0.0, 0.0, 0.0])]
    parts += [(q["mass"], q["position"]) for q in vehicle["quadrotors"]]
    return sum(m * np.array(at) for m, at in parts) / sum(m for m, _ in parts)


def test_the_estimated_push_has_the_moment_about_the_same_point_as_the_true_one(read, flight):
    found = numbers(read["/tandemlift/push/estimated"], *xyz("wrench.torque"))
    np.testing.assert_allclose(found, turned(flight, "push_moment_estimate"), rtol=0, atol=1e-14)


def test_the_point_of_the_push_is_on_the_beam(read, flight):
    found = numbers(read["/tandemlift/push/point"], *xyz("point"))
    zero = np.zeros(SAMPLES)
    np.testing.assert_array_equal(found, np.stack([zero, flight["push_point_estimate"], zero], axis=1))


@pytest.mark.parametrize(("topic", "channel"), [("wrench", "thrust"), ("allocated", "allocated_thrust")])
def test_a_thrust_is_a_force_along_body_z(read, flight, topic, channel):
    found = numbers(read[f"/tandemlift/command/{topic}"], *xyz("wrench.force"))
    zero = np.zeros(SAMPLES)
    np.testing.assert_array_equal(found, np.stack([zero, zero, flight[channel]], axis=1))


@pytest.mark.parametrize(("topic", "channel"), [("thrusts", "rotor_thrusts"), ("commands", "rotor_commands")])
def test_every_rotor_has_its_name_and_thrust(read, flight, topic, channel):
    messages = read[f"/tandemlift/rotors/{topic}"]
    names = [f"rotor_{quadrotor}_{rotor}" for quadrotor in (1, 2) for rotor in (1, 2, 3, 4)]
    assert {tuple(v[f"name.{i}"] for i in range(8)) for _, _, v in messages} == {tuple(names)}
    np.testing.assert_array_equal(numbers(messages, *(f"effort.{i}" for i in range(8))), flight[channel])


def test_what_the_pilot_knows_besides_bears_the_names_of_channels(read, flight):
    messages = read["/tandemlift/pilot"]
    names = [messages[0][2][f"name.{i}"] for i in range(sum(key.startswith("name.") for key in messages[0][2]))]
    assert {"phase", "push_active.x", "push_active.y", "push_active.z", "payload_mass_estimate", "alarm"} <= set(names)
    told = numbers(messages, *(f"position.{i}" for i in range(len(names))))
    for name, column in zip(names, told.T, strict=True):
        channel, _, axis = name.partition(".")
        number, _, direction = axis.rpartition(".")  # of a quadrotor, if each has its own
        column_of = 3 * (int(number or 1) - 1) + "xyz".index(direction or "x")
        own = flight[channel][:, column_of] if axis else flight[channel]
        np.testing.assert_array_equal(column, own)


@pytest.mark.parametrize(("topic", "prefix"), [("wrench", ""), ("measured", "measured_")])
def test_every_joint_has_its_wrench(read, flight, topic, prefix):
    for i in range(2):
        messages = read[f"/tandemlift/joint_{i + 1}/{topic}"]
        for part, channel in (("force", "joint_force"), ("torque", "joint_torque")):
            expected = flight[prefix + channel][:, 3 * i : 3 * i + 3]
            np.testing.assert_array_equal(numbers(messages, *xyz(f"wrench.{part}")), expected)


def test_the_motion_measurement_tells_that_it_reads_no_rates(read):
    assert np.isnan(numbers(read["/tandemlift/measured/odometry"], *xyz(TURN))).all()


def test_an_inertial_unit_tells_that_it_has_no_orientation(read):
    messages = read["/tandemlift/measured/imu"]
    assert set(numbers(messages, "orientation_covariance.0").ravel()) == {-1.0}


def test_the_vehicle_moves_in_the_tree_of_frames(read, flight):
    for i, child in enumerate(("base_link", "base_world")):
        at = f"transforms.{i}."
        named = {(v[f"{at}header.frame_id"], v[f"{at}child_frame_id"]) for _, _, v in read["/tf"]}
        assert named == {("world", child)}
        np.testing.assert_array_equal(numbers(read["/tf"], *xyz(f"{at}transform.translation")), flight["position"])
        q = np.roll(flight["attitude"], -1, axis=1) if i == 0 else np.tile([0.0, 0.0, 0.0, 1.0], (SAMPLES, 1))
        np.testing.assert_array_equal(numbers(read["/tf"], *xyz(f"{at}transform.rotation", "w")), q)


def test_payload_and_joints_are_fixed_where_the_mission_has_them(read, flight):
    ((_, time, leaves),) = read["/tf_static"]
    payload = -center_of_mass(flight)
    places = {"payload": payload}
    for i, quadrotor in enumerate(flight.mission["vehicle"]["quadrotors"], 1):
        x, y, _ = quadrotor["position"]
        places[f"joint_{i}"] = np.add(payload, [x, y, 0.0])
    assert time == 10**9
    for i, (name, place) in enumerate(places.items()):
        at = f"transforms.{i}."
        assert (leaves[f"{at}header.frame_id"], leaves[f"{at}child_frame_id"]) == ("base_link", name)
        np.testing.assert_allclose([leaves[p] for p in xyz(f"{at}transform.translation")], place, atol=1e-15)
        assert [leaves[p] for p in xyz(f"{at}transform.rotation", "w")] == [0.0, 0.0, 0.0, 1.0]


def test_what_happened_is_told_as_diagnostics_with_its_time_and_level(read):
    told = [(time, v["status.0.level"], v["status.0.message"]) for _, time, v in read["/diagnostics"]]
    ends = "diverged at 0.48 s: roll [deg] = 91, must be"
    assert [(t, lv if isinstance(lv, int) else lv[0], what) for t, lv, what in told] == [
        (1_000_000_000, 0, "idle"),
        (1_050_000_000, 1, "no lift: not level"),
        (1_100_000_000, 0, "lift"),
        (1_123_456_000, 2, "rotor failed -> land"),
        (1_480_000_000, 2, ends),
    ]


def test_the_mission_in_a_bag_flies_again(read, flight, tmp_path):
    ((_, _, leaves),) = read["/tandemlift/mission"]
    (tmp_path / "mission.toml").write_text(leaves["data"], "utf-8")
    assert tables_of(tl.load_mission(tmp_path / "mission.toml")) == flight.mission


def test_ros_knows_the_message_types_of_a_ros_1_bag(flight, folder, program):
    path = export(flight, folder / "types.bag")
    info = completed([program("rosbag"), "info", str(path)], capture_output=True, check=True, text=True).stdout
    assert dict(re.findall(r"(\w+/\w+) +\[(\w{32})\]", info)) == MD5
    assert re.search(r"compression: +lz4", info)


def test_a_flight_of_four_quadrotors_has_all_its_joints_and_rotors(folder):
    four = flight_of("four")
    read = mcap_of(export(four, folder / "four.mcap"))
    found = numbers(read["/tandemlift/rotors/thrusts"], *(f"effort.{i}" for i in range(16)))
    np.testing.assert_array_equal(found, four["rotor_thrusts"])
    last = numbers(read["/tandemlift/joint_4/measured"], *xyz("wrench.torque"))
    np.testing.assert_array_equal(last, four["measured_joint_torque"][:, 9:])


def test_phases_are_told_without_a_supervision_too(folder):
    read = mcap_of(export(flight_of("iris"), folder / "phases.mcap"))
    told = [(time, v["status.0.message"]) for _, time, v in read["/diagnostics"]]
    times = stamps(np.arange(4) * 10 * 0.0123)
    assert told == list(zip(times, ["idle", "lift", "hold", "guided"], strict=True))


def test_the_reference_has_every_topic_with_its_type_and_frame():
    tables = topics_of_every_flight() + topics_of_some_flights() + other_topics()
    for name, (kind, frame, *_) in {**COPIED, **OTHERS}.items():
        if "joint_2" not in name:
            row = f"| `{name}` | `{kind}`{frame and f', `{frame}`'} |".replace("joint_1", "joint_N")
            assert row in tables, name
    for name, kind in {**ONCE, **MOVING}.items():
        assert f"| `{name}` | `{kind}`" in tables, name
