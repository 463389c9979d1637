"""Reading a page's messages; refusals name the key, the value and the allowed values."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, TypeAdapter, ValidationError
from pydantic_core import from_json

from tandemlift.apps.live.wire.page_messages import PAGE_MESSAGES, PageMessage
from tandemlift.core.errors import InputError, shown, suggestion
from tandemlift.missions.refusals import problems_in

MAX_SIZE = 65_536  # bytes; a page that sends more is cut off
MAX_LENGTH = 4_096  # characters that are read: twice what the longest message has
MAX_KEYS = 12
MAX_PARTS = 128  # values and tables that are read: more than any message has

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
            Length and parts are counted before anything is parsed, so that no text takes long.
    """
    if isinstance(text, bytes):
        raise Refusal("message", "binary data: must be text, a JSON object")
    if len(text) > MAX_LENGTH:
        raise Refusal("message", f"{len(text)} characters: must be {MAX_LENGTH} at most")
    parts = sum(map(text.count, ",[{"))
    if parts > MAX_PARTS:
        raise Refusal("message", f"{parts} parts: must be {MAX_PARTS} at most")
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
        return Refusal(name, problems_in(PAGE_MESSAGES[name], error, {name: data}, (name,))[0].sentence)
    return Refusal(name, "must be text in UTF-8")
