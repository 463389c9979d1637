"""The vehicle: quadrotors and drag beside the payload; differences of the real body from the modelled one."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from tandemlift.core.keys import (
    Exactly3,
    Length,
    NonNegative,
    NonNegative3,
    PerAxis,
    Positive,
    Positive6,
    Scale,
    Share,
    Size,
    Table,
    Triple,
    key,
    must,
)
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.bodies import Metre, Place
from tandemlift.parts.mechanics.payload import Areas, Inertia, Payload

Corner = Annotated[tuple[Metre, Metre], PerAxis(2, single=False)]
Turns = Literal[-1, 1]
Heading = Annotated[float, Field(ge=-6.2832, le=6.2832)]  # rad, within a whole turn either way
COINCIDING = 1e-3  # m


class DisturbanceTable(Table):
    """`[disturbance]`: a constant force and moment that are unknown to the pilot."""

    force: Exactly3 = key((0.0, 0.0, 0.0), "N", "force at the modelled centre of mass, world axes")
    moment: Exactly3 = key((0.0, 0.0, 0.0), "N m", "moment, body axes")


class PlantTable(Table):
    """`[plant]`: differences of the real body from the pilot's model."""

    mass_scale: Scale = key(1.0, "1", "real mass over the modelled mass", source="the model is right")
    inertia_scale: Annotated[tuple[Scale, Scale, Scale], PerAxis(3)] = key(
        (1.0, 1.0, 1.0), "1", "real over modelled inertia, about each body axis", source="the model is right"
    )
    center_of_mass_offset: Place = key(
        (0.0, 0.0, 0.0),
        "m",
        "real centre of mass of the vehicle from the modelled one, body axes: the payload's mass is off its place",
        source="the model is right",
        example=[0.0, 0.02, 0.0],
    )
    thrust_scale: Scale = key(
        1.0,
        "1",
        "real thrust over the modelled one, of each rotor at any speed, the largest too",
        source="the model is right",
        rule="1 for ideal rotors",
    )


