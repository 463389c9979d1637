"""Controllers by name or file; loading of a user's controller from a Python file."""

from __future__ import annotations

from pathlib import Path

from tandemlift.core.errors import InputError, unknown
from tandemlift.core.plugs import Plugin, file_text, has, run_text
from tandemlift.parts.controllers.registry import CONTROLLERS, Controller


def controller(given: str) -> Controller:
    """The registered controller of that name, or the one of a Python file.

    Raises:
        InputError: there is no such controller, or the file defines none.
    """
    if given.endswith(".py") or "/" in given:
        return load_controller(given)
    if not has("controller", given):
        error = unknown("controller", given, sorted(CONTROLLERS))
        raise InputError(f"{error} One of your own must be loaded first, as with --controller FILE.")
    return CONTROLLERS[given]


def load_controller(path: str | Path) -> Controller:
    """Run a Python file that registers one controller, and return it. An unchanged file runs only once.

    Raises:
        InputError: the file is missing, fails, or registers no controller.
    """
    text = file_text(path, "controller file")
    found: list[Controller] = run_text(text, Path(path).resolve(), "controller file", _check_one).parts("controller")
    return found[0]


def _check_one(loaded: Plugin) -> None:
    if (count := len(loaded.parts("controller"))) != 1:
        raise InputError(f"registers {count} controllers; it must register one with @register(NAME, SETTINGS)")
