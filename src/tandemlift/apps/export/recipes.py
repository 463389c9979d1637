"""Recipes that make topics of a flight's channels, and these channels again of the topics' numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tandemlift.apps.export import coordinate_frames as frames
from tandemlift.apps.export.csv_file import components
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.flight.channels import CHANNELS
from tandemlift.flight.record import Flight
from tandemlift.parts.mechanics.vehicle import Vehicle

ODOMETRY, POSE, IMU = "nav_msgs/Odometry", "geometry_msgs/PoseStamped", "sensor_msgs/Imu"
VECTOR, POINT = "geometry_msgs/Vector3Stamped", "geometry_msgs/PointStamped"
WRENCH, ROTORS = "geometry_msgs/WrenchStamped", "sensor_msgs/JointState"


class Topic(NamedTuple):
    """A topic with a message for each sample.

    Attributes:
        name: of the topic.
        kind: of its messages, as ROS 1 calls it.
        frame: in which they are.
        rows: the numbers of each message (T, n), in the order of `messages.py`.
        labels: of these numbers, where the message names them.
        stamps: the flight's times [s] of the messages' headers (T,); None for those of the samples. A message whose
            stamp is that of the one before it is left out.
    """

    name: str
    kind: str
    frame: str
    rows: Array
    labels: tuple[str, ...] = ()
    stamps: Array | None = None


class Source:
    """The channels of a flight, each with as many columns as a topic needs.

    Args:
        flight: the flight.
        vehicle: its vehicle.
    """

    def __init__(self, flight: Flight, vehicle: Vehicle) -> None:
        self.flight, self.vehicle = flight, vehicle

    def __call__(self, name: str) -> Array:
        """A channel (T, n).

        Raises:
            InputError: the flight does not have it, or not with n columns.
        """
        if name not in self.flight:
            raise InputError(f"flight {self.flight.name!r} has no channel {name!r}, which a bag needs; a .csv does not")
        values = self.flight[name].reshape(len(self.flight.time), -1)
        if values.shape[1] != self.width(name):
            found = f"has {values.shape[1]} columns, not {self.width(name)}"
            raise InputError(f"flight {self.flight.name!r}: channel {name!r} {found}")
        return values

    def width(self, name: str) -> int:
        """The number of columns that a channel must have."""
        return CHANNELS[name].columns(self.vehicle.count, self.vehicle.rotor_count)


class MeasuredPose(NamedTuple):
    """The data that turn numbers of messages back into channels: the vehicle's attitudes (T, 4)."""

    attitude: Array


Back = Callable[[Array, MeasuredPose], dict[str, Array]]


class Recipe(NamedTuple):
    """A recipe for a topic of channels, and for the channels of a topic.

    Attributes:
        name: below the root.
        kind: of its messages, as ROS 1 calls it.
        frame: in which they are.
        needs: the channels.
        rows: the numbers of each message (T, n) from the channels.
        back: the channels by name from these numbers; of a joint, its part of them.
        labels: of these numbers, where the message names them.
        meaning: a short description for docs/reference/topics.md.
        stamp: the channel with the times at which a sensor took the numbers; "" for the times of the samples.
    """

    name: str
    kind: str
    frame: str
    needs: tuple[str, ...]
    rows: Callable[[Source], Array]
    back: Back
    labels: tuple[str, ...] = ()
    meaning: str = ""
    stamp: str = ""

    def described(self, meaning: str) -> Recipe:
        """The same recipe with a meaning."""
        return self._replace(meaning=meaning)


def as_recorded(name: str, kind: str, frame: str, *channels: str) -> Recipe:
    """A topic of channels side by side, all as wide as each other."""

    def back(rows: Array, _: MeasuredPose) -> dict[str, Array]:
        return dict(zip(channels, np.split(rows, len(channels), axis=1), strict=True))

    return Recipe(name, kind, frame, channels, lambda take: np.hstack([take(c) for c in channels]), back)


def force(name: str, channel: str) -> Recipe:
    """A wrench of a force alone, world axes, at the vehicle."""

    def rows(take: Source) -> Array:
        return np.pad(take(channel), ((0, 0), (0, 3)))

    return Recipe(name, WRENCH, frames.ALIGNED, (channel,), rows, lambda rows, _: {channel: rows[:, :3]})


def motion_readings(name: str) -> Recipe:
    """Readings of the motion measurement as odometry, whose angular velocity is NaN: it reads none."""
    both = odometry(name, "measured_")
    needs = both.needs[:3]

    def rows(take: Source) -> Array:
        position, attitude, velocity = map(take, needs)
        return np.hstack([position, attitude, frames.to_body(attitude, velocity), np.full((len(position), 3), np.nan)])

    def back(rows: Array, seen: MeasuredPose) -> dict[str, Array]:
        return {name: values for name, values in both.back(rows, seen).items() if name in needs}

    return both._replace(needs=needs, rows=rows, back=back, stamp="motion_stamp")


