"""What can go wrong, in words that name the place, the value and what is allowed."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class InputError(ValueError):
    """Bad input from a person: a mission, a setting, a file. The message stands on its own; the CLI exits with 2."""


class FlightWarning(UserWarning):
    """A mission that will be flown but may fly badly, with the numbers that say why."""


def suggestion(given: str, known: Iterable[str]) -> str:
    """' Did you mean …?' for a name close to a known one, else ''."""
    close = difflib.get_close_matches(given, list(known), n=1, cutoff=0.6)
    return f" Did you mean {close[0]!r}?" if close else ""


def unknown(what: str, given: object, known: Iterable[str]) -> InputError:
    """The error for a name that is not registered: what it is, what there is, and the likely fix."""
    names = list(known)
    return InputError(f"unknown {what} {given!r}; there are {', '.join(names)}.{suggestion(str(given), names)}")
