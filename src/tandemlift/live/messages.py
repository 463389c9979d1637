"""What a page may say: a strict, finite, bounded schema for every message, and a reason for every refusal.

One JSON object a message, of a `type` and a number `seq` that grows. Points on the body are in body axes [m] from the
centre of mass, targets and forces in world axes [m, N].
"""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError
from pydantic_core import from_json

from tandemlift.common.errors import InputError, suggestion
from tandemlift.missions.refusals import problems_in
from tandemlift.missions.values import shown
from tandemlift.settings.leaves import must

MAX_SIZE = 65_536  # bytes; who sends more is cut off
MAX_LENGTH = 4_096  # characters that are looked at: twice what the longest message has
MAX_KEYS = 12
MAX_WORD = 100  # characters of a key or of a word


def _key(key: str) -> str:
    if len(key) > MAX_WORD or not re.fullmatch(r"[A-Za-z0-9_]+(\.[A-Za-z0-9_]+)*", key):
        raise must("key", f"be a dotted key of {MAX_WORD} characters at most, such as admittance.mass")
    return key


def _name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}", name):
        raise must("name", "be 1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit")
    return name


def _word(word: str) -> str:
    if len(word) > MAX_WORD:
        raise must("word", f"have {MAX_WORD} characters at most")
    return word


Metre = Annotated[float, Field(ge=-1e4, le=1e4)]
Newton = Annotated[float, Field(ge=-1e3, le=1e3)]
Number = Annotated[float, Field(ge=-1e12, le=1e12)]
Point = tuple[Metre, Metre, Metre]
Push = tuple[Newton, Newton, Newton]
Key = Annotated[str, AfterValidator(_key)]
Name = Annotated[str, AfterValidator(_name)]
Word = Annotated[str, AfterValidator(_word)]
Value = bool | Number | Word | Annotated[tuple[Number, ...], Field(max_length=64, fail_fast=True)]


class _Message(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    seq: Annotated[int, Field(ge=0, le=10**15)]


class Grab(_Message):
    """Hold the vehicle at a point, or at its centre, and pull it to a target."""

    type: Literal["grab"]
    point: Point  # m, body axes
    target: Point  # m, world axes
    at: Literal["point", "centre"]


class Move(_Message):
    """Pull to another target."""

    type: Literal["move"]
    target: Point  # m, world axes


class Release(_Message):
    """Let go."""

    type: Literal["release"]


class Force(_Message):
    """Push with a force, as a keyboard or a gamepad does; let go if it is zero."""

    type: Literal["force"]
    force: Push  # N, world axes
    point: Point  # m, body axes


class Set(_Message):
    """Change a setting."""

    type: Literal["set"]
    key: Key
    value: Value


class Restore(_Message):
    """Bring a setting back to what the mission says, or all of them."""

    type: Literal["restore"]
    key: Key | None = None


class Ask(_Message):
    """Ask the pilot for something."""

    type: Literal["ask"]
    what: Literal["lift", "land", "stop"]


class Enable(_Message):
    """Let the pilot listen to the hand, or not."""

    type: Literal["enable"]
    on: bool


class Tare(_Message):
    """Take what the force sensors read in hover for their bias, anew."""

    type: Literal["tare"]


class Kill(_Message):
    """Stop a rotor for good; counted over the whole vehicle, from 0."""

    type: Literal["kill"]
    rotor: Annotated[int, Field(ge=0, le=255)]


class Pause(_Message):
    """Stop time, or let it go on."""

    type: Literal["pause"]
    on: bool


class Speed(_Message):
    """Let time pass at a share of the real pace."""

    type: Literal["speed"]
    factor: Annotated[float, Field(ge=0.1, le=1.0)]


class Reset(_Message):
    """Begin the flight again."""

    type: Literal["reset"]


class Save(_Message):
    """Save what was flown under a name."""

    type: Literal["save"]
    name: Name


class Ping(_Message):
    """Ask for an echo."""

    type: Literal["ping"]
    t: Number  # ms, by the page's clock


Message = (
    Grab | Move | Release | Force | Set | Restore | Ask | Enable | Tare | Kill | Pause | Speed | Reset | Save | Ping
)
KINDS: dict[str, type[_Message]] = {
    kind.__name__.lower(): kind
    for kind in (Grab, Move, Release, Force, Set, Restore, Ask, Enable, Tare, Kill, Pause, Speed, Reset, Save, Ping)
}
_ANY: TypeAdapter[Any] = TypeAdapter(Annotated[Message, Field(discriminator="type")])


class Refusal(InputError):
    """A message that is not heeded: `what` it was about; the text says why."""

    def __init__(self, what: str, reason: str) -> None:
        super().__init__(reason)
        self.what = what


def read_message(text: str | bytes) -> Message:
    """The message in a text.

    Raises:
        Refusal: it is too long, no JSON, or breaks the schema; the reason names the key, the value and what is allowed.
    """
    if isinstance(text, bytes):
        raise Refusal("message", "binary data: must be text, a JSON object")
    if len(text) > MAX_LENGTH:
        raise Refusal("message", f"{len(text)} characters: must be {MAX_LENGTH} at most")
    try:
        return _ANY.validate_json(text)
    except ValidationError:
        raise _refusal(text) from None


def about(message: Message) -> str:
    """What a message is about, in a word or two."""
    key = getattr(message, "key", None)
    return f"{message.type} {key}" if key else message.type


def _refusal(text: str) -> Refusal:
    """Why a text is no message."""
    try:
        data = from_json(text)
    except ValueError as error:  # at a place that the error names
        return Refusal("message", f"no JSON: {error}")
    if not isinstance(data, dict):
        return Refusal("message", f"{shown(data)}: must be a JSON object")
    name = data.get("type")
    if not isinstance(name, str) or name not in KINDS:
        known = ", ".join(KINDS)
        hint = suggestion(name[:20], KINDS) if isinstance(name, str) else ""
        given = f"type = {shown(name)}" if "type" in data else "type is missing"
        return Refusal("message", f"{given}: must be one of {known}.{hint}")
    if len(data) > MAX_KEYS:
        return Refusal(name, f"{len(data)} keys: must be {MAX_KEYS} at most")
    try:
        KINDS[name].model_validate_json(text)
    except ValidationError as error:
        return Refusal(name, problems_in(KINDS[name], error, {name: data}, (name,))[0].sentence)
    return Refusal(name, "must be text in UTF-8")
