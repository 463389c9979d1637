"""Errors and warnings, whose texts name the place, the value and the allowed range; missing optional packages."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager


class InputError(ValueError):
    """Invalid input: a mission, a setting, a file. The message is complete by itself; the CLI exits with 2."""


class FlightWarning(UserWarning):
    """Warns of a mission that can be flown but is expected to fly badly, with the numbers."""


def nearest(given: str, known: Iterable[str]) -> str | None:
    """The known name that is most similar to the given one, or None."""
    names = {name.lower(): name for name in known}
    close = difflib.get_close_matches(given.lower(), list(names), n=1, cutoff=0.6)
    return names[close[0]] if close else None


def suggestion(given: str, known: Iterable[str]) -> str:
    """' Did you mean …?' for a name close to a known one, else ''."""
    near = nearest(given, known)
    return f" Did you mean {near!r}?" if near else ""


def unknown(what: str, given: object, known: Iterable[str]) -> InputError:
    """The error for a name that is not registered, with the registered names and the closest of them."""
    names, text = list(known), str(given)
    shown = repr(text if len(text) <= 80 else f"{text[:79]}…")
    return InputError(f"unknown {what} {shown}; there are {', '.join(names)}.{suggestion(text, names)}")


@contextmanager
def extra(name: str, user: str) -> Iterator[None]:
    """A context in which optional packages are imported.

    Args:
        name: of the extra of tandemlift that has the packages.
        user: the feature that needs them.

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
