"""`tandemlift linearize` and `check`: the closed step of a mission as a linear model; its checks before a flight."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.completion import MISSIONS
from tandemlift.apps.cli.console import echo, print_checks
from tandemlift.apps.cli.flying import DRAWINGS, FAILED, controller_option, file_path, load, set_option, style_option
from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.core.files import write_file

if TYPE_CHECKING:
    from tandemlift.analysis.linearization.linear_model import LinearModel

DRAWN = {"loop": ("push_force", "position"), "body": ("disturbance_force", "position")}


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option("--at", type=float, metavar="S", help="Time of the point.  [default: the first calm after lift and tare]")
@click.option(
    "--of", type=click.Choice(["loop", "body"]), default="loop", show_default=True, help="Pilot and body, or the body."
)
@click.option("--inputs", metavar="NAMES", help="Inputs, separated by commas.  [default: all]")
@click.option("--outputs", metavar="NAMES", help="Channels, separated by commas.  [default: motion, thrusts, joints]")
@click.option("--modes", "count", type=click.IntRange(0), default=15, show_default=True, help="Modes that are printed.")
@click.option("--out", metavar="FILE", help="Write the model to FILE.npz or FILE.json.")
@click.option("--figure", metavar="FILE", help="Draw modes and frequency response into FILE.png, .pdf or .svg.")
@style_option
@set_option
@controller_option()
def linearize(
    mission: str,
    at: float | None,
    of: str,
    inputs: str | None,
    outputs: str | None,
    count: int,
    out: str | None,
    figure: str | None,
    settings: tuple[str, ...],
    controller: str | None,
) -> None:
    """Print the linear model of MISSION at a time of its flight.

    Modes, kinks and assumptions are printed. The model is x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k), of
    deviations from the flight. Its derivatives are exact. The sample time is the common period of all sensors.

    \b
    Examples:
      tandemlift linearize paper
      tandemlift linearize iris --at 9 --out iris.npz --figure iris.png
      tandemlift linearize hover --of body --inputs rotor_thrusts --outputs position,euler

    \b
    Exit code:
      0   the model was printed
      2   bad input: one message, nothing is written
    """
    from tandemlift.analysis.linearization.linear_model import ENDINGS, model_lines
    from tandemlift.analysis.linearization.linearize import linearize as linearized

    for option, path, endings in (("--out", out, ENDINGS), ("--figure", figure, DRAWINGS)):
        if path is not None:
            file_path(option, path, *endings)
    names = [None if given is None else given.split(",") for given in (inputs, outputs)]
    model = linearized(load(mission, settings, controller), at, of=of, inputs=names[0], outputs=names[1])
    connected = model.connected()
    for line in model_lines(model, connected, count):
        echo(line)
    if out:
        model.save(out)
        echo(f"model: {out}")
    if figure:
        _draw(connected, Path(figure))
        echo(f"figure: {figure}")


def _draw(connected: LinearModel, path: Path) -> None:
    """Draw the model.

    Raises:
        InputError: it has too many states.
    """
    from tandemlift.analysis.linearization.frequency_response import axis_responses
    from tandemlift.analysis.linearization.linear_model import MOST_STATES, modes_of, title_of
    from tandemlift.pictures.drawing.style import save
    from tandemlift.pictures.figures.linear_model import Response, draw

    if len(connected.states) > MOST_STATES:
        raise InputError(f"--figure {path}: {len(connected.states)} states are too many to draw; at most {MOST_STATES}")
    names = DRAWN[connected.of]
    response = Response(" → ".join(names).replace("_", " "), *axis_responses(connected, *names))
    save(draw(title_of(connected), [mode.s for mode in modes_of(connected).modes], response), path)


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@set_option
@controller_option("Controller to check")
@click.option("--strict", is_flag=True, help="Exit with code 3 if a check fails.")
@click.option("--json", "file", metavar="FILE", help="Write the results to FILE as well.")
def check(mission: str, settings: tuple[str, ...], controller: str | None, strict: bool, file: str | None) -> None:
    """Check MISSION before its flight: limits and stability margins.

    Each number is printed with its limit and margin. Loading the mission warns of checks that fail by a closed form.
    The loops are those of a calm hover, by a linear model: phase and gain margins of each axis, and the delay and the
    lag of the rotors at which they oscillate.

    \b
    Examples:
      tandemlift check iris
      tandemlift check iris --set actuators.delay=0.1 --strict
      tandemlift check mine.toml --json checks.json

    \b
    Exit code:
      0   the mission was checked
      2   bad input: one message, nothing is written
      3   with --strict: a check fails
    """
    from tandemlift.analysis.certification.mission_check import check as checked

    with without_flight_warnings():  # the table has the same
        loaded = load(mission, settings, controller)
    results = checked(loaded)
    print_checks(results)
    if file:
        rows = [{**result._asdict(), "margin": result.margin} for result in results]
        write_file(Path(file), json.dumps(rows, indent=1, ensure_ascii=False))
        echo(f"checks: {file}")
    if strict and any(result.verdict == "fails" for result in results):
        sys.exit(FAILED)
