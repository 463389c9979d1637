"""Messages of standard types from the numbers of a topic, for ROS 1 and for ROS 2 alike.

Quaternions come as w, x, y, z. Covariances are zero: not told. An `Imu` has no orientation (its covariance says −1).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tandemlift.export.frames import ALIGNED, BASE, WORLD, Array
from tandemlift.export.topics import IMU, ODOMETRY, POINT, POSE, ROTORS, VECTOR, WRENCH, Recipe, Topic

About = Topic | Recipe  # of which a maker reads frame and labels
Maker = Callable[[int, Sequence[float]], Any]  # a message from its time [ns] and its numbers
SECOND = 1_000_000_000  # ns
OK, WARN, ERROR = 0, 1, 2  # levels of diagnostic_msgs/DiagnosticStatus


class Types:
    """The classes of message types by their ROS 1 names; each takes the values of its fields in their order.

    Args:
        class_of: the class of a type by that name, such as `geometry_msgs/Wrench`.
        numbered: whether a header begins with a number, as in ROS 1.
    """

    def __init__(self, class_of: Callable[[str], Any], *, numbered: bool) -> None:
        self._class_of, self.numbered = class_of, numbered
        self.Vector, self.Point = self["geometry_msgs/Vector3"], self["geometry_msgs/Point"]
        self._Quaternion = self["geometry_msgs/Quaternion"]

    def __getitem__(self, name: str) -> Any:
        return self._class_of(name)

    def quaternion(self, wxyz: Sequence[float]) -> Any:
        """A quaternion, of which ROS puts w at the end."""
        w, x, y, z = wxyz
        return self._Quaternion(x, y, z, w)

    def headers(self, frame: str) -> Callable[[int], Any]:
        """Headers for the messages of a topic, from their times [ns]."""
        Header, Time, count = self["std_msgs/Header"], self["builtin_interfaces/Time"], itertools.count()

        def header(stamp: int) -> Any:
            time = Time(*divmod(stamp, SECOND))
            return Header(next(count), time, frame) if self.numbered else Header(time, frame)

        return header


def modern(name: str) -> str:
    """A message type's name in ROS 2."""
    package, _, kind = name.rpartition("/")
    return f"{package}/msg/{kind}"


def _odometry(types: Types, topic: About) -> Maker:
    Odometry, Pose, Twist = types[ODOMETRY], types["geometry_msgs/Pose"], types["geometry_msgs/Twist"]
    Placed, Moving = types["geometry_msgs/PoseWithCovariance"], types["geometry_msgs/TwistWithCovariance"]
    header, untold = types.headers(topic.frame), np.zeros(36)

    def make(stamp: int, v: Sequence[float]) -> Any:
        pose = Pose(types.Point(*v[:3]), types.quaternion(v[3:7]))
        twist = Twist(types.Vector(*v[7:10]), types.Vector(*v[10:]))
        return Odometry(header(stamp), BASE, Placed(pose, untold), Moving(twist, untold))

    return make


def _pose(types: Types, topic: About) -> Maker:
    Stamped, Pose, header = types[POSE], types["geometry_msgs/Pose"], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), Pose(types.Point(*v[:3]), types.quaternion(v[3:])))


def _vector(types: Types, topic: About) -> Maker:
    Stamped, header = types[VECTOR], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), types.Vector(*v))


def _point(types: Types, topic: About) -> Maker:
    Stamped, header = types[POINT], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), types.Point(*v))


def _wrench(types: Types, topic: About) -> Maker:
    Stamped, Wrench, header = types[WRENCH], types["geometry_msgs/Wrench"], types.headers(topic.frame)
    return lambda stamp, v: Stamped(header(stamp), Wrench(types.Vector(*v[:3]), types.Vector(*v[3:])))


def _rotors(types: Types, topic: About) -> Maker:
    State, header, none = types[ROTORS], types.headers(topic.frame), np.zeros(0)
    names = list(topic.labels)
    return lambda stamp, v: State(header(stamp), names, none, none, np.array(v))


def _imu(types: Types, topic: About) -> Maker:
    Imu, header, zero = types[IMU], types.headers(topic.frame), np.zeros(9)
    unknown, unturned = np.array([-1.0, *zero[1:]]), types.quaternion((1.0, 0.0, 0.0, 0.0))

    def make(stamp: int, v: Sequence[float]) -> Any:
        return Imu(header(stamp), unturned, unknown, types.Vector(*v[:3]), zero, types.Vector(*v[3:]), zero)

    return make


MAKERS: dict[str, Callable[[Types, About], Maker]] = {
    ODOMETRY: _odometry,
    POSE: _pose,
    VECTOR: _vector,
    POINT: _point,
    WRENCH: _wrench,
    ROTORS: _rotors,
    IMU: _imu,
}


def maker_of(types: Types, topic: About) -> Maker:
    """What makes the messages of a topic."""
    return MAKERS[topic.kind](types, topic)


class Transforms:
    """Messages of `/tf` and `/tf_static`."""

    def __init__(self, types: Types) -> None:
        self._types, self._header = types, types.headers(WORLD)
        self._TFMessage = types["tf2_msgs/TFMessage"]
        self._Stamped, self._Transform = types["geometry_msgs/TransformStamped"], types["geometry_msgs/Transform"]
        self._base = types.headers(BASE)
        self._unturned = types.quaternion((1.0, 0.0, 0.0, 0.0))

    def moving(self, stamp: int, v: Sequence[float]) -> Any:
        """Where the vehicle is in the world, from position and attitude: in body axes and in the world's."""
        place, header = self._types.Vector(*v[:3]), self._header(stamp)
        turned = self._Transform(place, self._types.quaternion(v[3:7]))
        level = self._Transform(place, self._unturned)
        return self._TFMessage([self._Stamped(header, BASE, turned), self._Stamped(header, ALIGNED, level)])

    def fixed(self, stamp: int, places: Sequence[tuple[str, Array]]) -> Any:
        """Where its parts are in the vehicle."""
        Vector, Transform, header = self._types.Vector, self._Transform, self._base(stamp)
        return self._TFMessage(
            [self._Stamped(header, name, Transform(Vector(*at.tolist()), self._unturned)) for name, at in places]
        )


def diagnostics_of(types: Types) -> Callable[[int, str], Any]:
    """What makes a message of `/diagnostics` from an event: its time [ns] and what happened."""
    Many, Status = types["diagnostic_msgs/DiagnosticArray"], types["diagnostic_msgs/DiagnosticStatus"]
    header = types.headers("")

    def make(stamp: int, what: str) -> Any:
        level = ERROR if " -> " in what or what.startswith("diverged") else WARN if ": " in what else OK
        return Many(header(stamp), [Status(level, "tandemlift: pilot", what, "", [])])

    return make


def status_of(types: Types) -> Callable[[int, bool, str, Mapping[str, str]], Any]:
    """What makes one from how a flight goes: time [ns], whether it is well, a summary, and more by name."""
    Many, Status = types["diagnostic_msgs/DiagnosticArray"], types["diagnostic_msgs/DiagnosticStatus"]
    header, Value = types.headers(""), types["diagnostic_msgs/KeyValue"]

    def make(stamp: int, well: bool, summary: str, more: Mapping[str, str]) -> Any:
        values = [Value(key, value) for key, value in more.items()]
        return Many(header(stamp), [Status(OK if well else WARN, "tandemlift: flight", summary, "", values)])

    return make
