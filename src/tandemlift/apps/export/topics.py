"""The topics of an exported flight: name, message type, frame, and the numbers of every message.

A topic whose channels a flight does not have is left out, unless every flight has them. Names are below `/tandemlift/`;
`/tf`, `/tf_static` and `/diagnostics` have the names that ROS tools expect.
"""

from __future__ import annotations

from collections.abc import Container, Iterator
from typing import NamedTuple

from tandemlift.apps.export.coordinate_frames import BASE, PAYLOAD, WORLD
from tandemlift.apps.export.recipes import (
    IMU,
    POINT,
    ROTORS,
    VECTOR,
    Recipe,
    Source,
    Topic,
    as_recorded,
    command,
    force,
    joint_wrench,
    motion_readings,
    odometry,
    point_on_beam,
    pose_of_reference,
    values,
    wrench,
)
from tandemlift.flight.channels import CHANNELS, STAMP
from tandemlift.flight.record import Flight
from tandemlift.parts.mechanics.vehicle import Vehicle

ROOT = "/tandemlift"


class OtherTopic(NamedTuple):
    """A topic that has no message for each sample: its whole name, its type as ROS 1 calls it, meaning, and frames."""

    name: str
    kind: str
    meaning: str
    frames: tuple[str, ...] = ()


TF = OtherTopic("/tf", "tf2_msgs/TFMessage", "`base_link` and `base_world` in `world`", (WORLD,))
TF_STATIC = OtherTopic("/tf_static", "tf2_msgs/TFMessage", "`payload` and the joints in `base_link`; latched", (BASE,))
DIAGNOSTICS = OtherTopic(
    "/diagnostics",
    "diagnostic_msgs/DiagnosticArray",
    "events: phases (OK), failed checks (warning), alarms and divergence (error)",
)
MISSION = OtherTopic(f"{ROOT}/mission", "std_msgs/String", "the resolved mission as TOML, which flies again; latched")
NOT_SAMPLES = (TF, TF_STATIC, DIAGNOSTICS, MISSION)

ALWAYS = (
    odometry("odometry").described("state of the vehicle; both velocities in body axes, as the message defines them"),
    pose_of_reference("reference/pose").described("reference pose"),
    as_recorded("reference/velocity", VECTOR, WORLD, "reference_velocity").described("its velocity [m/s]"),
    as_recorded("reference/acceleration", VECTOR, WORLD, "reference_acceleration").described("its acceleration [m/s²]"),
    as_recorded("admittance/position", POINT, WORLD, "admittance_position").described(
        "response of the admittance to the push"
    ),
    as_recorded("admittance/velocity", VECTOR, WORLD, "admittance_velocity").described("its velocity [m/s]"),
    as_recorded("admittance/acceleration", VECTOR, WORLD, "admittance_acceleration").described(
        "its acceleration [m/s²]"
    ),
    wrench("push/true", "push_force", "push_moment").described(
        "force and moment of the person, about the vehicle's centre of mass"
    ),
    force("push/gated", "admittance_force").described(
        "push after the gate: the input of the admittance; a force alone"
    ),
    command("command/wrench", "thrust", "moment").described("U₁ along z, and U₂, U₃, U₄"),
    as_recorded("rotors/thrusts", ROTORS, BASE, "rotor_thrusts").described("thrust of each rotor [N] in `effort`"),
)
SOMETIMES = (
    as_recorded("rotors/commands", ROTORS, BASE, "rotor_commands").described(
        "commanded thrust of each rotor [N] in `effort`"
    ),
    command("command/allocated", "allocated_thrust", "allocated_moment").described(
        "part of the command that the rotors give within their limits"
    ),
    force("push/measured", "push_measured").described("from the latest joint readings; a force alone"),
    wrench("push/estimated", "push_estimate", "push_moment_estimate").described(
        "after the low-pass filter; its moment, as that of `push/true`, about the vehicle's centre of mass"
    ),
    force("push/filtered", "push_filtered").described(
        "after the low-pass filter of interactive guidance, less its bias; a force alone"
    ),
    point_on_beam("push/point", "push_point_estimate").described("place of the push on the beam"),
    wrench("disturbance", "disturbance_force", "disturbance_moment").described("estimate of the disturbance observer"),
    motion_readings("measured/odometry").described(
        "readings of the motion measurement, which reads no angular velocity (NaN); stamped when it took them"
    ),
    as_recorded("measured/imu", IMU, PAYLOAD, "measured_rates", "measured_specific_force")
    ._replace(stamp="imu_stamp")
    .described("readings, stamped when the imu took them; its covariance says that it has no orientation"),
    odometry("estimated/odometry", "estimated_").described("the pilot's estimate, stamped when it uses it"),
    as_recorded("wind/velocity", VECTOR, WORLD, "wind_velocity").described("velocity of the air [m/s]"),
    force("wind/force", "wind_force").described("force of the air on all parts together; a force alone"),
    force("contact/force", "contact_force").described("force of floor and walls; a force alone"),
)
JOINTS = (
    ("wrench", "joint_force", "joint_torque", "force and torque of the quadrotor on the payload"),
    (
        "measured",
        "measured_joint_force",
        "measured_joint_torque",
        "readings of the force sensor there, stamped when it took them",
    ),
)
ELSEWHERE = {"euler", *STAMP}.union(
    *(recipe.needs for recipe in (*ALWAYS, *SOMETIMES)), *(names[1:3] for names in JOINTS)
)
PILOT = tuple(name for name in CHANNELS if name not in ELSEWHERE)
"""Channels without a topic of their own, which topic `pilot` has by their names.

`euler` repeats `attitude`, and stamps of readings are in the headers.
"""


def all_recipes(has: Container[str], vehicle: Vehicle) -> Iterator[Recipe]:
    """The recipes of a flight with these channels: those of every flight, and further ones."""
    yield from ALWAYS
    numbers = range(1, vehicle.count + 1)
    true, measured = ([joint_wrench(i, *names).described(what) for i in numbers] for *names, what in JOINTS)
    measured = [r._replace(stamp="joints_stamp") for r in measured]
    yield from true
    yield from (r for r in (*SOMETIMES, *measured) if all(name in has for name in r.needs))
    if known := tuple(name for name in PILOT if name in has):
        yield values("pilot", known, vehicle).described("channels without a topic of their own, by name, in `position`")


def recipes_for(flight: Flight, vehicle: Vehicle) -> list[Recipe]:
    """The recipes of all topics with a message for each sample, by their full names."""
    rotors = tuple(f"rotor_{1 + i // 4}_{1 + i % 4}" for i in range(vehicle.rotor_count))
    return [
        r._replace(name=f"{ROOT}/{r.name}", labels=r.labels or (rotors if r.kind == ROTORS else ()))
        for r in all_recipes(flight, vehicle)
    ]


def topics_from(flight: Flight, vehicle: Vehicle) -> list[Topic]:
    """All topics of a flight that have a message for each sample.

    Raises:
        InputError: the flight lacks a channel that every flight has, or one is of a wrong size.
    """
    take = Source(flight, vehicle)
    return [
        Topic(r.name, r.kind, r.frame, r.rows(take), r.labels, flight.get(r.stamp))
        for r in recipes_for(flight, vehicle)
    ]
