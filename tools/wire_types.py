"""Write the page's TypeScript types from the wire's definitions.

Usage: python tools/wire_types.py (`make page` calls it). The definitions are in src/tandemlift/apps/live/session/,
and the words of a lecture in page_files.py beside it.
"""

from __future__ import annotations

import json
import types
from collections.abc import Iterator
from pathlib import Path
from typing import (
    Annotated,
    Any,
    Literal,
    NamedTuple,
    NotRequired,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

from annotated_types import Ge, Le, MinLen
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from tandemlift.apps.live.page_files import STEP_WORDS
from tandemlift.apps.live.session.frames import FRAME_FIELDS
from tandemlift.apps.live.session.page_messages import MAX_SIZE, PAGE_MESSAGES
from tandemlift.apps.live.session.server_messages import (
    SERVER_MESSAGES,
    SHOWN_PARAMETERS,
    FlightScene,
    FlightStatus,
    OneOf,
    StatusMessage,
)

ROOT = Path(__file__).resolve().parent.parent
TYPESCRIPT = ROOT / "web" / "src" / "wire" / "messages.generated.ts"
HUGE = 1e6  # a bound that only keeps numbers finite
WORDS = {float: "number", int: "number", str: "string", bool: "boolean", type(None): "null"}
HEAD = """\
// Written by tools/wire_types.py from src/tandemlift/apps/live/session/ and page_files.py: change it there.

export type Vector = readonly [number, number, number];
export type Quaternion = readonly [number, number, number, number]; // w, x, y, z: body to world
export type ParameterValue = number | boolean | string | readonly number[];
"""


class Entry(NamedTuple):
    """A key of a message: its name, its type in TypeScript, whether it may be left out, and what it means."""

    name: str
    type: str
    optional: bool
    meaning: str
    bounds: tuple[float, float] | None


# what a definition says


def entries_of(kind: type) -> list[Entry]:
    """The keys of a message or of a part of one; `seq`, which all messages of a page have, is left out."""
    model = issubclass(kind, BaseModel)
    hints = get_type_hints(kind, include_extras=True)
    hints = {name: hint for name, hint in hints.items() if name != "seq" and not name.startswith(("model_", "_"))}
    found = []
    for name, hint in hints.items():
        optional = get_origin(hint) is NotRequired
        hint = get_args(hint)[0] if optional else hint
        if model and name != "type" and not kind.model_fields[name].is_required():
            optional = True
        kind_of = typescript(hint).removesuffix(" | null") if model else typescript(hint)
        found.append(Entry(name, kind_of, optional, "; ".join(meanings(hint)), bounds(hint)))
    return sorted(found, key=lambda entry: entry.name != "type")


def metadata(hint: Any) -> tuple[Any, ...]:
    """The text of an annotation besides the type."""
    return get_args(hint)[1:] if get_origin(hint) is Annotated else ()


def meanings(hint: Any) -> Iterator[str]:
    """The texts of an annotation, the most special first."""
    yield from (one for one in reversed(metadata(hint)) if isinstance(one, str))


def bounds(hint: Any) -> tuple[float, float] | None:
    """The bounds of a number."""
    marks = [mark for one in metadata(hint) if isinstance(one, FieldInfo) for mark in one.metadata]
    low, high = (next((getattr(m, a) for m in marks if isinstance(m, k)), None) for k, a in ((Ge, "ge"), (Le, "le")))
    return None if low is None or high is None else (low, high)


# TypeScript


def typescript(hint: Any) -> str:
    """A type in TypeScript."""
    named = next((one.name for one in metadata(hint) if isinstance(one, OneOf)), "")
    if named:
        return named
    if get_origin(hint) is Annotated:
        marks = [mark for one in metadata(hint) if isinstance(one, FieldInfo) for mark in one.metadata]
        length = next((mark.min_length for mark in marks if isinstance(mark, MinLen)), None)
        return listed(get_args(get_args(hint)[0]), length) if length else typescript(get_args(hint)[0])
    origin, parts = get_origin(hint), get_args(hint)
    if origin is Literal:
        return " | ".join(f'"{part}"' for part in parts)
    if origin in (Union, types.UnionType):
        return union(parts)
    if origin is tuple:
        return "readonly number[]" if Ellipsis in parts else listed(parts, len(parts))
    if origin is list:
        inner = typescript(parts[0])
        return "readonly number[]" if inner == "number" else f"{inner}[]"
    return WORDS.get(hint) or hint.__name__


def listed(parts: tuple[Any, ...], length: int) -> str:
    """A list of a fixed length."""
    kinds = [typescript(part) for part in parts] * (length if len(parts) == 1 else 1)
    return "Vector" if kinds == ["number"] * 3 else f"[{', '.join(kinds)}]"


def union(parts: tuple[Any, ...]) -> str:
    """A union, by its name if it is that of a parameter's value."""
    kinds = {typescript(part) for part in parts}
    values = {"number", "boolean", "string", "readonly number[]"}
    return "ParameterValue" if kinds == values else " | ".join(typescript(part) for part in parts)


def interface(kind: type) -> str:
    """A TypeScript interface; a message that is a whole scene or status extends it."""
    base = next((one for one in (FlightScene, FlightStatus) if set(entries_of(one)) < set(entries_of(kind))), None)
    extends = f" extends {base.__name__}" if base else ""
    lines = [f"/** {summary(kind)} */", f"export interface {kind.__name__}{extends} {{"]
    inherited = entries_of(base) if base else []
    for entry in entries_of(kind):
        if entry in inherited:
            continue
        comment = f" // {entry.meaning}" if entry.meaning else ""
        lines.append(f"  {entry.name}{'?' if entry.optional else ''}: {entry.type};{comment}")
    return "\n".join([*lines, "}"]) + "\n"


def summary(kind: type) -> str:
    """The docstring of a definition."""
    return " ".join((kind.__doc__ or "").split())


def parts_of(kind: type) -> Iterator[type]:
    """The definitions that a definition needs, each after those that it needs itself."""
    for hint in get_type_hints(kind).values():
        for one in _leaves(hint):
            if isinstance(one, type) and issubclass(one, dict) and one is not dict:
                yield from parts_of(one)
                yield one


def _leaves(hint: Any) -> Iterator[Any]:
    yield hint
    for part in get_args(hint):
        yield from _leaves(part)


def enumerations(kind: type) -> dict[str, tuple[str, ...]]:
    """The texts of which a key is one, by the name that TypeScript has for them."""
    hints = get_type_hints(kind, include_extras=True).values()
    marks = [one for hint in hints for leaf in _leaves(hint) for one in metadata(leaf) if isinstance(one, OneOf)]
    return {one.name: one.options for one in marks}


def page_types() -> str:
    """The file of TypeScript types."""
    texts = [HEAD]
    for name, options in (enumerations(FlightStatus) | enumerations(FlightScene)).items():
        texts.append(f"export type {name} =\n" + "\n".join(f'  | "{one}"' for one in options) + ";\n")
    jumping = ", ".join(f'"{field.name}"' for field in FRAME_FIELDS if field.jumps)
    texts.append("/** Fields of which a value between two frames means nothing. */")
    texts.append(f"export const JUMPING_FIELDS: readonly FrameFieldName[] = [{jumping}];\n")
    texts.append("/** Parameters that the picture and the plots show. */")
    texts += [f'export const {name} = "{key}";' for name, key in SHOWN_PARAMETERS.items()]
    texts.append(f"/** Size of a message, at most [bytes]. */\nexport const MAX_SIZE = {MAX_SIZE};\n")
    texts.append("/** Words that keys of a step of a lecture may have. */\nexport const STEP_WORDS = {")
    texts += [f"  {key}: [{', '.join(map(json.dumps, words))}]," for key, words in STEP_WORDS.items()]
    texts.append("} as const;\n")
    texts.append(limits())
    kinds = dict.fromkeys([*parts_of(FlightScene), FlightScene, *parts_of(StatusMessage), FlightStatus])
    kinds |= dict.fromkeys([*SERVER_MESSAGES.values(), *PAGE_MESSAGES.values()])
    texts += [interface(kind) for kind in kinds]
    for name, messages in (("ServerMessage", SERVER_MESSAGES), ("PageMessage", PAGE_MESSAGES)):
        texts.append(f"export type {name} =" + "".join(f"\n  | {kind.__name__}" for kind in messages.values()) + ";\n")
    return "\n".join(texts)


def limits() -> str:
    """The bounds of numbers in messages of a page."""
    lines = []
    for name, kind in PAGE_MESSAGES.items():
        bounded = [(e.name, *e.bounds) for e in entries_of(kind) if e.bounds and e.bounds[1] < HUGE]
        keys = ", ".join(f"{key}: {{ min: {low:g}, max: {high:g} }}" for key, low, high in bounded)
        lines += [f"  {name}: {{ {keys} }},"] if bounded else []
    return (
        "/** Bounds of numbers that the page sends. */\nexport const LIMITS = {\n"
        + "\n".join(lines)
        + "\n} as const;\n"
    )


def main() -> None:
    """Write the types."""
    TYPESCRIPT.write_text(page_types(), "utf-8")


if __name__ == "__main__":
    main()
