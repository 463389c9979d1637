"""Messages of standard types from the numbers of a topic, for ROS 1 and for ROS 2 alike.

Quaternions come as w, x, y, z. Covariances are zero: unknown. An `Imu` has no orientation (its covariance says −1).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from tandemlift.apps.export.coordinate_frames import ALIGNED, BASE, WORLD
from tandemlift.apps.export.recipes import IMU, ODOMETRY, POINT, POSE, ROTORS, VECTOR, WRENCH, Recipe, Topic
from tandemlift.core.types import Array

About = Topic | Recipe  # of which a maker reads frame and labels
Maker = Callable[[int, Sequence[float]], Any]  # a message from its time [ns] and its numbers
SECOND = 1_000_000_000  # ns
OK, WARN, ERROR = 0, 1, 2  # levels of diagnostic_msgs/DiagnosticStatus


class MessageTypes:
    """The classes of message types by their ROS 1 names; each takes the values of its fields in their order.

    Args:
        class_of: the class of a type by that name, such as `geometry_msgs/Wrench`.
        numbered: whether a header begins with a number, as in ROS 1.
        numbers: converts numbers for a field of several numbers.
    """

    def __init__(
        self, class_of: Callable[[str], Any], *, numbered: bool, numbers: Callable[[Sequence[float]], Any] = list
    ) -> None:
        self._class_of, self.numbered, self.numbers = class_of, numbered, numbers
        self.Vector, self.Point = self["geometry_msgs/Vector3"], self["geometry_msgs/Point"]
        self._Quaternion = self["geometry_msgs/Quaternion"]

    def __getitem__(self, name: str) -> Callable[..., Any]:
        return self._class_of(name)

    def quaternion(self, wxyz: Sequence[float]) -> object:
        """A quaternion, of which ROS puts w at the end."""
        w, x, y, z = wxyz
        return self._Quaternion(x, y, z, w)

    def headers(self, frame: str) -> Callable[[int], Any]:
        """Headers for the messages of a topic, from their times [ns]."""
        Header, Time, count = self["std_msgs/Header"], self["builtin_interfaces/Time"], itertools.count()

        def header(stamp: int) -> object:
            time = Time(*divmod(stamp, SECOND))
            return Header(next(count), time, frame) if self.numbered else Header(time, frame)

        return header


def modern(name: str) -> str:
    """A message type's name in ROS 2."""
    package, _, kind = name.rpartition("/")
    return f"{package}/msg/{kind}"


def _odometry(types: MessageTypes, topic: About) -> Maker:
    Odometry, Pose, Twist = types[ODOMETRY], types["geometry_msgs/Pose"], types["geometry_msgs/Twist"]
    Placed, Moving = types["geometry_msgs/PoseWithCovariance"], types["geometry_msgs/TwistWithCovariance"]
    header, unknown_covariance = types.headers(topic.frame), types.numbers([0.0] * 36)

    def make(stamp: int, v: Sequence[float]) -> object:
        pose = Pose(types.Point(*v[:3]), types.quaternion(v[3:7]))
        twist = Twist(types.Vector(*v[7:10]), types.Vector(*v[10:]))
        return Odometry(header(stamp), BASE, Placed(pose, unknown_covariance), Moving(twist, unknown_covariance))

    return make


def _pose(types: MessageTypes, topic: About) -> Maker:
    Stamped, Pose, header = types[POSE], types["geometry_msgs/Pose"], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), Pose(types.Point(*v[:3]), types.quaternion(v[3:])))


def _vector(types: MessageTypes, topic: About) -> Maker:
    Stamped, header = types[VECTOR], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), types.Vector(*v))


def _point(types: MessageTypes, topic: About) -> Maker:
    Stamped, header = types[POINT], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), types.Point(*v))


def _wrench(types: MessageTypes, topic: About) -> Maker:
    Stamped, Wrench, header = types[WRENCH], types["geometry_msgs/Wrench"], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), Wrench(types.Vector(*v[:3]), types.Vector(*v[3:])))


def _rotors(types: MessageTypes, topic: About) -> Maker:
    State, header, none = types[ROTORS], types.headers(topic.frame), types.numbers([])
    names = list(topic.labels)
    if not topic.frame:  # numbers of any kind, which plotters look for in the first of the three
        return lambda stamp, v: State(header(stamp), names, types.numbers(v), none, none)
    return lambda stamp, v: State(header(stamp), names, none, none, types.numbers(v))


