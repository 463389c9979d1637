"""`tandemlift linearize`, `check`, `certify`, `excite`: what the linear model of a mission tells."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from time import monotonic
from typing import Any

import click

from tandemlift.apps.cli.completion import MISSIONS
from tandemlift.apps.cli.console import compile_notices, echo, print_checks
from tandemlift.apps.cli.flying import DRAWINGS, FAILED, INTERRUPTED, controller_option, load, set_option, style_option
from tandemlift.apps.export.results import file_path, results_folder
from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.core.files import write_file


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option("--at", type=float, metavar="S", help="Time of the point.  [default: the first calm after lift and tare]")
@click.option(
    "--of", type=click.Choice(["loop", "body"]), default="loop", show_default=True, help="Pilot and body, or the body."
)
@click.option("--inputs", metavar="NAMES", help="Inputs, separated by commas.  [default: all]")
@click.option("--outputs", metavar="NAMES", help="Channels, separated by commas.  [default: motion, thrusts, joints]")
@click.option("--modes", "count", type=click.IntRange(0), default=15, show_default=True, help="Modes that are printed.")
@click.option("--out", metavar="FILE", help="Write the model to FILE.npz, .json or .mat.")
@click.option("--figure", metavar="FILE", help="Draw modes and frequency response into FILE.png, .pdf or .svg.")
@style_option
@set_option
@controller_option()
def linearize(
    mission: str, out: str | None, figure: str | None, settings: tuple[str, ...], controller: str | None, **how: Any
) -> None:
    """Print the linear model of MISSION at a time of its flight.

    Modes, kinks and assumptions are printed. The model is x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k), of
    deviations from the flight. Its derivatives are exact. The sample time is the common period of all sensors.

    \b
    Examples:
      tandemlift linearize paper
      tandemlift linearize iris --at 9 --out iris.npz --figure iris.png
      tandemlift linearize hover --of body --inputs rotor_thrusts --outputs position,euler
    """
    import tandemlift as tl

    for option, path, endings in (("--out", out, (".npz", ".json", ".mat")), ("--figure", figure, DRAWINGS)):
        if path is not None:
            file_path(option, path, *endings)
    count, names = how.pop("count"), {name: how[name] and how[name].split(",") for name in ("inputs", "outputs")}
    model = tl.linearize(load(mission, settings, controller), **{**how, **names})
    echo(*model.lines(count))
    if out:
        model.save(out)
        echo(f"model: {out}")
    if figure:
        from tandemlift.pictures.drawing.linear_model_figure import draw_linear_model

        echo(f"figure: {draw_linear_model(model.connected(), Path(figure))}")


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

    Exit code 3: with --strict, a check fails.
    """
    import tandemlift as tl

    path = file_path("--json", file, ".json") if file else None
    with without_flight_warnings():  # the table has the same
        loaded = load(mission, settings, controller)
    results = tl.check(loaded)
    print_checks(results)
    if path:
        rows = [{**result._asdict(), "margin": result.margin} for result in results]
        write_file(path, json.dumps(rows, indent=1, ensure_ascii=False))
        echo(f"checks: {path}")
    if strict and any(result.verdict == "fails" for result in results):
        sys.exit(FAILED)


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@set_option
@controller_option("Controller to certify")
@click.option("--tiers", metavar="A,B,…", help="Some of linear, structured, person, nonlinear, statistics.")
@click.option("--fly", is_flag=True, help="Confirm each predicted limit by flights.")
@click.option("--flights", type=click.IntRange(1), default=300, show_default=True, help="Random flights of statistics.")
@click.option(
    "--arm", type=(float, float, float), metavar="K B M", help="Largest stiffness, damping and hand mass of an arm."
)
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME-certificate]")
@style_option
@click.option("--strict", is_flag=True, help="Exit with code 3 if a number is below its bar, or a tier not formed.")
def certify(
    mission: str,
    settings: tuple[str, ...],
    controller: str | None,
    tiers: str | None,
    out: str | None,
    strict: bool,
    **how: Any,
) -> None:
    """Certify MISSION: margins, limits, a person's arm, failures.

    Five tiers, each with its assumptions first: margins of the linear loops; worst parameters of the vehicle; the arm
    of a person; bounds on switching and thrust limits; failures among random flights.

    \b
    Examples:
      tandemlift certify iris --fly
      tandemlift certify mine.toml --tiers linear,person --arm 300 10 0.3

    \b
    Files in the results folder (other files there are left alone):
      certificate.html, .json, .pdf   the report; the PDF needs the extra "paper"
      mission.toml                    the mission with every key
      limits/                         missions that fly beyond each limit
      statistics/                     the study of random flights, which goes on where it stopped

    Ctrl-C keeps the tiers so far: exit code 130. 3: with --strict, a number is below its bar, or a tier has none.
    """
    from tandemlift.analysis.certification.certificate import TIERS, time_left
    from tandemlift.analysis.certification.certify import certify as certified
    from tandemlift.analysis.studies.execution.estimate import duration
    from tandemlift.pictures.report.study.certificate_report import certificate_lines, write_certificate

    loaded, chosen = load(mission, settings, controller), tiers.split(",") if tiers else TIERS
    with results_folder(out, Path("out") / f"{loaded.mission.name}-certificate", ()) as folder:
        names, began = [name for name in TIERS if name in chosen], monotonic()

        def tell(done: int, of: int) -> None:
            if done < of:
                left = time_left(names, done, monotonic() - began, fly=how["fly"], flights=how["flights"])
                click.echo(f"tier {done + 1} of {of}, {names[done]}: about {duration(left)} left", err=True)

        with compile_notices.together():
            found = certified(loaded, chosen, folder=folder / "statistics", progress=tell, **how)
        echo(*certificate_lines(found))
        for path in write_certificate(found, folder):
            echo(f"  {path.suffix[1:]}: {path}")
    if found.stopped:
        click.echo("stopped; the tiers so far are written", err=True)
        sys.exit(INTERRUPTED)
    if strict and (found.missed or found.not_formed):
        sys.exit(FAILED)


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option("--time", type=float, default=60.0, show_default=True, metavar="S", help="Duration of the excitation.")
@click.option("--room", default="2x2x1", show_default=True, metavar="XxYxZ", help="Room of the centre of mass, in m.")
@click.option("--push", type=float, default=0.0, metavar="N", help="Ask a person for pushes of about this force.")
@click.option("--out", metavar="FILE", help="Mission file that is written.  [default: NAME-excited.toml]")
@set_option
def excite(mission: str, time: float, room: str, push: float, out: str | None, settings: tuple[str, ...]) -> None:
    """Design the flight of MISSION that tells most of its vehicle.

    Sines move thrust, roll, pitch and yaw, within tilt, thrust, speed and room; then a person pushes, if asked to. It
    is flown once, kept within its limits, and identified from its log: the 95 % intervals that such a flight promises
    are printed, and written as comments.

    \b
    Examples:
      tandemlift excite iris --time 60 --room 2x2x1 --out excited.toml
      tandemlift run excited.toml
    """
    import tandemlift as tl

    try:
        sizes = [float(size) for size in room.split("x")]
    except ValueError:
        raise InputError(f"--room {room}: must be three sizes in m, such as 2x2x1") from None
    loaded = load(mission, settings)
    path = file_path("--out", out or f"{loaded.mission.name}-excited.toml", ".toml")
    design = tl.excite(loaded, time, room=sizes, push=push)
    write_file(path, design.text())
    echo(*design.lines())
    echo(f"mission: {path}")
