"""A person who guides the vehicle by hand: where to, how, how strong, and how late."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tandemlift.settings.corridor import Point2
from tandemlift.settings.leaves import NonNegative, Positive, Table

Late = Annotated[float, Field(ge=0.0, le=1.0)]  # s
Share = Annotated[float, Field(ge=0.0, le=1.0)]


class WaypointTable(Table):
    """One of `[[partner.path]]`: a place to bring the vehicle to, in a straight line from the one before."""

    point: Point2  # m, x and y, of what is steered
    rise: float = 0.0  # m, above the height of flight
    heading: float | None = None  # rad, of the vehicle on the way there, by two hands; as before if not given
    dwell: NonNegative = 0.0  # s, that it is kept there


class PartnerTable(Table):
    """`[partner]`: a person who sees the vehicle late, and pushes it along a path."""

    model: Literal["none", "pull", "steer", "two-hands", "hold", "grab"] = "none"
    grip: float = 0.0  # m, along body y from the payload's centre, of one hand
    stiffness: Positive = 10.0  # N/m, between the hand and the grip
    damping: NonNegative = 1.0  # N s/m, likewise
    lag: Annotated[float, Field(gt=0.0, le=1.0)] = 0.1  # s, of muscles: each of two equal time constants
    delay: Late = 0.2  # s, from what is seen to what is done
    tremor: NonNegative = 0.05  # N, standard deviation along each axis, 8 to 12 Hz
    max_force: Positive = 8.0  # N
    max_couple: NonNegative = 0.8  # N m, of two hands about the vertical
    speed: Positive = 1.0  # m/s, that is aimed at
    gain: Positive = 3.0  # N s/m, force over what the speed lacks
    look_ahead: Positive = 1.0  # m, along the path
    approach: Positive = 0.8  # 1/s, speed aimed at over the way that is left to a stop
    breakaway: NonNegative = 0.3  # N, that it takes to move the vehicle: known to the person, who adds it
    trimming: NonNegative = 0.5  # 1/s, at which force wanted across the path becomes habit
    corner: Positive = 0.5  # m, before a waypoint, where the next leg is taken up
    arrive: Positive = 0.3  # m, from a waypoint with a dwell, and from the last one, where it is reached
    slow: Positive = 0.1  # m/s, below which the person lets it land
    turn_gain: NonNegative = 1.5  # N m/rad, of two hands
    turn_damping: NonNegative = 2.0  # N m s
    start: NonNegative = 0.0  # s, before which the person does not push
    height_share: Share = 0.9  # of the lift, below which the person does not push
    path: tuple[WaypointTable, ...] = ()  # the corridor's centreline if empty
    recording: str | None = None  # of "grab": the file that says, step by step, where the hand is
