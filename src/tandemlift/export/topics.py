"""The topics of an exported flight: name, message type, frame, and the numbers of every message.

A topic whose channels a flight does not have is left out, unless every flight has them. Names are below `/tandemlift/`;
`/tf`, `/tf_static` and `/diagnostics` are where ROS tools look for them.
"""

from __future__ import annotations

from collections.abc import Container, Iterator

from tandemlift.export.coordinate_frames import BASE, PAYLOAD, WORLD
from tandemlift.export.recipes import (
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
    odometry,
    point_on_beam,
    pose_of_reference,
    values,
    wrench,
)
from tandemlift.flight.channels import CHANNELS
from tandemlift.flight.record import Flight
from tandemlift.vehicle import Vehicle

ROOT = "/tandemlift"
ALWAYS = (
    odometry("odometry"),
    pose_of_reference("reference/pose"),
    as_recorded("reference/velocity", VECTOR, WORLD, "reference_velocity"),
    as_recorded("reference/acceleration", VECTOR, WORLD, "reference_acceleration"),
    as_recorded("admittance/position", POINT, WORLD, "admittance_position"),
    as_recorded("admittance/velocity", VECTOR, WORLD, "admittance_velocity"),
    as_recorded("admittance/acceleration", VECTOR, WORLD, "admittance_acceleration"),
    wrench("push/true", "push_force", "push_moment"),
    force("push/gated", "admittance_force"),
    command("command/wrench", "thrust", "moment"),
    as_recorded("rotors/thrusts", ROTORS, BASE, "rotor_thrusts"),
)
SOMETIMES = (
    as_recorded("rotors/commands", ROTORS, BASE, "rotor_commands"),
    command("command/allocated", "allocated_thrust", "allocated_moment"),
    force("push/measured", "push_measured"),
    wrench("push/estimated", "push_estimate", "push_moment_estimate", lambda v: -v.center_of_mass),
    force("push/filtered", "push_filtered"),
    point_on_beam("push/point", "push_point_estimate"),
    wrench("disturbance", "disturbance_force", "disturbance_moment"),
    odometry("measured/odometry", "measured_"),
    as_recorded("measured/imu", IMU, PAYLOAD, "measured_rates", "measured_specific_force"),
    odometry("estimated/odometry", "estimated_"),
    as_recorded("wind/velocity", VECTOR, WORLD, "wind_velocity"),
    force("wind/force", "wind_force"),
    force("contact/force", "contact_force"),
)
JOINTS = (
    ("wrench", "joint_force", "joint_torque"),
    ("measured", "measured_joint_force", "measured_joint_torque"),
)
ELSEWHERE = {"euler"}.union(*(recipe.needs for recipe in (*ALWAYS, *SOMETIMES)), *(names for _, *names in JOINTS))
PILOT = tuple(name for name in CHANNELS if name not in ELSEWHERE)
"""Channels without a topic of their own, which topic `pilot` has by their names; `euler` is what `attitude` is."""


def all_recipes(has: Container[str], vehicle: Vehicle) -> Iterator[Recipe]:
    """How all topics of a flight of these channels are made: what every flight has, and what else it has."""
    yield from ALWAYS
    true, measured = ([joint_wrench(i, *names) for i in range(1, vehicle.count + 1)] for names in JOINTS)
    yield from true
    yield from (r for r in (*SOMETIMES, *measured) if all(name in has for name in r.needs))
    if known := tuple(name for name in PILOT if name in has):
        yield values("pilot", known, vehicle)


def recipes_for(flight: Flight, vehicle: Vehicle) -> list[Recipe]:
    """How all topics of a flight are made that have a message for each sample; their names are whole."""
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
    return [Topic(r.name, r.kind, r.frame, r.rows(take), r.labels) for r in recipes_for(flight, vehicle)]
