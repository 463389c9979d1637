"""The plugin that is led over ROS 1: pilots that die, are late, doubled or plain; the topics that ROS's tools read."""

import itertools
import os
import random
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from patience import ended, said, until
from repository import ROOT as REPOSITORY

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import Quat
from tandemlift.engines.gazebo_ros import ROOT
from tandemlift.engines.rospy import message_type, node
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

from .conftest import SILENT_OVER_ROS, fly

pytestmark = [pytest.mark.gazebo, pytest.mark.filterwarnings("ignore")]  # rospy is of another age
DOCS = REPOSITORY / "docs/how-to/ros.md"
FIND = "import sys, threading; sys.path += sys.argv[1:]; threading.Thread.isAlive = threading.Thread.is_alive\n"
PILOT = """
from tandemlift.engines.gazebo_ros import RosWire
wire = RosWire(2)
wire.hello(1e-3, [], [0, 0, 5, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0])
wire.thrusts[:] = {thrust!r}
print("flying", flush=True)
while True:
    wire.advance()
"""


def check_plain_pilot():
    """The pilot in plain rospy that the documentation shows."""
    (code,) = re.findall(r"```python\n(import rospy\n.*?)```", DOCS.read_text("utf-8"), re.DOTALL)
    assert "tandemlift." not in code
    assert len([line for line in code.splitlines() if line]) <= 10
    return code


@pytest.fixture
def another():
    """Starts Python code as a node of its own, in a process of its own, that is killed after the test."""
    started = []

    def start(code):
        folder = str(Path(node().__file__).parents[1])
        with_master = os.environ | {"TANDEMLIFT_GAZEBO_ROS": "world"}
        command = [sys.executable, "-c", FIND + code, folder]
        started.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=with_master))
        return started[-1]

    yield start
    for process in started:
        ended(process, signal.SIGKILL)


@pytest.fixture
def listen():
    """Collects the messages of a topic below the plugin's."""
    topics = []

    def to(name, kind):
        heard = []
        place = name if name.startswith("/") else f"{ROOT}/{name}"
        topics.append(node().Subscriber(place, message_type(kind), heard.append, tcp_nodelay=True))
        return heard

    yield to
    for topic in topics:
        topic.unregister()


def publisher(name, kind):
    topic = node().Publisher(f"{ROOT}/{name}", message_type(kind), queue_size=100, tcp_nodelay=True)
    until(topic.get_num_connections)
    return topic


def numbers(*parts):
    return [getattr(p, axis) for p in parts for axis in "xyz"]


def stamp(message):
    return (message.clock if hasattr(message, "clock") else message.header.stamp).to_nsec()


def nanoseconds(at):
    return at[0] * 10**9 + at[1]


def rotors_of(wire, thrust, at):
    """A JointState of all rotors that answers the state of that stamp."""
    said = message_type("sensor_msgs/JointState")()
    said.header.stamp.secs, said.header.stamp.nsecs = at
    said.name = wire._step.joint_names[:8]
    said.effort = [thrust] * 8
    return said


def test_ten_pilots_killed_at_any_moment_leave_a_server_that_flies_to_the_last_bit(over_ros, another):
    before, chance = fly(over_ros.wire(), 300), random.Random(1)
    for _ in range(10):
        pilot = another(PILOT.format(thrust=over_ros.vehicle.weight / 8))
        said(pilot, "^flying$")
        time.sleep(chance.uniform(0.0, 0.1))
        os.kill(pilot.pid, signal.SIGKILL)
        over_ros.server.check()
        if chance.random() < 0.5:  # the next one comes while it waits, or after it was given up
            time.sleep(SILENT_OVER_ROS + 0.3)
    assert np.array_equal(fly(over_ros.wire(), 300), before)


def test_what_is_doubled_stale_or_of_no_time_changes_no_bit(over_ros):
    sound, chance, other = fly(over_ros.wire(), 300), random.Random(2), publisher("rotors", "sensor_msgs/JointState")
    wire = over_ros.wire()
    send, old = wire._commands.publish, [(0, 0), (1, 0)]

    def badly(message):
        for _ in range(chance.randrange(4)):
            other.publish(rotors_of(wire, 99.0, chance.choice(old)))
        old.append((message.header.stamp.secs, message.header.stamp.nsecs))
        for _ in range(chance.randrange(1, 3)):
            send(message)
        other.publish(rotors_of(wire, 99.0, (old[-1][0] + 5, 0)))  # to come, and for what was done it is too late

    wire._commands.publish = badly
    bad = fly(wire, 300)
    wire._commands.publish = send
    other.unregister()
    assert np.array_equal(bad, sound)


