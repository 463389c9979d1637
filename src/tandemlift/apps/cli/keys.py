"""Commands to begin with and to look up: `new`, `missions`, `controllers`, `engines`, keys, and words for shells."""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Mapping

import click

from tandemlift.apps.cli.completion import SCRIPTS, keys, names
from tandemlift.apps.cli.console import echo
from tandemlift.apps.cli.flying import chosen_controller, plugin_option
from tandemlift.apps.export.results import file_path
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.files import atomic_write

FLOOR = 1e-4  # kg, of a new beam
controller_option = click.option(
    "--controller", metavar="FILE", help="Your own controller (.py file): its keys are included."
)


def _answer(option: str, given: float | None, default: float, low: float, high: float, unit: str) -> float:
    """The number of an option within its bounds: as given, as the terminal answers, or without one the default."""

    def checked(text: float | str) -> float:
        value = float(click.FLOAT(text))
        if not low <= value <= high:  # after which a terminal is asked again
            bounds = f"must be from {low:.3g} to {high:.3g} {unit}"
            raise click.BadParameter(f"{value:g}: {bounds}", param_hint=f"--{option}")
        return value

    if given is None and sys.stdin.isatty():
        return float(click.prompt(f"{option} [{unit}], {low:.3g} to {high:.3g}", default=default, value_proc=checked))
    return checked(default if given is None else given)


@click.command()
@click.argument("file", shell_complete=names(files=[".toml"]))
@click.option(
    "--quadrotor",
    "quadrotors",
    multiple=True,
    metavar="MODEL",
    shell_complete=names("quadrotor"),
    help="Their model: crazyflie, hummingbird, iris or x500; given twice, the left (+y) and the right one.  "
    "[default: iris]",
)
@click.option("--length", type=float, help="Length of the beam [m].  [default: as suits the model]")
@click.option("--center", type=float, help="Its centre of mass from its middle, to the left (+y) [m].  [default: 0]")
@click.option("--mass", type=float, help="Its mass [kg].  [default: as suits the model]")
@click.option("--force", is_flag=True, help="Overwrite FILE.")
def new(
    file: str, quadrotors: tuple[str, ...], length: float | None, center: float | None, mass: float | None, force: bool
) -> None:
    """Write a mission FILE of your beam on two quadrotors.

    It tells what they can lift, and which shakes of a hand are too much. A terminal is asked for what no option gives.
    Forces, moments and thresholds of the mission suit the weight: docs/how-to/change-the-vehicle.md has the rule, the
    models with their sources, and other quadrotors.

    \b
    Examples:
      tandemlift new beam.toml
      tandemlift new beam.toml --quadrotor crazyflie --length 0.4 --mass 0.015
      tandemlift new beam.toml --quadrotor iris --quadrotor x500
      tandemlift new beam.toml --length 2 --mass 0.5 --center 0.1 --force
    """
    from tandemlift.analysis.certification.shakes import shake_checks
    from tandemlift.apps.cli.new_mission import NewBeam, heaviest_words, hover_words, new_mission, quadrotor_models
    from tandemlift.missions import load_mission

    path, models = file_path("FILE", file, ".toml"), quadrotor_models()
    if path.exists() and not force:
        raise InputError(f"{file} exists; --force overwrites it")
    if not quadrotors and sys.stdin.isatty():
        _print_table(models)
        quadrotors = (click.prompt("quadrotor", default="iris", type=click.Choice(list(models))),)
    beam = NewBeam.default(*map(str.lower, quadrotors or ("iris",)))
    beam = beam._replace(length=_answer("length", length, beam.length, beam.shortest, 100.0, "m"))
    beam = beam._replace(center=_answer("center", center, 0.0, -0.5 * beam.length, 0.5 * beam.length, "m"))
    if (mass or FLOOR) > beam.largest_mass:
        raise InputError(f"--mass {mass or FLOOR:g}: {heaviest_words(beam)}")
    beam = beam._replace(mass=_answer("mass", mass, min(beam.mass, beam.largest_mass), FLOOR, beam.largest_mass, "kg"))
    echo(*hover_words(beam))
    with atomic_write(path) as partial_file:
        partial_file.write_text(new_mission(path.stem, beam), "utf-8")
        mission = load_mission(partial_file.absolute())
    echo(*(f"not promised: {result.text}" for result in shake_checks(mission) if result.text))
    name = shlex.quote(file)
    echo(f"written: {file}; next: tandemlift check {name}, tandemlift run {name}")


