"""What surrounds the vehicle: wind and ground. Walls and corridor are in `corridor`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tandemlift.core.settings.key_description import key
from tandemlift.core.settings.value_types import NonNegative, PerAxis, Positive, Table

Speed = Annotated[float, Field(ge=-1e3, le=1e3)]  # m/s, along an axis
Speeds = tuple[Speed, Speed, Speed]
Turbulence = Annotated[float, Field(ge=0.0, le=1e3)]  # m/s
Airspeed = Annotated[float, Field(ge=0.01, le=1e3)]  # m/s


class GustTable(Table):
    """`[[wind.gusts]]`: gusts on top of the mean wind, one table each, as in MIL-F-8785C, 3.7.3."""

    velocity: Annotated[Speeds, PerAxis(3, single=False)] = key(
        ..., "m/s", "peak velocity of the gust, world axes", example=[2.0, 0.0, 0.0]
    )
    start: float = key(..., "s", "time at which the gust begins to rise", example=12.0)
    rise: Positive = key(..., "s", "time in which the gust rises as 1 − cos, and in which it falls again", example=1.0)
    hold: NonNegative | None = key(None, "s", "time for which the gust holds its peak", unset="it stays", example=2.0)


class WindTable(Table):
    """`[wind]`: moving air, which drags payload and quadrotors quadratically; the pilot does not know of it.

    Gusts and Dryden turbulence are those of MIL-F-8785C.
    """

    model: Literal["none", "air"] = key(
        "none", None, "model of the wind", choices={"none": "no moving air", "air": "moving air with drag"}
    )
    velocity: Annotated[Speeds, PerAxis(3)] = key((0.0, 0.0, 0.0), "m/s", "mean velocity, world axes")
    turbulence: Turbulence = key(
        0.0,
        "m/s",
        "wind at 20 ft whose turbulence it is: 7.7 is light, 15.4 moderate, 0 none",
    )
    height: Positive = key(
        3.048,
        "m",
        "height above ground for the turbulence's scales; outside the standard's 3.048 to 304.8 its nearer end counts",
        source="10 ft, where the standard begins",
    )
    airspeed: Airspeed | None = key(
        None,
        "m/s",
        "speed at which the turbulence passes the vehicle",
        unset="that of the mean wind, at least 0.5",
        example=3.0,
    )
    density: Annotated[Positive, Field(le=1e4)] = key(
        1.225, "kg/m³", "density of the air", source="standard atmosphere at sea level"
    )
    gusts: tuple[GustTable, ...] = ()


class GroundTable(Table):
    """`[ground]`: a level floor with friction. Feet stand on it; rotors, guards and beam touch it in all attitudes.

    A rotor that touches floor or wall stops for the rest of the flight.
    """

    model: Literal["none", "floor"] = key(
        "none", None, "model of the ground", choices={"none": "no ground", "floor": "a level floor"}
    )
    height: float | None = key(
        None,
        "m",
        "height z of the floor",
        rule="the vehicle starts at most 0.02 m deep in it",
        unset="such that the level vehicle stands on it at the start",
        example=-0.1688,
    )
    sinkage: Annotated[Positive, Field(le=0.1)] = key(
        5e-4,
        "m",
        "depth of the feet in the floor under the vehicle's weight; a long step makes the floor softer",
        source="chosen",
    )
    friction: Annotated[float, Field(ge=0.0, le=100.0)] = key(
        0.8, "1", "coefficient of friction of floor and walls", source="chosen: rubber on a dry floor"
    )
    effect: bool = key(
        False,
        None,
        'true: more thrust near the floor (Cheeseman and Bennett, 1955); needs `actuators.model = "rotors"`',
    )
