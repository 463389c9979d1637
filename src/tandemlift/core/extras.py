"""Packages that only some commands need, and the error where one is not installed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from tandemlift.core.errors import InputError


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