def test_thrusts_alone_fly_to_the_last_bit_as_with_loads_of_nothing(over_ros):
    sound, other = fly(over_ros.wire(), 200), publisher("rotors", "sensor_msgs/JointState")
    wire = over_ros.wire()
    names, order = np.array(wire._step.joint_names[:8]), np.random.default_rng(1).permutation(8)

    def as_rotors(message):
        said = rotors_of(wire, 0.0, (message.header.stamp.secs, message.header.stamp.nsecs))
        said.name, said.effort = names[order].tolist(), wire.thrusts[order].tolist()
        other.publish(said)

    send, wire._commands.publish = wire._commands.publish, as_rotors
    alone = fly(wire, 200)
    wire._commands.publish = send
    other.unregister()
    assert np.array_equal(alone, sound)


def test_a_pilot_of_ten_lines_flies_in_lock_step(over_ros, another, listen):
    over_ros.wire().close()  # where it stands, rotors off
    pilots, states = listen("pilot", "std_msgs/Header"), listen("state", "sensor_msgs/MultiDOFJointState")
    pilot = another(check_plain_pilot())
    until(lambda: any(p.frame_id == "/plain_pilot" for p in pilots))
    step = round(1e9 * over_ros.dt)
    (led, *_) = [p.stamp.to_nsec() for p in pilots if p.frame_id == "/plain_pilot"]
    first, last = led + 50 * step, led + 600 * step  # by stamps: states of before may still be on their way
    until(lambda: stamp(states[-1]) > last)
    os.kill(pilot.pid, signal.SIGKILL)
    flown = {stamp(s): s.twist[0].linear.z for s in states if first < stamp(s) < last}  # one that is told twice, once
    assert set(np.diff(list(flown))) == {step}
    thrust = float(re.search(r"effort=\[([\d.]+)\]", check_plain_pilot())[1])
    climb = 8 * thrust / over_ros.vehicle.mass - GRAVITY
    np.testing.assert_allclose(np.diff(list(flown.values())), climb * over_ros.dt, rtol=0.0, atol=1e-9)


def test_a_second_pilot_is_not_heard_until_it_says_that_it_leads(over_ros, another):
    sound, wire = fly(over_ros.wire(), 300), over_ros.wire()
    another(check_plain_pilot())
    until(lambda: (wire.keep_alive(), "/plain_pilot is not heard" in over_ros.server.last_output())[1])
    assert np.array_equal(fly(wire, 300), sound)
    over_ros.ros("rostopic", "pub", "-1", f"{ROOT}/lead", "std_msgs/Empty")
    with pytest.raises(ConnectionError, match="the session is over: another pilot leads"):
        fly(wire, 10)


def test_a_pilot_that_was_given_up_is_told_so(over_ros):
    wire = over_ros.wire()
    fly(wire, 3)
    time.sleep(SILENT_OVER_ROS + 0.5)
    with pytest.raises(ConnectionError, match="or this one was given up"):
        wire.advance()


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda s: s.name.pop(), "it must have an effort for every name"),
        (lambda s: (s.name.pop(), s.effort.pop()), "it must name each rotor once"),
        (lambda s: s.name.__setitem__(0, "rotor_3_1"), "there is no rotor_3_1"),
        (lambda s: s.effort.__setitem__(0, float("nan")), "a number is not finite, or beyond 1e8"),
    ],
    ids=["an effort too many", "a rotor too few", "a rotor that is not there", "not a number"],
)
def test_a_message_that_is_not_sound_moves_nothing_and_says_why(over_ros, change, why):
    other, wire = publisher("rotors", "sensor_msgs/JointState"), over_ros.wire()
    told = fly(wire, 3)[-1]
    said = rotors_of(wire, 1.0, wire._at)
    change(said)
    other.publish(said)
    until(lambda: why in over_ros.server.last_output())
    other.unregister()
    wire.hello(over_ros.dt, [])
    np.testing.assert_array_equal(wire.answer.state, told[:13])


