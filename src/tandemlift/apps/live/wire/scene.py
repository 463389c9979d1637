"""The scene: what a page must know of a mission before frames mean anything. SI units.

All of the vehicle is in body axes from its centre of mass, with the beam along y; the rest is in world axes, z up. The
vehicle is the nominal one that the pilot is designed for.
"""

from __future__ import annotations

from typing import Annotated, Literal, NotRequired, TypedDict

from pydantic import Field

from tandemlift.apps.live.wire.frames import FIELD_NAMES
from tandemlift.apps.live.wire.quantities import (
    BodyPosition,
    Metres,
    Newtons,
    OneOf,
    ParameterValue,
    Phase,
    Seconds,
    Three,
    WorldPosition,
)

Ground = Annotated[list[float], Field(min_length=2, max_length=2), "x, y, m, world axes"]
FrameFieldName = Annotated[str, OneOf("FrameFieldName", FIELD_NAMES)]


class SceneShape(TypedDict):
    """A part of the vehicle as drawn."""

    kind: Literal["box", "sphere", "cylinder"]
    size: Annotated[list[float], "edges of a box, radius of a sphere, radius and length of a cylinder, m"]
    position: Annotated[BodyPosition, "of its centre"]
    axes: Annotated[list[float], "columns of its rotation to body axes (9); a cylinder lies along its z"]
    color: Annotated[str, "#rrggbb"]


class SceneRotor(TypedDict):
    """A rotor."""

    position: BodyPosition
    spin: Annotated[int, "1 or -1: sign of its reaction torque about body z"]
    radius: Metres
    max_thrust: Newtons
    blades: Annotated[SceneShape, "as it stands still"]
    disc: Annotated[SceneShape, "as it turns, transparent"]


class SceneQuadrotor(TypedDict):
    """A quadrotor."""

    position: BodyPosition
    guard: Annotated[Metres, "radius of the sphere that touches walls"]
    rotors: list[SceneRotor]


class ScenePayload(TypedDict):
    """The payload as it can be held: a beam along body y."""

    position: BodyPosition
    length: Metres
    width: Metres
    height: Metres


class SceneVehicle(TypedDict):
    """The whole vehicle."""

    quadrotors: list[SceneQuadrotor]
    payload: ScenePayload
    shapes: Annotated[list[SceneShape], "all that does not turn"]
    mass: Annotated[float, "kg"]


class SceneWall(TypedDict):
    """A wall."""

    center: WorldPosition
    size: Annotated[Three, "length, thickness, height, m"]
    heading: Annotated[float, "of its length from world x, rad"]


class SceneCorridor(TypedDict):
    """A corridor."""

    centreline: list[Ground]
    width: Metres
    height: Metres


class SceneSpring(TypedDict):
    """A spring with a damper."""

    stiffness: Annotated[float, "N/m"]
    damping: Annotated[float, "N s/m"]
    max_force: Newtons


class SceneParameter(TypedDict):
    """A parameter."""

    key: Annotated[str, "dotted key of the mission"]
    label: str
    group: str
    value: ParameterValue
    initial: NotRequired[Annotated[ParameterValue, "the mission's value, which `restore` sets"]]
    unit: NotRequired[str]
    min: NotRequired[float]
    max: NotRequired[float]
    choices: NotRequired[Annotated[list[str], "in place of bounds"]]


class SceneEnding(TypedDict):
    """Why a flight was stopped before its end."""

    outcome: Annotated[Phase, "`crashed`, `diverged`, or `failed` where the engine was lost"]
    text: Annotated[str, "names outcome, time, quantity, value and limit"]
    time: Seconds
    place: Annotated[WorldPosition | None, "of the vehicle; null if that is not known"]


class SceneReplay(TypedDict):
    """A span of time."""

    start: Seconds
    end: Seconds
    speed: Annotated[float, "flight time over wall time"]
    ending: Annotated[SceneEnding | None, "why it was stopped before its end; null unless it was"]


class FlightScene(TypedDict):
    """Everything about a flight that does not change from frame to frame."""

    mission: Annotated[str, "name of the mission"]
    engine: Annotated[str, "where the body is simulated"]
    version: Annotated[str, "of tandemlift"]
    step: Annotated[Seconds, "of the simulation"]
    rate: Annotated[float, "frames a second, at most"]
    vehicle: Annotated[SceneVehicle, "in body axes, from its centre of mass"]
    ground: Annotated[bool, "whether there is a floor to land on"]
    floor: Annotated[Metres, "height of the floor, or of the level that is drawn in its place"]
    walls: Annotated[list[SceneWall], "upright boxes"]
    corridor: Annotated[SceneCorridor | None, "drawn on the floor"]
    threshold: Annotated[Three, "push on each axis below which nothing moves, N"]
    spring: Annotated[SceneSpring, "of the virtual hand by which a page pulls"]
    phases: Annotated[list[Phase], "names of the phases by their number"]
    alarms: Annotated[list[str], "names of the alarms by their number; empty for no alarm"]
    fields: Annotated[list[tuple[FrameFieldName, int]], "name and number of columns of each field of a frame"]
    parameters: Annotated[list[SceneParameter], "what may be changed in flight"]
    replay: NotRequired[Annotated[SceneReplay, "span of a saved flight"]]
