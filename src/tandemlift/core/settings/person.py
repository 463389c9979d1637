"""A person who guides the vehicle by hand: where to, how, how strong, and how late."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tandemlift.core.settings.corridor import Point2
from tandemlift.core.settings.key_description import key
from tandemlift.core.settings.value_types import NonNegative, Positive, Table

Late = Annotated[float, Field(ge=0.0, le=1.0)]  # s
Share = Annotated[float, Field(ge=0.0, le=1.0)]

FITS = "chosen"


class WaypointTable(Table):
    """`[[person.path]]`: waypoints, one table each, joined by straight lines."""

    point: Point2 = key(
        ..., "m", "x and y, of the grip for 'pull' and 'hold', otherwise of the centre of mass", example=[5.0, 0.0]
    )
    rise: float = key(0.0, "m", "height above the height of flight")
    heading: float | None = key(
        None,
        "rad",
        "heading of the vehicle on the way there; only model 'two-hands' turns it",
        unset="the heading stays as before",
        example=0.0,
    )
    dwell: NonNegative = key(0.0, "s", "time for which the person keeps the vehicle there")


class PersonTable(Table):
    """`[person]`: a person in the loop, who sees the vehicle late and leads it by hand along a path.

    What the person sees is `delay` old. The person predicts from it where the vehicle is now, and wants a force of
    `gain` times the speed that is missing towards the point of the path that lies `look_ahead` farther on. The hand
    moves to where the arm's `stiffness` gives this force, through the muscles' `lag`; stiffness and damping act between
    hand and grip without delay. The person begins after `start_time`, once the vehicle has been lifted. At the last
    waypoint, when the vehicle is slow, the person asks to land (a pilot with `guidance = "interactive"` obeys) and lets
    go.

    Model "virtual-hand" is a hand that is moved from outside. It holds on to a point of the vehicle by a spring of
    `stiffness` to a target, smoothed by twice `lag`, brakes that point by `damping`, or pushes with a given force,
    always within `max_force`; the other keys do not apply. Its movement is the file `recording`, a NumPy archive (.npz)
    with `engine` (the engine that was flown in, the default of `tandemlift run`), `step` (n,) int64, rising, and `hand`
    (n, 14) float64, which holds from that step on: holding on (1 or 0); grip [m, body axes, from the centre of mass];
    its target [m] and a force [N], world axes; requests to lift, to land and to stop; whether the vehicle may respond
    to a push.
    """

    model: Literal["none", "pull", "steer", "two-hands", "hold", "virtual-hand"] = key(
        "none",
        None,
        "who guides the vehicle by hand, and what the person leads along the path",
        rule='"pull" to "hold" need [[person.path]] or a corridor',
        choices={
            "none": "no person",
            "pull": "one hand leads the grip, and the vehicle follows like a trailer",
            "steer": "one hand at the grip leads the centre of mass",
            "two-hands": "two hands lead the payload's centre and turn the vehicle to each leg's heading",
            "hold": "the hand goes to the waypoints and stays there, whatever is seen: for tests of passivity",
            "virtual-hand": "a hand that is moved from outside, as by the live page or a recording",
        },
    )
    grip: float = key(
        0.0,
        "m",
        "where one hand holds the payload, along body y from the payload's centre",
        rule="on the payload",
    )
    stiffness: Positive = key(10.0, "N/m", "stiffness of the arm between hand and grip", source="chosen: a light hold")
    damping: NonNegative = key(1.0, "N s/m", "damping of the arm between hand and grip", source="chosen: a light hold")
    lag: Annotated[float, Field(gt=0.0, le=1.0)] = key(
        0.1, "s", "lag of the muscles: two equal time constants of this size", source="chosen"
    )
    delay: Late = key(
        0.2,
        "s",
        "delay from what is seen to what is done, rounded to whole steps, at least one",
        rule="at most 10,000 steps",
        source="chosen: about a visual reaction time",
    )
    tremor: NonNegative = key(
        0.05,
        "N",
        "standard deviation of the hand's tremor along each axis, nine tenths of it between 8 Hz and 12 Hz",
        source="band: Elble and Randall, 1978; size chosen",
    )
    max_force: Positive = key(8.0, "N", "largest force of the person", source=FITS)
    max_couple: NonNegative = key(0.8, "N m", "largest couple of two hands about the vertical", source=FITS)
    speed: Positive = key(
        1.0, "m/s", "speed that the person aims at; the vehicle is slower by what the force needs", source=FITS
    )
    gain: Positive = key(3.0, "N s/m", "force for each m/s of speed that is missing", source=FITS)
    look_ahead: Positive = key(1.0, "m", "distance along the path to the point that the person steers to", source=FITS)
    approach_gain: Positive = key(0.8, "1/s", "speed aimed at near a stop, over the distance left", source=FITS)
    breakaway_force: NonNegative = key(
        0.3,
        "N",
        "force that is needed to move the vehicle, which the person knows and adds",
        source="the threshold of the paper mission's admittance",
    )
    trim_rate: NonNegative = key(
        0.5,
        "1/s",
        "rate of the person's integral action, against wind: across the path, and near a stop in all directions",
        source=FITS,
    )
    corner_distance: Positive = key(
        0.5, "m", "distance to a waypoint at which the person turns to the next leg", source=FITS
    )
    arrival_radius: Positive = key(0.3, "m", "distance to a stop at which it counts as reached", source=FITS)
    landing_speed: Positive = key(
        0.1, "m/s", "speed at the last waypoint below which the person asks to land", source=FITS
    )
    yaw_gain: NonNegative = key(1.5, "N m/rad", "couple of two hands for each rad of heading error", source=FITS)
    yaw_damping: NonNegative = key(2.0, "N m s", "couple of two hands against the yaw rate", source=FITS)
    start_time: NonNegative = key(
        0.0, "s", "time before which the person does not push", rule="after the tare, or a warning says so"
    )
    height_fraction: Share = key(
        0.9, "1", "fraction of the lift's height below which the person does not push", source=FITS
    )
    path: tuple[WaypointTable, ...] = ()
    recording: str | None = key(
        None,
        None,
        'file of a recorded hand, for model "virtual-hand"; its path is relative to the mission file',
        unset="the hand does not hold the vehicle",
        example="hand.npz",
    )