def test_a_push_by_topic_is_held_for_a_second_or_until_the_next(over_ros):
    topic, wire = publisher("push", "geometry_msgs/WrenchStamped"), over_ros.wire()
    push = message_type("geometry_msgs/WrenchStamped")()
    push.wrench.force.x, push.wrench.torque.z = 1.0, -0.5
    topic.publish(push)
    until(lambda: wire.advance().pushed[0])
    told = np.array([wire.advance().numbers[3:].copy() for _ in range(1200)])
    acting = np.flatnonzero(told[:, -6])
    assert len(acting) == 999  # steps, after the first
    assert np.all(np.diff(acting) == 1)
    np.testing.assert_allclose(told[acting, -6:], [[1.0, 0.0, 0.0, 0.0, 0.0, -0.5]] * 999, atol=1e-6)
    assert told[-1, 3] == pytest.approx(1.0 / over_ros.vehicle.mass, rel=1e-4)  # m/s: the impulse
    topic.publish(push)
    until(lambda: wire.advance().pushed[0])
    push.wrench.force.x = push.wrench.torque.z = 0.0
    topic.publish(push)
    steps = itertools.count()
    until(lambda: not (wire.advance(), next(steps))[0].pushed.any())
    assert next(steps) < 900  # before its second is over
    topic.unregister()


def test_the_topics_of_ros_tools_tell_the_same_as_the_state(over_ros, listen):
    wire = over_ros.wire()
    odometry, imu = listen("odometry", "nav_msgs/Odometry"), listen("imu", "sensor_msgs/Imu")
    joints = [listen(f"joint_{i}/wrench", "geometry_msgs/WrenchStamped") for i in (1, 2)]
    contact, clock = listen("contact/force", "geometry_msgs/WrenchStamped"), listen("/clock", "rosgraph_msgs/Clock")
    heard = (odometry, imu, *joints, contact, clock)
    until(lambda: wire.advance() and all(heard))
    begin = nanoseconds(wire._at)
    told = fly(wire, 100)
    until(lambda: all(stamp(topic[-1]) == nanoseconds(wire._at) for topic in heard))
    odometry, imu, *joints, contact, clock = ([m for m in topic if stamp(m) > begin] for topic in heard)
    assert [stamp(m) for m in clock] == list(range(begin + 10**6, begin + 101 * 10**6, 10**6))
    assert [stamp(m) for m in odometry] == [stamp(m) for m in clock] == [stamp(m) for m in contact]
    for row, o, i, c, *j in zip(told, odometry, imu, contact, *joints, strict=True):
        state, felt = row[:13], row[13:31]
        pose, twist = o.pose.pose, o.twist.twist
        np.testing.assert_array_equal(numbers(pose.position), state[:3])
        np.testing.assert_array_equal([pose.orientation.w, *numbers(pose.orientation)], state[6:10])
        R = np.array(rotation_from_quaternion(Quat(*state[6:10])))
        np.testing.assert_allclose(numbers(twist.linear), R.T @ state[3:6], atol=1e-12)
        np.testing.assert_array_equal(numbers(twist.angular), state[10:])
        np.testing.assert_array_equal(numbers(i.angular_velocity, i.linear_acceleration), [*state[10:], *felt[:3]])
        for k, message in enumerate(j):
            force_and_torque = felt[3:-3].reshape(6, 2)[:, k]
            np.testing.assert_array_equal(numbers(message.wrench.force, message.wrench.torque), force_and_torque)
        np.testing.assert_array_equal(numbers(c.wrench.force), felt[-3:])


def test_rostopic_sees_the_rate_and_the_state(over_ros, another):
    said(another(PILOT.format(thrust=over_ros.vehicle.weight / 8)), "^flying$")
    told = over_ros.ros("sh", "-c", f"timeout -s INT 20 rostopic hz -w 500 {ROOT}/odometry; true")
    assert float(re.findall(r"average rate: ([\d.]+)", told)[-1]) > 0.0
    assert "rotation" in over_ros.ros("rostopic", "echo", "-n", "1", f"{ROOT}/state")