@click.command()
def template() -> None:
    """Print a mission file with every key, its unit and meaning.

    \b
    Examples:
      tandemlift template > mine.toml
      tandemlift run mine.toml
    """
    from tandemlift.missions.reference import template_text

    echo(template_text(), nl=False)


@click.command()
@click.argument("key", required=False, shell_complete=keys)
@controller_option
def explain(key: str | None, controller: str | None) -> None:
    """Explain a mission KEY: unit, meaning, bounds and default.

    KEY is a dotted key or a table. Without KEY, all tables are listed.

    \b
    Examples:
      tandemlift explain compliance.input_bandwidth
      tandemlift explain pushes.0.force
      tandemlift explain supervision.watchdog
      tandemlift explain controller.stiffness --controller my_pd.py
      tandemlift explain controller --controller my_pd.py
    """
    from tandemlift.missions.reference import explained, index

    own = "" if controller is None else chosen_controller(controller).name
    echo(index() if key is None else explained(key, own))


@click.command()
@controller_option
@plugin_option
def schema(controller: str | None) -> None:
    """Print the JSON Schema of mission files, for TOML editors.

    With the schema, an editor completes keys, shows their meaning and marks errors. Editors that use Taplo (such as
    Even Better TOML) find it by the first line of the mission file:

    \b
      tandemlift schema > mission.schema.json
      #:schema ./mission.schema.json
    """
    from tandemlift.missions.reference import mission_schema

    if controller is not None:
        chosen_controller(controller)
    echo(json.dumps(mission_schema(), indent=2, ensure_ascii=False))


@click.command()
@click.argument("shell", type=click.Choice(list(SCRIPTS)))
def completion(shell: str) -> None:
    """Print the script by which a SHELL completes commands and names.

    \b
    Examples:
      eval "$(tandemlift completion bash)"     # in ~/.bashrc
      eval "$(tandemlift completion zsh)"      # in ~/.zshrc, after compinit
      tandemlift completion fish | source      # in ~/.config/fish/config.fish
    """
    echo(SCRIPTS[shell].read_text("utf-8"), nl=False)


def _print_table(rows: Mapping[str, str]) -> None:
    width = max(map(len, rows)) + 2
    echo(*(f"{name:{width}}{summary}" for name, summary in rows.items()))


@click.command()
@click.argument("name", required=False, shell_complete=names("mission"))
def missions(name: str | None) -> None:
    """List the built-in missions, or print the file of one.

    \b
    Examples:
      tandemlift missions
      tandemlift missions iris > mine.toml
    """
    from tandemlift.core.files import DATA
    from tandemlift.missions import built_in

    if name is None:
        _print_table(built_in())
    elif name in built_in():
        echo((DATA / "missions" / f"{name}.toml").read_text("utf-8"), nl=False)
    else:
        raise unknown("mission", name, built_in())


@click.command()
def controllers() -> None:
    """List the controllers. One of your own is a file: docs/reference/controllers.md has one to begin with."""
    from tandemlift.core.plugs import load_all_installed
    from tandemlift.parts.controllers import CONTROLLERS

    load_all_installed()
    _print_table({name: c.summary for name, c in sorted(CONTROLLERS.items())})


@click.command()
def engines() -> None:
    """List the engines."""
    from tandemlift.core.plugs import load_all_installed
    from tandemlift.engines.registry import ENGINES

    load_all_installed()
    _print_table({name: e.summary for name, e in ENGINES.items()})
