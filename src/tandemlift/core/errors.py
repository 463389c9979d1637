"""What can go wrong, in words that name the place, the value and what is allowed; and packages that are missing."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager


class InputError(ValueError):
    """Bad input from a person: a mission, a setting, a file. The message stands on its own; the CLI exits with 2."""


class FlightWarning(UserWarning):
    """A mission that will be flown but may fly badly, with the numbers that say why."""


def nearest(given: str, known: Iterable[str]) -> str | None:
    """The known name that the given one is probably meant to be."""
    names = {name.lower(): name for name in known}
    close = difflib.get_close_matches(given.lower(), list(names), n=1, cutoff=0.6)
    return names[close[0]] if close else None


def suggestion(given: str, known: Iterable[str]) -> str:
    """' Did you mean …?' for a name close to a known one, else ''."""
    near = nearest(given, known)
    return f" Did you mean {near!r}?" if near else ""


def unknown(what: str, given: object, known: Iterable[str]) -> InputError:
    """The error for a name that is not registered: what it is, what there is, and the likely fix."""
    names, text = list(known), str(given)
    shown = repr(text if len(text) <= 80 else f"{text[:79]}…")
    return InputError(f"unknown {what} {shown}; there are {', '.join(names)}.{suggestion(text, names)}")


@contextmanager
def extra(name: str, user: str) -> Iterator[None]:
    """Import optional packages within it.

    Args:
        name: of the extra of tandemlift that has the packages.
        user: what needs them.

    Raises:
        InputError: a package is not installed; with the command that installs it.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        raise InputError(f"{user} needs {package}: {install_command(name)}") from None


def install_command(name: str) -> str:
    """The command that installs an extra."""
    return f"pip install 'tandemlift[{name}]'"
