"""The parts of the vehicle: payload, quadrotors, drag."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from tandemlift.settings.leaves import (
    Axes,
    Exactly3,
    Length,
    NonNegative,
    NonNegative3,
    Positive,
    Positive3,
    Size,
    Table,
    Triple,
    must,
)

COINCIDING = 1e-3  # m


def _principal(inertia: Triple) -> Triple:
    x, y, z = sorted(inertia)
    if z > (x + y) * (1.0 + 1e-9):
        raise must("inertia", "be principal moments of a body, none greater than the sum of the other two")
    return inertia


Inertia = Annotated[Positive3, AfterValidator(_principal)]
Areas = Annotated[tuple[Size, Size, Size], Axes(3)]


class Payload(Table):
    """`[vehicle.payload]`: a beam along body y, or any body with a mass and principal moments of inertia."""

    mass: Positive  # kg
    length: Positive | None = None  # m, along body y
    radius: Positive | None = None  # m
    inertia: Inertia | None = None  # kg m², about its centre of mass; a beam's if not given
    drag_area: Areas | None = None  # m², seen along each body axis; a beam's if not given
    drag_coefficient: Size = 1.0

    @model_validator(mode="after")
    def _complete(self) -> Payload:
        if self.inertia is None and (self.length is None or self.radius is None):
            raise must("payload", "have either inertia, or length and radius (of a beam)")
        return self

    @property
    def moments(self) -> Triple:
        """Principal moments [kg m²]: as given, or of a thin rod along y (m L²/12) with a solid section (m r²/2)."""
        if self.inertia is not None:
            return self.inertia
        length, radius = self.length or 0.0, self.radius or 0.0
        across = self.mass * length**2 / 12.0
        return (across, self.mass * radius**2 / 2.0, across)

    @property
    def areas(self) -> Triple:
        """Areas [m²] seen along the body axes: as given, or of a beam along y; zero for a payload without size."""
        if self.drag_area is not None:
            return self.drag_area
        length, radius = self.length or 0.0, self.radius or 0.0
        return (2.0 * radius * length, math.pi * radius**2, 2.0 * radius * length)


Metre = Annotated[float, Field(ge=-1e3, le=1e3)]
Corner = Annotated[tuple[Metre, Metre], Axes(2, single=False)]
Joint = Annotated[tuple[Metre, Metre, Metre], Axes(3, single=False)]
Turns = Literal[-1, 1]


class Quadrotor(Table):
    """One of `[[vehicle.quadrotors]]`: axes parallel to the vehicle's, rigidly fixed to the payload."""

    mass: Positive  # kg
    inertia: Inertia  # kg m², about its centre of mass
    position: Exactly3  # m, of its centre of mass from the payload's, body axes
    layout: Literal["+", "x"] = "x"
    arm: Positive | None = None  # m, from the centre of mass to each rotor
    rotor_positions: tuple[Corner, Corner, Corner, Corner] | None = None  # m, x and y; in place of layout and arm
    spins: tuple[Turns, Turns, Turns, Turns] = (1, -1, 1, -1)  # sign of each rotor's reaction torque about z
    thrust_constant: Positive  # N/(rad/s)²
    max_speed: Positive  # rad/s
    torque_per_thrust: Positive  # m
    lag_up: NonNegative  # s, time constant of spinning up
    lag_down: NonNegative  # s
    rotor_radius: Length = 0.128  # m
    joint: Joint | None = None  # m, from the payload's centre of mass, body axes; at z = 0 below it if not given
    guard_radius: Length = 0.375  # m, of the sphere that touches walls
    feet_spread: Length = 0.12  # m, of each foot from the centre of mass along x and along y
    feet_depth: Length = 0.18  # m, from the centre of mass down to the soles
    drag_area: Areas = (0.02, 0.02, 0.05)  # m², seen along each body axis
    drag_coefficient: Size = 1.0

    @model_validator(mode="after")
    def _arms(self) -> Quadrotor:
        if self.arm is None and self.rotor_positions is None:
            raise must("quadrotor", "have either arm (and layout), or rotor_positions")
        return self

    @property
    def rotors(self) -> tuple[tuple[float, float], ...]:
        """Position (x, y) [m] of each rotor from the centre of mass, body axes."""
        if self.rotor_positions is not None:
            return self.rotor_positions
        arm = self.arm or 0.0
        if self.layout == "+":
            return ((arm, 0.0), (0.0, arm), (-arm, 0.0), (0.0, -arm))
        angles = [math.pi / 4 + i * math.pi / 2 for i in range(4)]
        return tuple((arm * math.cos(a), arm * math.sin(a)) for a in angles)

    @property
    def joint_position(self) -> Triple:
        """Where it is fixed to the payload [m], from the payload's centre of mass, body axes."""
        return self.joint or (self.position[0], self.position[1], 0.0)

    @property
    def max_thrust(self) -> float:
        """Largest thrust of one rotor [N]."""
        return self.thrust_constant * self.max_speed**2


class Drag(Table):
    """`[vehicle.drag]`: linear drag, force on world velocity and moment on body rates."""

    force: NonNegative3 = (0.0, 0.0, 0.0)  # N s/m
    moment: NonNegative3 = (0.0, 0.0, 0.0)  # N m s


def _fleet(quadrotors: tuple[Quadrotor, ...]) -> tuple[Quadrotor, ...]:
    if not 1 <= len(quadrotors) <= 64:
        raise must("count", f"be 1 to 64 tables, here are {len(quadrotors)}")
    for i, q in enumerate(quadrotors):
        for j in range(i):
            if math.dist(q.position, quadrotors[j].position) < COINCIDING:
                raise must("count", f"differ in position, but numbers {j} and {i} are both at {list(q.position)}")
    return quadrotors


class VehicleTable(Table):
    """`[vehicle]`: the parts."""

    payload: Payload
    quadrotors: Annotated[tuple[Quadrotor, ...], AfterValidator(_fleet)]
    drag: Drag = Drag()
