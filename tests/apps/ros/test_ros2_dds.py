"""ROS 2's topics on the wire, read and written by Fast DDS, which most of ROS 2 speaks; and its types."""

import dataclasses
import os
from pathlib import Path

import numpy as np
import pytest
from exported import flight_of
from patience import completed, ended, until
from repository import SUPPORT
from ros_processes import node
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation

from tandemlift.flight.record import Flight

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed")

from tandemlift.apps.export.messages import MessageTypes, message_maker, modern
from tandemlift.apps.export.topics import topics_from
from tandemlift.apps.ros.dds_types import DdsTypes
from tandemlift.apps.ros.ros2 import LOG, ROSOUT, WARN, Ros2, _domain, _qos, _value
from tandemlift.parts.mechanics.vehicle import Vehicle

COUNT = 300
KINDS = [
    *("nav_msgs/Odometry", "nav_msgs/Path", "geometry_msgs/WrenchStamped", "sensor_msgs/JointState", "sensor_msgs/Imu"),
    *("tf2_msgs/TFMessage", "diagnostic_msgs/DiagnosticArray", "visualization_msgs/MarkerArray", "std_msgs/String"),
    "rcl_interfaces/Log",
]


@pytest.fixture(scope="module")
def types():
    return MessageTypes(DdsTypes(), numbered=False)


def filled(types, kind, definitions, numbers):
    """A message with another value in every field, and two of each sequence."""

    def value(about):
        what = about[1]
        if about[0] == 1:
            number = next(numbers)
            odd = {"bool": bool(number % 2), "string": f"word {number}", "byte": number % 3, "uint8": number % 200}
            return odd.get(what[0], number * 0.5 if what[0].startswith("float") else number)
        if about[0] == 2:
            return filled(types, what, definitions, numbers)
        return [value(what[0]) for _ in range(what[1] if about[0] == 3 else 2)]

    fields = definitions[kind][1]
    old = kind.replace("/msg/", "/")
    return types[old](*(value(about) for _, about in fields))


def plain(message, like):
    """Its leaves, in their order; fields are those of `like`, a message of DDS."""
    if dataclasses.is_dataclass(like):
        names = [field.name for field in dataclasses.fields(like)]
        return [leaf for name in names for leaf in plain(getattr(message, name), getattr(like, name))]
    if isinstance(like, list):
        return [leaf for one, other in zip(message, like, strict=True) for leaf in plain(one, other)]
    return [message]


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_on_the_wire_is_what_another_reader_of_cdr_reads(types, kind):
    store = get_typestore(Stores.ROS2_HUMBLE)
    message = filled(types, modern(kind), store.fielddefs, iter(range(1, 10_000)))
    wire = message.serialize(use_version_2=False)
    assert bytes(wire[:4]) == b"\x00\x01\x00\x00", "XCDR1, little endian"
    assert plain(store.deserialize_cdr(wire, modern(kind)), message) == plain(message, message)
    package, name = kind.split("/")
    assert type(message).__idl_typename__.replace(".", "::") == f"{package}::msg::dds_::{name}_"


def test_every_topic_of_a_flight_can_be_put_on_the_wire(types):
    flight, store = flight_of("iris"), get_typestore(Stores.ROS2_HUMBLE)
    bag = MessageTypes(lambda name: store.types[modern(name)], numbered=False, numbers=np.array)
    for topic in topics_from(flight, Vehicle.from_mission(flight.mission)):
        row = topic.rows[7].tolist()
        message, other = (message_maker(one, topic)(5, row) for one in (types, bag))
        wire = message.serialize(use_version_2=False)
        assert bytes(wire) == bytes(store.serialize_cdr(other, modern(topic.kind))), topic.name


def test_what_is_not_given_is_zero(types):
    marker = types["visualization_msgs/Marker"](ns="x")
    assert (marker.ns, marker.id, marker.points, marker.lifetime.sec, marker.frame_locked) == ("x", 0, [], 0, False)


@pytest.mark.parametrize(
    ("text", "value"), [("2", 2), ("[1, 2.5]", [1, 2.5]), ("pid", "pid"), ("x = 1", "x = 1"), ("1\ny = 2", 1)]
)
def test_a_parameter_s_text_is_a_value_as_in_a_mission_or_a_word(text, value):
    assert _value(text) == value


def test_the_domain_is_ros_s_own(monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "42")
    assert _domain() == 42
    monkeypatch.setenv("ROS_DOMAIN_ID", "x")
    with pytest.raises(ValueError, match="must be a whole number from 0 to 232"):
        _domain()


def test_an_event_is_in_ros_s_log(types):
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic

    ros, other = Ros2(domain=97), DomainParticipant(97)
    reader = DataReader(other, Topic(other, f"rt{ROSOUT}", types[LOG]), _qos(True, 1))
    words, found = "Lift is refused: the vehicle is in the air already.", []
    ros.log(words)
    until(lambda: found.extend(reader.take(1)) or found, "the log's message")
    ros.shutdown()
    assert (found[0].name, found[0].msg, found[0].level) == ("tandemlift", words, WARN)
    assert found[0].stamp.sec > 0


