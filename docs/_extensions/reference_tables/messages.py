"""The tables of the live page's messages and frames, from the definitions in `tandemlift.apps.live.session`."""

from __future__ import annotations

import re

from wire_types import HUGE, Entry, entries_of, parts_of, summary

from reference_tables.markdown import codes, table
from tandemlift.apps.live.session.frames import FRAME_FIELDS
from tandemlift.apps.live.session.page_messages import PAGE_MESSAGES
from tandemlift.apps.live.session.server_messages import SERVER_MESSAGES, FlightScene

LONG = {"scene": "see [scene](#scene)", "status": "see [status](#status)"}


def page_messages() -> str:
    """The messages of a page."""
    return _messages(PAGE_MESSAGES)


def server_messages() -> str:
    """The messages of the server."""
    return _messages(SERVER_MESSAGES)


def scene() -> str:
    """The keys of a scene."""
    return _keys(FlightScene)


def status() -> str:
    """The keys of a status."""
    return _keys(SERVER_MESSAGES["status"])


def frame() -> str:
    """The fields of a frame."""
    rows = [(f"`{field.name}`", str(field.columns or "rotors"), field.meaning) for field in FRAME_FIELDS]
    return table(("field", "columns", "what"), rows)


def _messages(messages: dict[str, type]) -> str:
    rows = []
    for name, kind in messages.items():
        keys = (_key(entry) for entry in entries_of(kind) if entry.name != "type")
        rows.append((f"`{name}`", summary(kind), LONG.get(name) or ", ".join(keys)))
    return table(("type", "what", "other keys"), rows)


def _key(entry: Entry) -> str:
    """A key in a table of messages: its name, and its meaning or values."""
    allowed = entry.type.replace('"', "`").replace(" | ", ", ") if '"' in entry.type else ""
    within = "{:g} to {:g}".format(*entry.bounds) if entry.bounds and entry.bounds[1] < HUGE else ""
    note = "; ".join(part for part in (entry.meaning, allowed, within, "optional" if entry.optional else "") if part)
    return f"`{entry.name}`" + (f" ({note})" if note else "")


def _keys(kind: type) -> str:
    """A row for each key of a long message, with the keys of its parts."""
    rows = []
    for entry in entries_of(kind):
        if entry.name != "type":
            part = next((p for p in parts_of(kind) if p.__name__ in re.findall(r"\w+", entry.type)), None)
            inner = codes(e.name for e in entries_of(part)) if part else ""
            rows.append((f"`{entry.name}`", ": ".join(one for one in (entry.meaning, inner) if one)))
    return table(("key", "what"), rows)
