"""Numbers and texts on the wire: units, axes, and the bounds of what a page may send.

A text in an annotation says what a value is, with its unit and axes; `tools/wire_types.py` copies it to the page's
types and to the documentation. World axes have z up. Body axes begin at the vehicle's centre of mass; the beam lies
along y.
"""

from __future__ import annotations

import re
from typing import Annotated, Any, NamedTuple

from pydantic import AfterValidator, Field

from tandemlift.core.keys import must
from tandemlift.core.phases import ENDINGS, PHASE_NAMES

MAX_WORD = 100  # characters of a key or of a word
NAME_PATTERN = "[A-Za-z0-9][A-Za-z0-9._-]{0,63}"  # of the name of a saved flight
NAME_RULE = "be 1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit"
LOST = tuple(dict.fromkeys(kind.outcome for kind in ENDINGS))  # phases of a flight that was stopped before its end
ENDS = ("failed", *LOST, "over")  # phases of a flight that has ended; by an error, stopped, at its full length
PREPARING = "preparing"  # the phase before the first step


class OneOf(NamedTuple):
    """Mark of a text that is one of a few, with the name that TypeScript has for them."""

    name: str
    options: tuple[str, ...]


def _key(key: str) -> str:
    if len(key) > MAX_WORD or not re.fullmatch(r"[A-Za-z0-9_]+(\.[A-Za-z0-9_]+)*", key):
        raise must("key", f"be a dotted key of {MAX_WORD} characters at most, such as admittance.mass")
    return key


def _name(name: str) -> str:
    if not re.fullmatch(NAME_PATTERN, name):
        raise must("name", NAME_RULE)
    return name


def _word(word: str) -> str:
    if len(word) > MAX_WORD:
        raise must("word", f"have {MAX_WORD} characters at most")
    return word


# from a page, bounded
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
Word = Annotated[str, AfterValidator(_word)]
NewValue = bool | Number | Word | Annotated[tuple[Number, ...], Field(max_length=64, fail_fast=True)]

# to a page
Three = Annotated[list[float], Field(min_length=3, max_length=3)]
BodyPosition = Annotated[Three, "m, body axes"]
WorldPosition = Annotated[Three, "m, world axes"]
Metres = Annotated[float, "m"]
Newtons = Annotated[float, "N"]
Seconds = Annotated[float, "s"]
ParameterValue = float | bool | str | list[float]
Phase = Annotated[str, OneOf("Phase", (*PHASE_NAMES, PREPARING, *ENDS))]
JsonObject = dict[str, Any]
