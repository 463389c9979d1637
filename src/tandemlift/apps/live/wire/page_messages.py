"""What a page may say: one model a message, strict, finite and bounded.

Each is a JSON object of a `type` and a number `seq` that grows from message to message.
"""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from pydantic import BaseModel, ConfigDict, Field

from tandemlift.apps.live.wire.quantities import BodyPoint, Key, NewValue, Number, SaveName, WorldForce, WorldPoint

SILENT = 2.0  # s without a message, after which a page that holds the beam counts as hung


class NumberedMessage(BaseModel):
    """What all messages of a page have in common."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    seq: Annotated[int, Field(ge=0, le=10**15)]


class GrabMessage(NumberedMessage):
    """Hold the vehicle at a point or at its centre of mass, and pull it to a target by a spring."""

    type: Literal["grab"] = "grab"
    point: Annotated[BodyPoint, "where the cursor takes hold"]
    target: Annotated[WorldPoint, "where the point is to be"]
    at: Annotated[Literal["point", "centre"], "whether the spring pulls at the point or at the centre of mass"]


class MoveMessage(NumberedMessage):
    """Pull to another target; ignored unless this page holds the beam."""

    type: Literal["move"] = "move"
    target: WorldPoint


class ReleaseMessage(NumberedMessage):
    """Let go of the beam."""

    type: Literal["release"] = "release"


class ForceMessage(NumberedMessage):
    """Push with a force, as a keyboard or a gamepad does; a force of zero lets go."""

    type: Literal["force"] = "force"
    force: WorldForce
    point: Annotated[BodyPoint, "where it acts"]


class SetMessage(NumberedMessage):
    """Change a parameter."""

    type: Literal["set"] = "set"
    key: Key
    value: NewValue


class RestoreMessage(NumberedMessage):
    """Set a parameter back to the mission's value; without a key, all of them."""

    type: Literal["restore"] = "restore"
    key: Key | None = None


class AskMessage(NumberedMessage):
    """Ask the pilot to lift off, to land, or to stop all rotors."""

    type: Literal["ask"] = "ask"
    what: Literal["lift", "land", "stop"]


class EnableMessage(NumberedMessage):
    """Let the pilot follow pushes, or not."""

    type: Literal["enable"] = "enable"
    on: bool


class TareMessage(NumberedMessage):
    """Tare the force sensors from a second later on; only in hover, without a push."""

    type: Literal["tare"] = "tare"


class KillMessage(NumberedMessage):
    """Stop a rotor for good."""

    type: Literal["kill"] = "kill"
    rotor: Annotated[int, Field(ge=0, le=255), "counted over the whole vehicle, from 0"]


class PauseMessage(NumberedMessage):
    """Stop time, or let it go on."""

    type: Literal["pause"] = "pause"
    on: bool


class SpeedMessage(NumberedMessage):
    """Fly slower than real time."""

    type: Literal["speed"] = "speed"
    factor: Annotated[float, Field(ge=0.1, le=1.0), "flight time over wall time"]


class ResetMessage(NumberedMessage):
    """Begin the flight again."""

    type: Literal["reset"] = "reset"


class SaveMessage(NumberedMessage):
    """Save what was flown so far."""

    type: Literal["save"] = "save"
    name: SaveName


class PingMessage(NumberedMessage):
    """Ask for a `pong`; a page that holds the beam says something every 2 s at least."""

    type: Literal["ping"] = "ping"
    t: Annotated[Number, "ms, by the page's clock; it comes back"]


BeamMessage = GrabMessage | MoveMessage | ReleaseMessage | ForceMessage
PageMessage = (
    BeamMessage
    | SetMessage
    | RestoreMessage
    | AskMessage
    | EnableMessage
    | TareMessage
    | KillMessage
    | PauseMessage
    | SpeedMessage
    | ResetMessage
    | SaveMessage
    | PingMessage
)
PAGE_MESSAGES: dict[str, type[NumberedMessage]] = {
    kind.model_fields["type"].default: kind for kind in get_args(PageMessage)
}
