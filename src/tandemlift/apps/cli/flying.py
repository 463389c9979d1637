"""Common to commands that fly missions: options, loading, the files of a flight, findings and exit codes."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tandemlift.apps.cli.completion import CONTROLLERS, names, settings
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.export.results import FIGURES
from tandemlift.core.errors import InputError
from tandemlift.core.files import FLIGHT_FILE, parse_setting
from tandemlift.pictures.drawing.figure import STYLES, figure_style

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission
    from tandemlift.parts.controllers import Controller
    from tandemlift.simulation.known_flights import KnownFile

DRAWINGS = (".png", ".pdf", ".svg")  # endings of a figure on its own
HTML = (".html", ".htm")
FILES = ("mission.toml", FLIGHT_FILE, "metrics.json", "metrics.csv", "metrics.tex", "findings.json", "report.html")
FAILED = 3  # exit code of a flight that crashed, diverged or did not lift; with --strict also of one with findings
INTERRUPTED = 130  # exit code after Ctrl-C, as shells report it
PLUGINS = "plugins given"  # to a command, in what its context holds

engine_option = click.option(
    "--engine",
    default="compiled",
    shell_complete=names("engine"),
    show_default=True,
    help="Engine that simulates the vehicle; see `tandemlift engines`.",
)
strict_option: Callable[[Any], Any] = click.option(
    "--strict", is_flag=True, help="Exit with 3 if there are findings; see `findings.ignore` for kinds to leave out."
)


def _bring(context: click.Context, option: click.Parameter, files: tuple[str, ...]) -> None:
    """Load plugins, which all missions of the command list."""
    if files:
        from tandemlift.core.plugs import GIVEN
        from tandemlift.missions import load_plugin

        GIVEN.extend(map(load_plugin, files))
        context.call_on_close(GIVEN.clear)
        context.meta[PLUGINS] = True


plugin_option: Callable[[Any], Any] = click.option(
    "--plugin",
    multiple=True,
    metavar="FILE",
    shell_complete=names(files=[".py"]),
    callback=_bring,
    is_eager=True,
    expose_value=False,
    help="Load your own parts, metrics and figures from this .py file. Can be repeated.",
)
setting_option = click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=settings,
    help="Set one key of the mission: a dotted key, and a TOML value or a word. Can be repeated.",
)


def set_option(command: Any) -> Any:
    """The options of a command that flies missions: `--set` and `--plugin`."""
    return setting_option(plugin_option(command))


figures_option = click.option("--no-figures", is_flag=True, is_eager=True, help="Draw no figures.")
after_crash_option = click.option(
    "--after-crash",
    type=click.FloatRange(min=0.0),
    metavar="SECONDS",
    help="Continue after a crash with the rotors stopped, at most until the vehicle is at rest: the key crash.fly_on.",
)


def controller_option(use: str = "Controller to fly") -> Callable[[Any], Any]:
    """The option of a controller; `use`: what the command does with it."""
    return click.option(
        "--controller",
        metavar="NAME|FILE",
        shell_complete=CONTROLLERS,
        help=f"{use}: a registered one, or your own .py file.",
    )


def _draw_in(context: click.Context, option: click.Parameter, style: str | None) -> str | None:
    """Draw all figures of the command in a style, if one is given."""
    if style and context.params.get("no_figures"):
        raise InputError(f"--style {style}: leave out --no-figures, or there is no figure of that style")
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
    from tandemlift.parts.controllers import controller

    return controller(given)


def load(mission: str, settings: tuple[str, ...], controller: Controller | str | None = None) -> Mission:
    """Load a mission by name or path, with the changes of `--set` and the controller of `--controller`.

    Raises:
        InputError: there is no such mission or controller, or it is not valid.
    """
    from tandemlift.missions import load_mission

    return load_mission(mission, dict(map(parse_setting, settings)), controller=controller)


# the files of a flight


def write_flight(flight: Flight, folder: Path, *, figures: bool, file: KnownFile | None = None) -> None:
    """Write the files of a flight, of a mission's file, into the folder, and say where its figures are drawn."""
    from tandemlift.pictures.report.flight_report import mission_facts, write_flight_files

    replay = None
    if figures:
        from tandemlift.apps.live.replay import report_replay

        replay = report_replay(flight)
        echo(f"  drawing: {folder / FIGURES}")
    facts = file.facts("report", lambda: mission_facts(flight)) if file else None
    with progress_bar("Drawing", "figures", shown=figures and sys.stderr.isatty()) as progress:
        write_flight_files(flight, folder, figures=figures, progress=progress, replay=replay, facts=facts)


def exit_if_amiss(flights: Mapping[str, Flight], *, strict: bool) -> None:
    """Print findings and failures of flights by name, a line each on standard error.

    End the process if a flight failed, or, if strict, has findings.
    """
    found = [(name, finding) for name, flight in flights.items() for finding in flight.findings]
    for name, finding in found:
        click.echo(f"{_coloured(f'{name}: {finding.kind}')} {str(finding).partition(' ')[2]}", err=True)
    failures = {name: flight.failure for name, flight in flights.items() if flight.failure}
    for name, failure in failures.items():
        click.echo(f"{name}: {failure}", err=True)
    if failures or (found and strict):
        sys.exit(FAILED)


def _coloured(text: str) -> str:
    """Text in bold yellow; plain where the output is no terminal (which click sees to) or NO_COLOR is set."""
    return text if os.environ.get("NO_COLOR") else click.style(text, fg="yellow", bold=True)