def odometry(name: str, prefix: str = "") -> Recipe:
    """Pose in the world, and velocities in body axes, as the message defines them."""
    needs = tuple(prefix + c for c in ("position", "attitude", "velocity", "rates"))

    def rows(take: Source) -> Array:
        position, attitude, velocity, rates = map(take, needs)
        return np.hstack([position, attitude, frames.to_body(attitude, velocity), rates])

    def back(rows: Array, _: MeasuredPose) -> dict[str, Array]:
        attitude = rows[:, 3:7]
        found = rows[:, :3], attitude, frames.to_world(attitude, rows[:, 7:10]), rows[:, 10:]
        return dict(zip(needs, found, strict=True))

    return Recipe(name, ODOMETRY, frames.WORLD, needs, rows, back)


def wrench(name: str, force: str, moment: str) -> Recipe:
    """A force in world axes and a moment in body axes, as a wrench in world axes at the vehicle's centre of mass."""

    def rows(take: Source) -> Array:
        f, m, attitude = map(take, (force, moment, "attitude"))
        return np.hstack([f, frames.to_world(attitude, m)])

    def back(rows: Array, seen: MeasuredPose) -> dict[str, Array]:
        return {force: rows[:, :3], moment: frames.to_body(seen.attitude, rows[:, 3:])}

    return Recipe(name, WRENCH, frames.ALIGNED, (force, moment, "attitude"), rows, back)


def command(name: str, thrust: str, moment: str) -> Recipe:
    """Thrust along body z and moments, as a wrench in body axes."""

    def rows(take: Source) -> Array:
        return np.hstack([np.pad(take(thrust), ((0, 0), (2, 0))), take(moment)])

    def back(rows: Array, _: MeasuredPose) -> dict[str, Array]:
        return {thrust: rows[:, 2], moment: rows[:, 3:]}

    return Recipe(name, WRENCH, frames.BASE, (thrust, moment), rows, back)


def joint_wrench(number: int, name: str, force: str, torque: str) -> Recipe:
    """The wrench at the joint of one quadrotor, from 1."""
    own = slice(3 * number - 3, 3 * number)
    frame = frames.joint(number)

    def rows(take: Source) -> Array:
        return np.hstack([take(force)[:, own], take(torque)[:, own]])

    def back(rows: Array, _: MeasuredPose) -> dict[str, Array]:
        return {force: rows[:, :3], torque: rows[:, 3:]}

    return Recipe(f"{frame}/{name}", WRENCH, frame, (force, torque), rows, back)


def pose_of_reference(name: str) -> Recipe:
    """The pose that is tracked."""
    needs = ("reference_position", "reference_euler")

    def rows(take: Source) -> Array:
        return np.hstack([take(needs[0]), frames.quaternions(take(needs[1]))])

    def back(rows: Array, _: MeasuredPose) -> dict[str, Array]:
        return {needs[0]: rows[:, :3], needs[1]: frames.eulers(rows[:, 3:])}

    return Recipe(name, POSE, frames.WORLD, needs, rows, back)


def point_on_beam(name: str, channel: str) -> Recipe:
    """A point on the body's y axis through the payload's origin."""

    def rows(take: Source) -> Array:
        return np.pad(take(channel), ((0, 0), (1, 1)))

    return Recipe(name, POINT, frames.PAYLOAD, (channel,), rows, lambda rows, _: {channel: rows[:, 1]})


def values(name: str, channels: tuple[str, ...], vehicle: Vehicle) -> Recipe:
    """Numbers by name, those of a channel with several of them with its component, without a frame."""
    widths = [CHANNELS[c].columns(vehicle.count, vehicle.rotor_count) for c in channels]
    labels = tuple(label for c, width in zip(channels, widths, strict=True) for label in _labels(c, width))

    def back(rows: Array, _: MeasuredPose) -> dict[str, Array]:
        parts = np.split(rows, np.cumsum(widths)[:-1], axis=1)
        return {c: part[:, 0] if w == 1 else part for c, part, w in zip(channels, parts, widths, strict=True)}

    return Recipe(name, ROTORS, "", channels, lambda take: np.hstack([take(c) for c in channels]), back, labels)


def _labels(name: str, width: int) -> list[str]:
    return [name] if width == 1 else [f"{name}.{part}" for part in components(CHANNELS[name], width)]
