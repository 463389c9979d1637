"""Common options of commands that fly a mission, and the loading of mission, controller and settings."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import click

from tandemlift.apps.cli.terminal.completion import CONTROLLERS, names, settings
from tandemlift.core.errors import InputError
from tandemlift.core.files import toml_tables
from tandemlift.pictures.figures.drawing.figure_style import STYLES, figure_style

if TYPE_CHECKING:
    from tandemlift.missions import Mission
    from tandemlift.parts.controllers import Controller

FAILED = 3  # exit code of a flight that crashed, diverged or did not lift
WORD = r"\+|[A-Za-z][A-Za-z0-9_.+-]*"  # a string that --set accepts without quotes

engine_option = click.option(
    "--engine",
    default="compiled",
    shell_complete=names("engine"),
    show_default=True,
    help="Engine that simulates the vehicle; see `tandemlift engines`.",
)
set_option = click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=settings,
    help="Set one key of the mission: a dotted key, and a TOML value or a word. Can be repeated.",
)
controller_option = click.option(
    "--controller",
    metavar="NAME|FILE",
    shell_complete=CONTROLLERS,
    help="Controller to fly: a registered one, or your own .py file.",
)
after_crash_option = click.option(
    "--after-crash",
    type=click.FloatRange(min=0.0),
    metavar="SECONDS",
    help="Continue after a crash with the rotors stopped, at most until the vehicle is at rest: the key crash.fly_on.",
)


def _draw_in(context: click.Context, option: click.Parameter, style: str | None) -> str | None:
    """Draw all figures of the command in a style, if one is given."""
    context.with_resource(figure_style(style))
    return style


style_option, kept_style_option = (
    click.option(
        "--style",
        type=click.Choice(list(STYLES)),
        callback=_draw_in,
        expose_value=kept,
        help="Size, type and colours of the figures: columns of a journal, or slides of 16:9 on white or dark paper."
        "  [default: ieee]",
    )
    for kept in (False, True)
)
"""The figures of a command are drawn in this style; the second one passes the name of the style to the command, too."""


def with_after_crash(settings: tuple[str, ...], seconds: float | None) -> tuple[str, ...]:
    """Settings of a mission, with the time of flight after a crash [s], if that is given."""
    return settings if seconds is None else (*settings, f"crash.fly_on={seconds!r}")


def chosen_controller(given: str) -> Controller:
    """A registered controller by name, or the controller of a Python file.

    Raises:
        InputError: there is no such controller, or the file defines none.
    """
    from tandemlift.parts.controllers import controller, load_controller

    return load_controller(given) if given.endswith(".py") or "/" in given else controller(given)


def load(mission: str, settings: tuple[str, ...], controller: Controller | None = None) -> Mission:
    """Load a mission by name or path, with the changes of `--set`.

    Raises:
        InputError: there is no such mission, or it is not valid.
    """
    from tandemlift.missions import load_mission

    return load_mission(mission, dict(map(parse_setting, settings)), controller=controller)


def parse_setting(text: str) -> tuple[str, Any]:
    """The dotted key and the value of KEY=VALUE; VALUE is a TOML literal, or an unquoted word for a string.

    Raises:
        InputError: the text has another form.
    """
    key, equals, literal = (part.strip() for part in text.partition("="))
    if not equals or not re.fullmatch(r"[A-Za-z0-9_]+(\.[A-Za-z0-9_]+)*", key):
        raise InputError(f"--set {text}: must be KEY=VALUE with a dotted key, such as mission.duration=5.0")
    try:
        parsed = toml_tables(f"value = {literal}")
    except (ValueError, RecursionError):
        if re.fullmatch(WORD, literal):
            return key, literal
        parsed = {}
    if list(parsed) != ["value"]:
        shown = repr(literal if len(literal) <= 80 else f"{literal[:79]}…")
        allowed = "a number such as 0.5, true, false, a list such as [1, 2, 3], a word, or '\"text in quotes\"'"
        raise InputError(f"--set {key}={shown}: the value must be {allowed}")
    return key, parsed["value"]
