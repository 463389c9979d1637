"""The messages of the server to a page besides frames: the scene, which gives frames their meaning, status and answers.

Each message is a JSON object with a `type`. SI units. All of the vehicle is in body axes from its centre of mass, with
the beam along y; the rest is in world axes, z up. The vehicle is the nominal one that the pilot is designed for.
"""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple, NotRequired, TypedDict, get_args, get_type_hints

from pydantic import Field

from tandemlift.apps.live.session.frames import FIELD_NAMES
from tandemlift.core.phases import ENDINGS, PHASE_NAMES

LOST = tuple(dict.fromkeys(kind.outcome for kind in ENDINGS))  # phases of a flight that was stopped before its end
ENDS = ("failed", *LOST, "over")  # phases of a flight that has ended; by an error, stopped, at its full length
PREPARING = "preparing"  # the phase before the first step
THRESHOLD, STIFFNESS, MAX_FORCE = "admittance.threshold", "person.stiffness", "person.max_force"
SHOWN_PARAMETERS = {"THRESHOLD": THRESHOLD, "STIFFNESS": STIFFNESS, "MAX_FORCE": MAX_FORCE}  # the page draws these


class OneOf(NamedTuple):
    """Mark of a text that is one of a few, with the name that TypeScript has for them."""

    name: str
    options: tuple[str, ...]


Three = Annotated[list[float], Field(min_length=3, max_length=3)]
BodyPosition = Annotated[Three, "m, body axes"]
WorldPosition = Annotated[Three, "m, world axes"]
Metres = Annotated[float, "m"]
Newtons = Annotated[float, "N"]
Seconds = Annotated[float, "s"]
ParameterValue = float | bool | str | list[float]
Phase = Annotated[str, OneOf("Phase", (*PHASE_NAMES, PREPARING, *ENDS))]
FrameFieldName = Annotated[str, OneOf("FrameFieldName", FIELD_NAMES)]


class SceneShape(TypedDict):
    """A part of the vehicle as drawn."""

    kind: Literal["box", "sphere", "cylinder", "hull"]
    size: Annotated[list[float], "edges of a box; radius of a sphere, and length of a cylinder; triangles' corners, m"]
    position: Annotated[BodyPosition, "of its centre"]
    axes: Annotated[list[float], "columns of its rotation to body axes (9); a cylinder lies along its z"]
    color: Annotated[str, "#rrggbb"]


class SceneRotor(TypedDict):
    """A rotor."""

    position: BodyPosition
    spin: Annotated[int, "1 or -1: sign of its reaction torque about body z"]
    radius: Metres
    max_thrust: Newtons
    max_speed: Annotated[float, "at that thrust, rad/s"]
    blades: Annotated[SceneShape, "as it stands still"]
    disc: Annotated[SceneShape, "as it turns, transparent"]


class SceneQuadrotor(TypedDict):
    """A quadrotor."""

    position: BodyPosition
    guard: Annotated[Metres, "radius of the sphere that touches walls"]
    rotors: list[SceneRotor]


class ScenePayload(TypedDict):
    """The payload as it can be held: a beam or a body along body y."""

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

    centreline: list[Annotated[list[float], Field(min_length=2, max_length=2), "x, y, m, world axes"]]
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


class SceneMission(TypedDict):
    """A mission that a page may choose."""

    name: str
    title: Annotated[str, "what it shows, in a line"]


class SceneEnding(TypedDict):
    """Why a flight was stopped before its end."""

    outcome: Annotated[Phase, "`crashed`, `diverged`, or `failed` where the engine was lost"]
    text: Annotated[str, "names outcome, time, quantity, value and limit"]
    time: Seconds
    place: Annotated[WorldPosition | None, "of the vehicle; null if that is not known"]


class StatusFinding(TypedDict):
    """Something that went badly in the flight so far."""

    kind: Annotated[str, "as in docs/reference/outcomes.md"]
    time: Annotated[Seconds, "when it began"]
    text: str


class SceneChange(TypedDict):
    """A setting that was changed in flight."""

    time: Seconds
    text: Annotated[str, "key and value"]


class SceneReplay(TypedDict):
    """A span of time."""

    start: Seconds
    end: Seconds
    speed: Annotated[float, "flight time over wall time"]
    ending: Annotated[SceneEnding | None, "why it was stopped before its end; null unless it was"]
    findings: NotRequired[list[StatusFinding]]
    changes: NotRequired[list[SceneChange]]


class FlightScene(TypedDict):
    """Everything about a flight that does not change from frame to frame."""

    mission: Annotated[str, "name of the mission"]
    controller: Annotated[str, "its name"]
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
    missions: NotRequired[Annotated[list[SceneMission], "that a page may `fly`"]]
    replay: NotRequired[Annotated[SceneReplay, "span of a saved flight"]]
    authority: NotRequired[Annotated[list[float], "of rotors in hover: across, up, down, N; about each axis, N m"]]


