"""TOML and dotted keys from anyone: memory grows with the square of a key's parts, behind a bound on them."""

from __future__ import annotations

import re
import tomllib
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
    """The parts of a dotted key of plain words.

    Raises:
        InputError: there are more than `MAX_PARTS`.
    """
    if key.count(".") >= MAX_PARTS:
        raise _too_deep(key)
    return key.split(".")


def _too_deep(key: str) -> InputError:
    return InputError(f"{key[:40]}…: unknown key, nested too deeply: a key has at most {MAX_PARTS} parts")
