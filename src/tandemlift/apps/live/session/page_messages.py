"""The messages of a page: one model each, strict, finite and bounded; and how a text is read as one.

Each message is a JSON object of a `type` and a number `seq` that grows from message to message. Refusals name the key,
the value and the allowed values. A text in an annotation says what a value is, with its unit and axes;
`tools/wire_types.py` copies it to the page's types and to the documentation. World axes have z up. Body axes begin at
the vehicle's centre of mass; the beam lies along y.
"""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError
from pydantic_core import from_json

from tandemlift.core.errors import InputError, shown, suggestion
from tandemlift.core.keys import must
from tandemlift.missions import problems_in

SILENT = 2.0  # s without a message, after which a page that holds the beam counts as hung
MAX_WORD = 100  # characters of a key or of a word
NAME_PATTERN = "[A-Za-z0-9][A-Za-z0-9._-]{0,63}"  # of the name of a saved flight
NAME_RULE = "be 1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit"
MAX_SIZE = 65_536  # bytes; a page that sends more is cut off
MAX_LENGTH = 4_096  # characters that are read: twice what the longest message without a file has
WITH_FILE = '{"type":"fly",'  # begins a message that may be as long as MAX_SIZE, as it has the content of a file
MAX_KEYS = 12
MAX_PARTS = 128  # values and tables that are read: more than any message has
MAX_FILE_PARTS = 4_608  # likewise, with those of a file: four times what a mission with every key has
_STRING = re.compile(r'"(?:[^"\\]|\\.)*+"?', re.DOTALL)  # also one without its end: no text is looked at twice


def _key(key: str) -> str:
    if len(key) > MAX_WORD or not re.fullmatch(r"[A-Za-z0-9_]+(\.[A-Za-z0-9_]+)*", key):
        raise must("key", f"be a dotted key of {MAX_WORD} characters at most, such as admittance.mass")
    return key


def _name(name: str) -> str:
    if not re.fullmatch(NAME_PATTERN, name):
        raise must("name", NAME_RULE)
    return name


def _mission(name: str) -> str:
    if not 0 < len(name) <= MAX_WORD or not name.isprintable() or "/" in name:
        raise must("name", f"be 1 to {MAX_WORD} characters without '/', such as hover or mine.toml")
    return name


def _word(word: str) -> str:
    if len(word) > MAX_WORD:
        raise must("word", f"have {MAX_WORD} characters at most")
    return word


Metre = Annotated[float, Field(ge=-1e4, le=1e4)]
Newton = Annotated[float, Field(ge=-1e3, le=1e3)]
Number = Annotated[float, Field(ge=-1e12, le=1e12)]
BodyPoint = Annotated[tuple[Metre, Metre, Metre], "m, body axes"]
WorldPoint = Annotated[tuple[Metre, Metre, Metre], "m, world axes"]
WorldForce = Annotated[tuple[Newton, Newton, Newton], "N, world axes"]
Key = Annotated[str, AfterValidator(_key)]
SaveName = Annotated[
    str, AfterValidator(_name), "1 to 64 letters, digits, `.`, `_` or `-`; the first a letter or a digit"
]
MissionName = Annotated[str, AfterValidator(_mission)]
Word = Annotated[str, AfterValidator(_word)]
NewValue = bool | Number | Word | Annotated[tuple[Number, ...], Field(max_length=64, fail_fast=True)]


class NumberedMessage(BaseModel):
    """The part that all messages of a page have in common."""

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
    """Push with a force, as a keyboard or a gamepad does, shake or tap with it; a force of zero lets go."""

    type: Literal["force"] = "force"
    force: WorldForce
    point: Annotated[BodyPoint, "where it acts"]
    frequency: Annotated[float, Field(ge=0.0, le=10.0), "Hz, of a shake with this force as its peak; else 0"] = 0.0
    duration: Annotated[float, Field(ge=0.0, le=1.0), "s, of a tap with this force; else 0"] = 0.0


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


class RewindMessage(NumberedMessage):
    """Fly again to a time with what was pushed and changed until then, and stand still there."""

    type: Literal["rewind"] = "rewind"
    time: Annotated[float, Field(ge=0.0, le=1e5), "s"]