class PreparationStatus(TypedDict):
    """The preparation of a flight."""

    step: Annotated[str, "what is being done"]
    seconds: Annotated[Seconds, "since the preparation began"]
    failure: Annotated[str, "why the mission cannot be flown; empty unless that is so"]


class StatusRefusals(TypedDict):
    """Why a request would be refused right now, and what to do; each a sentence or two, empty if it would not."""

    lift: str
    land: str
    push: Annotated[str, "why a push is not followed"]


class StatusScore(TypedDict):
    """The score so far of a flight through a corridor by hand, as `tandemlift score` computes it."""

    start: Annotated[Seconds, "of the first push"]
    finished: Annotated[bool, "whether the end of the corridor was reached; then nothing changes any more"]
    refused: Annotated[str, "why it is not ranked; empty unless that is so"]
    time: Annotated[Seconds, "since the first push"]
    touches: Annotated[int, "of walls"]
    effort: Annotated[float, "N s"]
    jerk: Annotated[float, "logarithm of the dimensionless jerk"]
    score: Seconds


class FlightStatus(TypedDict):
    """The state of a flight in words, and how it keeps up with the clock."""

    phase: Annotated[Phase, "of the flight; before it `preparing`; at its end `over`, `crashed`, `diverged`, `failed`"]
    alarm: Annotated[str, "what has failed; empty if nothing has"]
    enabled: Annotated[bool, "whether the pilot follows pushes"]
    paused: Annotated[bool, "whether time stands still"]
    speed: Annotated[float, "flight time over wall time, as asked for"]
    factor: Annotated[float, "flight time over wall time, during the last second"]
    behind_ms: Annotated[float, "how late the flight was at most since the last status, ms"]
    recorded_s: Annotated[float, "length of the recording, s"]
    failed_rotors: Annotated[list[int], "rotors that have stopped for good, counted over the whole vehicle from 0"]
    tare_left_s: Annotated[float, "for how long nobody may touch it, as its force sensors are tared, s"]
    refusals: Annotated[StatusRefusals, "why a request would be refused right now, and what to do"]
    ending: Annotated[SceneEnding | None, "why the flight was stopped before its end; null unless it was"]
    findings: NotRequired[Annotated[list[StatusFinding], "what went badly so far; a server forms it once a second"]]
    score: NotRequired[Annotated[StatusScore, "in a corridor, once somebody pushed"]]
    preparing: NotRequired[Annotated[PreparationStatus, "before the first step"]]


class SceneMessage(FlightScene):
    """The scene: on connecting, after a reset, and when the set of parameters changes."""

    type: Literal["scene"]


class TurnStatus(TypedDict):
    """Turns of the pages at one flight."""

    number: Annotated[int, "of this page, from 1 on"]
    queue: Annotated[list[int], "numbers of the pages that take turns; the first has the hand"]


class StatusMessage(FlightStatus):
    """The status: on connecting and four times a second."""

    type: Literal["status"]
    viewers: Annotated[int, "pages that are connected"]
    holder: Annotated[Literal["you", "other", "none"], "who holds the beam"]
    last_grab: Annotated[int, "`seq` of this page's last `grab` that came before the status; 0 if none did"]
    turns: NotRequired[Annotated[TurnStatus, "whose turn it is, at a server"]]


class ChangedMessage(TypedDict):
    """To all: a parameter goes to a value within a duration."""

    type: Literal["changed"]
    key: str
    value: ParameterValue
    duration: Seconds


class RefusedMessage(TypedDict):
    """To the page that asked: why a message is refused."""

    type: Literal["refused"]
    what: Annotated[str, "type of the message and its key, if it has one"]
    reason: Annotated[str, "names the key, the value and what is allowed"]


class DoneMessage(TypedDict):
    """To the page that asked: `save`, `tare` or `fly` is done."""

    type: Literal["done"]
    what: Literal["save", "tare", "fly"]
    detail: Annotated[str, "the folder, the time of the tare, or the mission"]


class PongMessage(TypedDict):
    """To the page that asked: the answer to `ping`."""

    type: Literal["pong"]
    t: Annotated[float, "as it came"]


Answer = ChangedMessage | RefusedMessage | DoneMessage | SceneMessage
ServerMessage = SceneMessage | StatusMessage | ChangedMessage | RefusedMessage | DoneMessage | PongMessage
SERVER_MESSAGES: dict[str, type] = {get_args(get_type_hints(kind)["type"])[0]: kind for kind in get_args(ServerMessage)}