def _imu(types: MessageTypes, topic: About) -> Maker:
    Imu, header, zero = types[IMU], types.headers(topic.frame), types.numbers([0.0] * 9)
    unknown, unturned = types.numbers([-1.0, *zero[1:]]), types.quaternion((1.0, 0.0, 0.0, 0.0))

    def make(stamp: int, v: Sequence[float]) -> object:
        return Imu(header(stamp), unturned, unknown, types.Vector(*v[:3]), zero, types.Vector(*v[3:]), zero)

    return make


MAKERS: dict[str, Callable[[MessageTypes, About], Maker]] = {
    ODOMETRY: _odometry,
    POSE: _pose,
    VECTOR: _vector,
    POINT: _point,
    WRENCH: _wrench,
    ROTORS: _rotors,
    IMU: _imu,
}


Numbers = Callable[[Any], list[float]]  # those of a message, as its maker takes them


class XYZ(Protocol):
    """A vector or a point of a message."""

    x: float
    y: float
    z: float


class WXYZ(XYZ, Protocol):
    """A quaternion of a message."""

    w: float


def _xyz(v: XYZ) -> list[float]:
    return [v.x, v.y, v.z]


def _wxyz(q: WXYZ) -> list[float]:
    return [q.w, q.x, q.y, q.z]


def _placed(pose: Any) -> list[float]:
    return _xyz(pose.position) + _wxyz(pose.orientation)


NUMBERS: dict[str, Numbers] = {
    ODOMETRY: lambda m: _placed(m.pose.pose) + _xyz(m.twist.twist.linear) + _xyz(m.twist.twist.angular),
    POSE: lambda m: _placed(m.pose),
    VECTOR: lambda m: _xyz(m.vector),
    POINT: lambda m: _xyz(m.point),
    WRENCH: lambda m: _xyz(m.wrench.force) + _xyz(m.wrench.torque),
    ROTORS: lambda m: [*(m.effort if len(m.effort) else m.position)],
    IMU: lambda m: _xyz(m.angular_velocity) + _xyz(m.linear_acceleration),
}


def message_maker(types: MessageTypes, topic: About) -> Maker:
    """The function that makes the messages of a topic."""
    return MAKERS[topic.kind](types, topic)


class Transforms:
    """Messages of `/tf` and `/tf_static`."""

    def __init__(self, types: MessageTypes) -> None:
        self._types, self._header = types, types.headers(WORLD)
        self._TFMessage = types["tf2_msgs/TFMessage"]
        self._Stamped, self._Transform = types["geometry_msgs/TransformStamped"], types["geometry_msgs/Transform"]
        self._base = types.headers(BASE)
        self._unturned = types.quaternion((1.0, 0.0, 0.0, 0.0))

    def moving(self, stamp: int, v: Sequence[float]) -> object:
        """The vehicle's pose in the world, from position and attitude: in body axes and in the world's."""
        place, header = self._types.Vector(*v[:3]), self._header(stamp)
        turned = self._Transform(place, self._types.quaternion(v[3:7]))
        level = self._Transform(place, self._unturned)
        return self._TFMessage([self._Stamped(header, BASE, turned), self._Stamped(header, ALIGNED, level)])

    def fixed(self, stamp: int, places: Sequence[tuple[str, Array]]) -> object:
        """The places of the parts in the vehicle."""
        Vector, Transform, header = self._types.Vector, self._Transform, self._base(stamp)
        return self._TFMessage(
            [self._Stamped(header, name, Transform(Vector(*at.tolist()), self._unturned)) for name, at in places]
        )


def event_maker(types: MessageTypes) -> Callable[[int, str], Any]:
    """The function that makes a message of `/diagnostics` from an event's time [ns] and text."""
    Many, Status = types["diagnostic_msgs/DiagnosticArray"], types["diagnostic_msgs/DiagnosticStatus"]
    header = types.headers("")

    def make(stamp: int, what: str) -> object:
        level = ERROR if " -> " in what or what.startswith(("crashed", "diverged")) else WARN if ": " in what else OK
        return Many(header(stamp), [Status(level, "tandemlift: pilot", what, "", [])])

    return make


def status_maker(types: MessageTypes) -> Callable[[int, bool, str, Mapping[str, str]], Any]:
    """The function that makes one from a flight's state: time [ns], whether it is well, a summary, values by name."""
    Many, Status = types["diagnostic_msgs/DiagnosticArray"], types["diagnostic_msgs/DiagnosticStatus"]
    header, Value = types.headers(""), types["diagnostic_msgs/KeyValue"]

    def make(stamp: int, well: bool, summary: str, more: Mapping[str, str]) -> object:
        values = [Value(key, value) for key, value in more.items()]
        return Many(header(stamp), [Status(OK if well else WARN, "tandemlift: flight", summary, "", values)])

    return make