class Quadrotor(
    Table,
    keys_act={
        "thrust_constant max_speed max_thrust lag_up lag_down": 'actuators.model = "rotors"',
        "drag_area drag_coefficient": 'wind.model = "air" or estimator.confirmation = "motion"',
        "feet_spread feet_depth rotor_radius rotor_height guard_radius": 'ground.model = "floor"',
        "joint_damping": "vehicle.quadrotors.0.joint_stiffness is given",
        "layout arm": "vehicle.quadrotors.0.rotor_positions is left out",
    },
):
    """`[[vehicle.quadrotors]]`: one table for each quadrotor, 1 to 64 of them, rigidly fixed to the payload.

    They are at least 1 mm apart, and no rotor strikes another. One with a `heading` is turned about body z, with all of
    its own but the thrust and the readings of its joint, which are along body axes. In keys, the first has number 0.
    """

    mass: Positive = key(..., "kg", "mass of the quadrotor", example=1.5)
    inertia: Inertia = key(
        ...,
        "kg m²",
        "principal moments of inertia about the quadrotor's centre of mass, along its own axes",
        rule="none above the sum of the other two",
        example=[0.029125, 0.029125, 0.055225],
    )
    position: Exactly3 = key(
        ...,
        "m",
        "position of the quadrotor's centre of mass from the payload's origin, body axes",
        example=[0.0, 1.0, 0.075],
    )
    heading: Heading = key(
        0.0,
        "rad",
        "angle from body x to the quadrotor's own x axis, about body z: of its rotors, feet, inertia and drag area",
        source="it faces along body x",
    )
    layout: Literal["+", "x"] = key(
        "x", None, "arrangement of the rotors", example="+", choices={"+": "at +x, +y, -x, -y", "x": "45° further"}
    )
    arm: Positive | None = key(
        None,
        "m",
        "distance from the quadrotor's centre of mass to each rotor",
        unset="rotor_positions must be given",
        example=0.25,
    )
    rotor_positions: tuple[Corner, Corner, Corner, Corner] | None = key(
        None,
        "m",
        "x and y of each rotor from the quadrotor's centre of mass, its own axes",
        rule="four pairs within ±1000, such that every moment can be produced",
        unset="by layout and arm",
        example=[[0.25, 0.0], [0.0, 0.25], [-0.25, 0.0], [0.0, -0.25]],
    )
    spins: tuple[Turns, Turns, Turns, Turns] = key(
        (1, -1, 1, -1),
        "1",
        "sign of each rotor's reaction torque on the body, about z",
        rule="each 1 or -1, such that every moment can be produced",
        source="neighbours turn in opposite directions",
    )
    thrust_constant: Positive = key(..., "N/(rad/s)²", "thrust of a rotor over its speed squared", example=5.84e-6)
    max_speed: Positive = key(..., "rad/s", "largest speed of a rotor", example=1100.0)
    max_thrust: Positive | None = key(
        None, "N", "in place of thrust_constant, max_speed or both", unset="thrust_constant · max_speed²", example=7.0
    )
    torque_per_thrust: Positive = key(..., "m", "reaction torque of a rotor over its thrust", example=0.06)
    lag_up: NonNegative = key(..., "s", "time constant of a rotor that speeds up", example=0.0125)
    lag_down: NonNegative = key(..., "s", "time constant of a rotor that slows down", example=0.025)
    rotor_radius: Length = key(
        0.128,
        "m",
        "radius of a rotor, for ground effect and contact with floor and walls",
        source="PX4's Gazebo model iris",
    )
    rotor_height: Metre = key(
        0.05,
        "m",
        "height of the rotors' hubs above the quadrotor's centre of mass, for contact with floor and walls",
        source="chosen: a fifth of an arm of 0.25 m, as the pictures show it",
    )
    joint: Place | None = key(
        None,
        "m",
        "position of the joint and its force sensor from the payload's origin, body axes",
        unset="below the quadrotor's centre of mass, at the height of the payload's origin",
        example=[0.0, 1.0, 0.0],
    )
    joint_stiffness: Positive6 | None = key(
        None,
        "N/m, N m/rad",
        "stiffness of the mount at the joint, along and about the body axes",
        rule="three of force [N/m], then three of moment [N m/rad]",
        unset="the mount is rigid",
        example=[2e4, 2e4, 1e4, 15.0, 15.0, 40.0],
    )
    joint_damping: Share = key(0.05, "1", "damping ratio of a mount that gives", source="rubber has 0.05 to 0.15")
    guard_radius: Length = key(
        0.375,
        "m",
        "radius of the guard about the quadrotor: of a ring to the floor, of a sphere to walls",
        source="chosen: arm and rotor",
    )
    feet_spread: Length = key(
        0.12, "m", "distance of each foot from the quadrotor's centre, along its x and y", source="chosen"
    )
    feet_depth: Length = key(
        0.18, "m", "distance of the soles below the quadrotor's centre", source="chosen: the beam stays off the floor"
    )
    drag_area: Areas = key(
        (0.02, 0.02, 0.05),
        "m²",
        "area seen along each of its own axes, for drag in moving air; along body axes what it has there",
        source="chosen: a body of 0.2 m by 0.1 m, and rotor discs that are mostly open",
    )
    drag_coefficient: Size = key(1.0, "1", "drag coefficient", source="chosen: a bluff body")

    @model_validator(mode="before")
    @classmethod
    def _speeds_of_thrust(cls, data: Any) -> Any:
        """Put constant and speed in the place of a largest thrust."""
        f, k, w = (isinstance(data, dict) and data.get(n) for n in ("max_thrust", "thrust_constant", "max_speed"))
        if not f or not all(one is None or (type(one) in (int, float) and one > 0.0) for one in (f, k, w)):
            return data  # what is no such number is refused by itself
        k = f / (w or 1000.0) ** 2 if k is None else k  # a speed that scales those of the rotor, not its flight
        if w and not math.isclose(k * w**2, f, rel_tol=1e-3):
            text = f"have a max_thrust that is thrust_constant · max_speed², here {k * w**2:.4g} N and not {f:g} N: "
            raise must("quadrotor", f"{text}leave one of the three out, or set max_speed = {math.sqrt(f / k):.5g}")
        return {**data, "max_thrust": None, "thrust_constant": k, "max_speed": w or math.sqrt(f / k)}

    @model_validator(mode="after")
    def _arms(self) -> Quadrotor:
        if self.arm is None and self.rotor_positions is None:
            raise must("quadrotor", "have either arm (and layout), or rotor_positions")
        return self

    @property
    def own_rotors(self) -> tuple[tuple[float, float], ...]:
        """Position (x, y) [m] of each rotor from the centre of mass, the quadrotor's own axes."""
        if self.rotor_positions is not None:
            return self.rotor_positions
        arm = 0.0 if self.arm is None else self.arm
        if self.layout == "+":
            return ((arm, 0.0), (0.0, arm), (-arm, 0.0), (0.0, -arm))
        angles = [math.pi / 4 + i * math.pi / 2 for i in range(4)]
        return tuple((arm * math.cos(a), arm * math.sin(a)) for a in angles)

    @property
    def rotors(self) -> tuple[tuple[float, float], ...]:
        """Position (x, y) [m] of each rotor from the centre of mass, body axes."""
        return tuple(self._turned(x, y) for x, y in self.own_rotors)

    @property
    def feet(self) -> tuple[Triple, ...]:
        """The soles of its four feet from the centre of mass [m], body axes."""
        size, corners = self.feet_spread, ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))
        return tuple((*self._turned(x * size, y * size), -self.feet_depth) for x, y in corners)

    @property
    def tensor(self) -> Array:
        """Its tensor of inertia about its centre of mass [kg m²], body axes (3 × 3)."""
        return self._turned_tensor(self.inertia)

    @property
    def areas(self) -> Triple:
        """Areas [m²] of its drag along the body axes; of a turned one without the part across each axis."""
        x, y, z = np.diag(self._turned_tensor(self.drag_area)).tolist()
        return x, y, z

    def _turned(self, x: float, y: float) -> tuple[float, float]:
        """A place on its own axes [m] along the body axes."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        return (c * x - s * y, s * x + c * y) if self.heading else (x, y)

    def _turned_tensor(self, principal: Triple) -> Array:
        """The tensor (3 × 3) along the body axes of one that is diagonal along its own."""
        x, y, z = principal
        if not self.heading:
            return np.diag(principal)
        mean, half = 0.5 * (x + y), 0.5 * (x - y)
        c, s = half * math.cos(2.0 * self.heading), half * math.sin(2.0 * self.heading)
        return np.array([[mean + c, s, 0.0], [s, mean - c, 0.0], [0.0, 0.0, z]])

    @property
    def joint_position(self) -> Triple:
        """The place of its joint on the payload [m], from the payload's origin, body axes."""
        return (self.position[0], self.position[1], 0.0) if self.joint is None else self.joint

    @property
    def thrust_limit(self) -> float:
        """Largest thrust of one rotor [N]."""
        return self.thrust_constant * self.max_speed**2


class Drag(Table):
    """`[vehicle.drag]`: linear drag of the whole vehicle in air at rest; that of `[wind]` adds to it."""

    force: NonNegative3 = key((0.0, 0.0, 0.0), "N s/m", "drag on the velocity, along each world axis", example=0.006)
    moment: NonNegative3 = key((0.0, 0.0, 0.0), "N m s", "drag on the rates, about each body axis", example=0.006)


def _fleet(quadrotors: tuple[Quadrotor, ...]) -> tuple[Quadrotor, ...]:
    if not 1 <= len(quadrotors) <= 64:
        raise must("count", f"be 1 to 64 tables, here are {len(quadrotors)}")
    for i, q in enumerate(quadrotors):
        for j in range(i):
            if math.dist(q.position, quadrotors[j].position) < COINCIDING:
                raise must("count", f"differ in position, but numbers {j} and {i} are both at {list(q.position)}")
    return quadrotors


class VehicleTable(Table):
    """`[vehicle]`: the parts, from which mass, centre of mass and inertia of the whole are computed."""

    payload: Payload
    quadrotors: Annotated[tuple[Quadrotor, ...], AfterValidator(_fleet)]
    drag: Drag = Drag()
