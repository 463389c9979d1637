"""What the pilot does not know: the start, pushes, disturbances, real rotors and how they fail."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from tandemlift.core.settings.key_description import key
from tandemlift.core.settings.value_types import (
    Axes3,
    Delay,
    Exactly3,
    NonNegative,
    PerAxis,
    Positive,
    Scale,
    Table,
    Triple,
    must,
)

Fraction = Annotated[float, Field(ge=0.0, le=1.0)]


def _upright(euler: Triple) -> Triple:
    if abs(euler[0]) >= math.radians(85.0):
        raise must("roll", "have a roll (the first angle) within ±85° (±1.4835 rad), where the angles are regular")
    if abs(euler[1]) >= math.radians(85.0):
        raise must("pitch", "have a pitch (the second angle) within ±85° (±1.4835 rad), or the rotors push downwards")
    return euler


class InitialTable(Table):
    """`[initial]`: the state at the start, t = 0."""

    position: Axes3 = key(
        (0.0, 0.0, 0.0), "m", "position of the system's centre of mass, world axes", example=[0.3, -0.3, 0.0]
    )
    velocity: Axes3 = key((0.0, 0.0, 0.0), "m/s", "velocity of the system's centre of mass, world axes")
    euler: Annotated[Axes3, AfterValidator(_upright)] = key(
        (0.0, 0.0, 0.0),
        "rad",
        "roll, pitch and yaw; R = Rz(yaw) Rx(roll) Ry(pitch)",
        rule="roll and pitch within ±85°",
        example=[0.15, -0.15, 0.2],
    )
    rates: Axes3 = key((0.0, 0.0, 0.0), "rad/s", "angular velocity, body axes")


class PushTable(Table):
    """`[[pushes]]`: pushes of a person, one table each: force · exp(−(t − time)²/(2 sigma²))."""

    force: Exactly3 = key(..., "N", "peak force, world axes", example=[3.0, 0.0, 0.0])
    time: float = key(..., "s", "time of the peak", example=14.0)
    sigma: Positive = key(..., "s", "standard deviation σ of the push over time", example=0.6)
    point: Exactly3 = key(
        (0.0, 0.0, 0.0),
        "m",
        "point of application, body axes, from the system's centre of mass",
        rule="no farther away than the vehicle's farthest part",
    )


class DisturbanceTable(Table):
    """`[disturbance]`: a constant force and moment that the pilot does not know of."""

    force: Axes3 = key((0.0, 0.0, 0.0), "N", "force at the centre of mass, world axes")
    moment: Axes3 = key((0.0, 0.0, 0.0), "N m", "moment, body axes")


class PlantTable(Table):
    """`[plant]`: how the real body differs from the pilot's model of it."""

    mass_scale: Scale = key(1.0, "1", "real mass over the modelled mass", source="the model is right")
    inertia_scale: Annotated[tuple[Scale, Scale, Scale], PerAxis(3)] = key(
        (1.0, 1.0, 1.0),
        "1",
        "real inertia over the modelled inertia, about each body axis",
        source="the model is right",
    )


class ActuatorsTable(Table):
    """`[actuators]`: what the rotors do with a command."""

    model: Literal["ideal", "rotors"] = key(
        "ideal",
        None,
        "model of the rotors",
        choices={
            "ideal": "the commanded wrench acts exactly, and nothing is clamped",
            "rotors": "rotors with limits, lag and faults, which must be able to lift the vehicle's real weight",
        },
    )
    delay: Delay = key(
        0.0,
        "s",
        "delay from the command to the rotors, rounded to whole steps; for real rotors",
        rule="at most 10,000 steps",
    )
    start: Literal["hover", "stopped"] = key(
        "hover",
        None,
        "speed of the rotors at t = 0; for real rotors",
        choices={"hover": "that of hover", "stopped": "zero"},
    )


class FaultTable(Table):
    """`[[faults]]`: rotors that lose thrust, one table each, a rotor once; they need `actuators.model = "rotors"`."""

    quadrotor: Annotated[int, Field(ge=1, le=64)] = key(
        ..., "1", "number of the quadrotor, from 1", rule="at most the number of quadrotors", example=1
    )
    rotor: Annotated[int, Field(ge=1, le=4)] = key(
        ..., "1", "number of the rotor, in the order of layout or rotor_positions", example=1
    )
    time: NonNegative = key(..., "s", "start of the fault", example=15.0)
    efficiency: Fraction = key(0.0, "1", "fraction of the rotor's thrust that is left")
    known_after: NonNegative | None = key(
        None, "s", "delay until the 'constrained' allocation knows of it", unset="it never knows", example=0.05
    )
