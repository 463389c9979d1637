"""Errors for laws that cannot be traced: name, file, line, and allowed alternatives."""

from __future__ import annotations

import sys
from pathlib import Path
from types import CodeType

from tandemlift.core.errors import InputError

HERE = str(Path(__file__).parent)
OURS = str(Path(__file__).parents[2])


class TraceError(InputError):
    """A law cannot be traced: it asks a symbol for something that only a number has."""


def is_ours(code: CodeType) -> bool:
    """Whether a function belongs to this package."""
    return code.co_filename.startswith(OURS)


def refused(what: str, code: CodeType, line: int) -> TraceError:
    """The error for a law that cannot be traced: file, line, name, reason, and allowed alternatives."""
    way = "" if is_ours(code) else "; or register the controller with compiled=False"
    return TraceError(f"{code.co_filename}, line {line}: {code.co_name}() {what}{way}")


def refused_here(what: str) -> TraceError:
    """The error for the innermost law being traced; inside a user's file, for the user's function."""
    frame = sys._getframe(1)
    while frame.f_back and frame.f_code.co_filename.startswith(HERE):
        frame = frame.f_back
    innermost = frame
    while frame.f_back and is_ours(frame.f_code) and not frame.f_back.f_code.co_filename.startswith(HERE):
        frame = frame.f_back
    frame = frame if frame.f_back else innermost
    return refused(what, frame.f_code, frame.f_lineno)
