"""The topics of an exported flight: name, message type, frame, and the numbers of every message.

A topic whose channels a flight does not have is left out, unless every flight has them. Names are below `/tandemlift/`;
`/tf`, `/tf_static` and `/diagnostics` are where ROS tools look for them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from tandemlift.errors import InputError
from tandemlift.export.frames import ALIGNED, BASE, PAYLOAD, WORLD, Array, joint, quaternions, to_body, to_world
from tandemlift.flight import Flight
from tandemlift.vehicle import Vehicle

ROOT = "/tandemlift"
ODOMETRY, POSE, IMU = "nav_msgs/Odometry", "geometry_msgs/PoseStamped", "sensor_msgs/Imu"
VECTOR, POINT = "geometry_msgs/Vector3Stamped", "geometry_msgs/PointStamped"
WRENCH, ROTORS = "geometry_msgs/WrenchStamped", "sensor_msgs/JointState"
WIDTHS = {"attitude": 4, "measured_attitude": 4, "estimated_attitude": 4, "thrust": 1, "allocated_thrust": 1}
WIDTHS["push_point_estimate"] = 1


class Topic(NamedTuple):
    """A topic with a message for each sample.

    Attributes:
        name: of the topic.
        kind: of its messages, as ROS 1 calls it.
        frame: in which they are.
        rows: the numbers of each message (T, n), in the order of `messages.py`.
        labels: of these numbers, where the message names them.
    """

    name: str
    kind: str
    frame: str
    rows: Array
    labels: tuple[str, ...] = ()


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
        """How many columns a channel must have."""
        if name.startswith("rotor_"):
            return self.vehicle.rotor_count
        return 3 * self.vehicle.count if "joint_" in name else WIDTHS.get(name, 3)


class Recipe(NamedTuple):
    """How a topic is made: its name below the root, type and frame, the channels that it needs, its numbers, labels."""

    name: str
    kind: str
    frame: str
    needs: tuple[str, ...]
    rows: Callable[[Source], Array]
    labels: tuple[str, ...] = ()


def _as_told(name: str, kind: str, frame: str, *channels: str) -> Recipe:
    """A topic of channels side by side."""
    return Recipe(name, kind, frame, channels, lambda take: np.hstack([take(c) for c in channels]))


def _force(name: str, channel: str) -> Recipe:
    """A wrench of a force alone, world axes, at the vehicle."""
    return Recipe(name, WRENCH, ALIGNED, (channel,), lambda take: np.pad(take(channel), ((0, 0), (0, 3))))


def _odometry(name: str, prefix: str = "") -> Recipe:
    """Pose in the world, and velocities in body axes, as the message defines them."""
    needs = tuple(prefix + c for c in ("position", "attitude", "velocity", "rates"))

    def rows(take: Source) -> Array:
        position, attitude, velocity, rates = map(take, needs)
        return np.hstack([position, attitude, to_body(attitude, velocity), rates])

    return Recipe(name, ODOMETRY, WORLD, needs, rows)


def _wrench(name: str, force: str, moment: str, at: Callable[[Vehicle], Array] | None = None) -> Recipe:
    """A force in world axes and a moment in body axes, as a wrench in world axes at the vehicle's centre of mass.

    `at` tells where the force acts, if the moment is about that point [m], from the centre of mass, body axes.
    """
    needs = (force, moment, "attitude")

    def rows(take: Source) -> Array:
        f, m, attitude = map(take, needs)
        moments = to_world(attitude, m)
        if at is not None:
            moments += np.cross(to_world(attitude, np.broadcast_to(at(take.vehicle), f.shape)), f)
        return np.hstack([f, moments])

    return Recipe(name, WRENCH, ALIGNED, needs, rows)


def _command(name: str, thrust: str, moment: str) -> Recipe:
    """Thrust along body z and moments, as a wrench in body axes."""

    def rows(take: Source) -> Array:
        return np.hstack([np.pad(take(thrust), ((0, 0), (2, 0))), take(moment)])

    return Recipe(name, WRENCH, BASE, (thrust, moment), rows)


def _joint(number: int, name: str, force: str, torque: str) -> Recipe:
    """The wrench at the joint of one quadrotor, from 1."""
    own = slice(3 * number - 3, 3 * number)
    frame = joint(number)

    def rows(take: Source) -> Array:
        return np.hstack([take(force)[:, own], take(torque)[:, own]])

    return Recipe(f"{frame}/{name}", WRENCH, frame, (force, torque), rows)


def _point_on_beam(take: Source) -> Array:
    """A point on the body's y axis through the payload's centre of mass."""
    return np.pad(take("push_point_estimate"), ((0, 0), (1, 1)))


def _pose_of_reference(take: Source) -> Array:
    return np.hstack([take("reference_position"), quaternions(take("reference_euler"))])


ALWAYS = (
    _odometry("odometry"),
    Recipe("reference/pose", POSE, WORLD, ("reference_position", "reference_euler"), _pose_of_reference),
    _as_told("reference/velocity", VECTOR, WORLD, "reference_velocity"),
    _as_told("reference/acceleration", VECTOR, WORLD, "reference_acceleration"),
    _as_told("admittance/position", POINT, WORLD, "admittance_position"),
    _as_told("admittance/velocity", VECTOR, WORLD, "admittance_velocity"),
    _as_told("admittance/acceleration", VECTOR, WORLD, "admittance_acceleration"),
    _wrench("push/true", "push_force", "push_moment"),
    _force("push/gated", "admittance_force"),
    _command("command/wrench", "thrust", "moment"),
    _as_told("rotors/thrusts", ROTORS, BASE, "rotor_thrusts"),
)
SOMETIMES = (
    _as_told("rotors/commands", ROTORS, BASE, "rotor_commands"),
    _command("command/allocated", "allocated_thrust", "allocated_moment"),
    _force("push/measured", "push_measured"),
    _wrench("push/estimated", "push_estimate", "push_moment_estimate", lambda v: -v.center_of_mass),
    _force("push/heard", "push_heard"),
    Recipe("push/point", POINT, PAYLOAD, ("push_point_estimate",), _point_on_beam),
    _wrench("disturbance", "disturbance_force", "disturbance_moment"),
    _odometry("measured/odometry", "measured_"),
    _as_told("measured/imu", IMU, PAYLOAD, "measured_rates", "measured_specific_force"),
    _odometry("estimated/odometry", "estimated_"),
    _as_told("wind/velocity", VECTOR, WORLD, "wind_velocity"),
    _force("wind/force", "wind_force"),
    _force("contact/force", "contact_force"),
)


def _recipes(flight: Flight, count: int) -> Iterator[Recipe]:
    """What is made of a flight of so many quadrotors: what every flight has, and what else this one has."""
    yield from ALWAYS
    for i in range(1, count + 1):
        yield _joint(i, "wrench", "joint_force", "joint_torque")
    measured = [_joint(i, "measured", "measured_joint_force", "measured_joint_torque") for i in range(1, count + 1)]
    for recipe in (*SOMETIMES, *measured):
        if all(name in flight for name in recipe.needs):
            yield recipe


def recipes_of(flight: Flight, vehicle: Vehicle) -> list[Recipe]:
    """How all topics of a flight are made that have a message for each sample; their names are whole."""
    rotors = tuple(f"rotor_{1 + i // 4}_{1 + i % 4}" for i in range(vehicle.rotor_count))
    return [
        r._replace(name=f"{ROOT}/{r.name}", labels=rotors if r.kind == ROTORS else ())
        for r in _recipes(flight, vehicle.count)
    ]


def topics_of(flight: Flight, vehicle: Vehicle) -> list[Topic]:
    """All topics of a flight that have a message for each sample.

    Raises:
        InputError: the flight lacks a channel that every flight has, or one is of a wrong size.
    """
    take = Source(flight, vehicle)
    return [Topic(r.name, r.kind, r.frame, r.rows(take), r.labels) for r in recipes_of(flight, vehicle)]
