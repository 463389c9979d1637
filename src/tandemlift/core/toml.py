"""Reading untrusted TOML and dotted keys, and writing values as TOML.

The memory for reading grows with the square of the number of a key's parts, so that number is bounded.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from tandemlift.core.errors import InputError

MAX_PARTS = 16  # of a dotted key; no key of a mission or of a study has half as many

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
_TOO_DEEP = re.compile(rf"(?<![\w\\-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{MAX_PARTS}}}")


def toml_tables(text: str) -> dict[str, Any]:
    """The tables of a TOML text.

    Raises:
        InputError: a key has more than `MAX_PARTS` parts; nothing is parsed.
        ValueError: the text is not valid TOML.
        RecursionError: its lists or tables are nested too deeply.
    """
    if deep := _TOO_DEEP.search(text):
        raise _too_deep(deep[0])
    return tomllib.loads(text)


def parts_of(key: str) -> list[str]:
    """Split a dotted key of plain words into its parts.

    Raises:
        InputError: there are more than `MAX_PARTS`.
    """
    if key.count(".") >= MAX_PARTS:
        raise _too_deep(key)
    return key.split(".")


def _too_deep(key: str) -> InputError:
    return InputError(f"{key[:40]}…: unknown key, nested too deeply: a key has at most {MAX_PARTS} parts")


def dotted(place: Iterable[str | int]) -> str:
    """The dotted key as `--set` accepts it; a part that is no plain word is quoted."""
    return ".".join(part if re.fullmatch(r"[A-Za-z0-9_-]{1,60}", part) else shown(part) for part in map(str, place))


def shown(value: Any) -> str:
    """A value as one would write it in TOML, on one line of bounded length."""
    text = written(value)
    return text if len(text) <= 70 else f"{text[:69]}…"


def written(value: Any, depth: int = 0) -> str:
    """A value as one would write it in TOML, on one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value[:100], ensure_ascii=not value[:100].isprintable())
    if isinstance(value, int):
        return str(value) if value.bit_length() < 14_000 else f"{value:#x}"[:80]  # Python writes no more digits
    if isinstance(value, (list, tuple)):
        return f"[{_joined(value, depth, lambda item: written(item, depth + 1))}]"
    if isinstance(value, Mapping):
        return f"{{{_joined(value, depth, lambda key: f'{dotted([key])} = {written(value[key], depth + 1)}')}}}"
    return str(value)


def _joined(items: Any, depth: int, write: Callable[[Any], str]) -> str:
    return "…" if depth > 3 else ", ".join(write(item) for item, _ in zip(items, range(40), strict=False))