class FlyMessage(NumberedMessage):
    """Fly another mission: a built-in one, or that of a file, which may extend a built-in one only."""

    type: Literal["fly"] = "fly"
    mission: Annotated[MissionName, "name of the mission, or of the file"]
    toml: Annotated[str | None, 'content of the file; the message must begin with `{"type":"fly",`'] = None


class CompareMessage(NumberedMessage):
    """Keep the flight as it is as a ghost under the same hand, change places with the ghost, or end it."""

    type: Literal["compare"] = "compare"
    what: Literal["keep", "swap", "end"]


class SaveMessage(NumberedMessage):
    """Save what was flown so far."""

    type: Literal["save"] = "save"
    name: SaveName


class TurnMessage(NumberedMessage):
    """Ask for the hand, which the other pages then wait for; or give it, or the place in the queue, away."""

    type: Literal["turn"] = "turn"
    what: Literal["ask", "give"]


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
    | RewindMessage
    | FlyMessage
    | CompareMessage
    | SaveMessage
    | TurnMessage
    | PingMessage
)
PAGE_MESSAGES: dict[str, type[NumberedMessage]] = {
    kind.model_fields["type"].default: kind for kind in get_args(PageMessage)
}
_ANY: TypeAdapter[Any] = TypeAdapter(Annotated[PageMessage, Field(discriminator="type")])


class Refusal(InputError):
    """A refused message: `what` is its subject; the text has the reason."""

    def __init__(self, what: str, reason: str) -> None:
        super().__init__(reason)
        self.what = what


def read_message(text: str | bytes) -> PageMessage:
    """The message in a text.

    Raises:
        Refusal: it is too long, no JSON, or breaks the schema; the reason names the key, the value and what is allowed.
            Length and parts, of the message and of a file in it, are counted before anything is parsed, so that no
            text takes long.
    """
    if isinstance(text, bytes):
        raise Refusal("message", "binary data: must be text, a JSON object")
    longest = MAX_SIZE if text.startswith(WITH_FILE) else MAX_LENGTH
    if len(text) > longest:
        raise Refusal("message", f"{len(text)} characters: must be {longest} at most")
    for counted, most in ((_STRING.sub("", text), MAX_PARTS), (text, MAX_FILE_PARTS)):
        if (parts := sum(map(counted.count, ",[{="))) > most:
            raise Refusal("message", f"{parts} parts: must be {most} at most")
    try:
        message: PageMessage = _ANY.validate_json(text)
    except ValidationError:
        raise _refusal(text) from None
    return message


def subject_of(message: PageMessage) -> str:
    """The subject of a message, in a word or two."""
    key = getattr(message, "key", None)
    return f"{message.type} {key}" if key else message.type


def _refusal(text: str) -> Refusal:
    """The reason why a text is no message."""
    try:
        data = from_json(text)
    except ValueError as error:  # at a place that the error names
        return Refusal("message", f"no JSON: {error}")
    if not isinstance(data, dict):
        return Refusal("message", f"{shown(data)}: must be a JSON object")
    name = data.get("type")
    if not isinstance(name, str) or name not in PAGE_MESSAGES:
        known = ", ".join(PAGE_MESSAGES)
        hint = suggestion(name[:20], PAGE_MESSAGES) if isinstance(name, str) else ""
        given = f"type = {shown(name)}" if "type" in data else "type is missing"
        return Refusal("message", f"{given}: must be one of {known}.{hint}")
    if len(data) > MAX_KEYS:
        return Refusal(name, f"{len(data)} keys: must be {MAX_KEYS} at most")
    try:
        PAGE_MESSAGES[name].model_validate_json(text)
    except ValidationError as error:
        problems = problems_in(PAGE_MESSAGES[name], error, {name: data}, (name,))
        key = data.get("key") if all(problem.place[-1] != "key" for problem in problems) else None
        return Refusal(f"{name} {key}" if key else name, problems[0].sentence)
    return Refusal(name, "must be text in UTF-8")