def test_a_topic_announces_the_name_of_its_type_and_no_type_information(types):
    from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.sub import DataReader
    from cyclonedds.topic import Topic

    ros, other, kind = Ros2(domain=98), DomainParticipant(98), "nav_msgs/Odometry"
    publisher = ros.advertise("/pose", kind)
    reader = DataReader(other, Topic(other, "rt/pose", types[kind]), _qos(False, 10))
    endpoints, seen, found = BuiltinDataReader(other, BuiltinTopicDcpsPublication), [], []
    until(lambda: seen.extend(e for e in endpoints.take(100) if e.topic_name == "rt/pose") or seen, "the topic")
    until(lambda: publisher.wanted, "the reader")
    message = types[kind](child_frame_id="base_link")
    message.pose.covariance[7] = 0.25
    publisher.publish(message)
    until(lambda: found.extend(reader.take(1)) or found, "the message")
    ros.shutdown()
    assert (seen[0].type_name, seen[0].type_id) == ("nav_msgs::msg::dds_::Odometry_", None)
    assert found == [message]


# beside Fast DDS


SCRIPT = f"""
read {COUNT} then push base_world 1.5 0 0 4 then push mars 1.5 0 0 0.1 then read 1
then request lift then request dance then set admittance.mass 4 then request land then mission
"""


@pytest.fixture(scope="module")
def peer(tmp_path_factory, program):
    """The program of a Fast DDS user."""
    made, source = tmp_path_factory.mktemp("peer") / "peer", SUPPORT / "dds_peer.cpp"
    compiler = program("g++")
    if not Path("/usr/include/fastdds").is_dir():
        pytest.skip("libfastrtps-dev and libfastcdr-dev are not installed")
    completed([compiler, "-std=c++17", "-O1", str(source), "-o", str(made), "-lfastrtps", "-lfastcdr"], check=True)
    return made


@pytest.fixture(scope="module")
def tried(peer, tmp_path_factory):
    """What a user of Fast DDS saw, verb by verb, and the flight that came of it."""
    folder, domain = tmp_path_factory.mktemp("ros2"), str(100 + os.getpid() % 100)
    options = ("--version", "2", "--save", str(folder / "saved"))
    flying = node(folder / "node.log", *options, environment=os.environ | {"ROS_DOMAIN_ID": domain})
    try:
        done = completed([str(peer), domain, *SCRIPT.split()], capture_output=True, text=True)
    finally:
        assert ended(flying) == 0, (folder / "node.log").read_text("utf-8")
    assert done.returncode == 0, (done.stderr, done.stdout[-2000:])
    verbs = [part.splitlines() for part in done.stdout.split("# ")[1:]]
    return [[verb, *lines] for verb, *lines in verbs], Flight.load(folder / "saved" / "flight.npz")


def seen(tried, verb):
    """The lines of each time that a verb was said."""
    return [lines for name, *lines in tried[0] if name == verb]


@pytest.mark.ros
def test_fast_dds_reads_every_message_with_the_flight_s_numbers(tried):
    rows, flight = [line.split() for line in seen(tried, "read")[0]], tried[1]
    assert {tuple(row[1:3]) for row in rows} == {("world", "base_link")}
    assert np.all(np.diff([int(row[0]) for row in rows]) >= 10_000_000)
    numbers = np.array([[float(n) for n in row[3:]] for row in rows])
    samples = [np.flatnonzero((flight["position"] == place).all(axis=1))[0] for place in numbers[:, :3]]
    assert np.all(np.diff(samples) >= 0), "a busy machine loses some on the way"
    assert np.array_equal(numbers[:, [6, 3, 4, 5]], flight["attitude"][samples])
    turned = Rotation.from_quat(flight["attitude"][samples], scalar_first=True)
    assert turned.apply(numbers[:, 7:10]) == pytest.approx(flight["velocity"][samples], abs=1e-14)
    assert np.array_equal(numbers[:, 10:], flight["rates"][samples])


@pytest.mark.ros
def test_a_push_by_fast_dds_moves_the_beam(tried):
    before, after = (float(lines[-1].split()[3]) for lines in seen(tried, "read"))
    assert after - before > 0.1
    assert tried[1]["push_force"][:, 0].max() == pytest.approx(1.5, abs=0.01)


@pytest.mark.ros
def test_requests_are_answered_and_settings_are_heeded(tried):
    (lift,), (dance,), (land,) = seen(tried, "request")
    assert lift.startswith("refused: Lift is refused: the vehicle is in the air already.")
    assert dance == "refused: unknown request 'dance'; there are lift, land, stop, tare."
    assert land == "done: land"
    assert "mass = [4.0, 4.0, 4.0]" in " ".join(seen(tried, "mission")[0])
