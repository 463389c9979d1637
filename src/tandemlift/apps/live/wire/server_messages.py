"""What the server says to a page, besides frames. Each message is a JSON object with a `type`."""

from __future__ import annotations

from typing import Annotated, Literal, NotRequired, TypedDict, get_args, get_type_hints

from tandemlift.apps.live.wire.quantities import ParameterValue, Phase, Seconds
from tandemlift.apps.live.wire.scene import FlightScene, SceneEnding

THRESHOLD, STIFFNESS, MAX_FORCE = "admittance.threshold", "person.stiffness", "person.max_force"
SHOWN_PARAMETERS = {"THRESHOLD": THRESHOLD, "STIFFNESS": STIFFNESS, "MAX_FORCE": MAX_FORCE}  # the page draws these


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


class StatusFinding(TypedDict):
    """Something that went badly in the flight so far."""

    kind: Annotated[str, "as in docs/reference/outcomes.md"]
    time: Annotated[Seconds, "when it began"]
    text: str


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
    refusals: Annotated[StatusRefusals, "why a request would be refused right now, and what to do"]
    ending: Annotated[SceneEnding | None, "why the flight was stopped before its end; null unless it was"]
    findings: NotRequired[Annotated[list[StatusFinding], "what went badly so far; a server forms it once a second"]]
    preparing: NotRequired[Annotated[PreparationStatus, "before the first step"]]


class SceneMessage(FlightScene):
    """The scene: on connecting, after a reset, and when the set of parameters changes."""

    type: Literal["scene"]


class StatusMessage(FlightStatus):
    """The status: on connecting and four times a second."""

    type: Literal["status"]
    viewers: Annotated[int, "pages that are connected"]
    holder: Annotated[Literal["you", "other", "none"], "who holds the beam"]
    last_grab: Annotated[int, "`seq` of this page's last `grab` that came before the status; 0 if none did"]


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
    """To the page that asked: `save` or `tare` is done."""

    type: Literal["done"]
    what: Literal["save", "tare"]
    detail: Annotated[str, "the folder, or the time of the tare"]


class PongMessage(TypedDict):
    """To the page that asked: the answer to `ping`."""

    type: Literal["pong"]
    t: Annotated[float, "as it came"]


Answer = ChangedMessage | RefusedMessage | DoneMessage | SceneMessage
ServerMessage = SceneMessage | StatusMessage | ChangedMessage | RefusedMessage | DoneMessage | PongMessage
SERVER_MESSAGES: dict[str, type] = {get_args(get_type_hints(kind)["type"])[0]: kind for kind in get_args(ServerMessage)}
