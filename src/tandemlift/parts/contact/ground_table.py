"""The floor of a mission, `[ground]`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tandemlift.core.keys import Positive, Table, key


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
