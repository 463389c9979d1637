"""`tandemlift export`: a saved flight as a ROS bag or a table, a mission as a model for other simulators."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.terminal.completion import FLIGHTS_AND_MISSIONS, MISSIONS, names
from tandemlift.apps.cli.terminal.console import echo
from tandemlift.apps.cli.terminal.mission_options import chosen_controller, controller_option, load, set_option
from tandemlift.apps.cli.terminal.results import flight_file
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission


@click.command()
@click.argument("flight_or_mission", shell_complete=FLIGHTS_AND_MISSIONS)
@click.option("--out", metavar="FILE", required=True, help="FILE.mcap, FILE.bag, FILE.csv, FILE.sdf or FILE.xml.")
@set_option
@click.option(
    "--plugin",
    metavar="PORT|ros",
    help="For FILE.sdf: connect a pilot by a plugin.",
)
def export(flight_or_mission: str, out: str, settings: tuple[str, ...], plugin: str | None) -> None:
    """Write a flight or a mission for other tools; the ending of FILE selects the format.

    \b
    A flight:               .mcap  ROS 2 bag     .bag  ROS 1 bag     .csv  table
    A flight or a mission:  .sdf   Gazebo world  .xml  MuJoCo model

    FLIGHT_OR_MISSION is a saved flight (flight.npz or its folder) or a mission. Bags need the package rosbags
    (pip install 'tandemlift[export]'), MuJoCo models the package mujoco. docs/reference/export.md describes the files.

    \b
    Examples:
      tandemlift export out/iris --out iris.mcap
      tandemlift export out/iris/flight.npz --out iris.bag
      tandemlift export zigzag --out zigzag.sdf
      tandemlift export four --set initial.euler=0.0 --out four.xml
    """
    from tandemlift.apps.export import write as exporting

    path = Path(out)
    model = exporting.is_model(path)
    _, saved = flight_file(flight_or_mission)
    if settings and (saved or not model):
        raise InputError(
            "--set is for a mission that is written to FILE.sdf or FILE.xml; a saved flight cannot be changed"
        )
    if not saved and not model:
        raise InputError(f"{flight_or_mission} is no saved flight: give flight.npz or the folder of a run")
    what = _flight(saved) if saved else load(flight_or_mission, settings)
    exporting.export(what, path, plugin=int(plugin) if plugin and plugin.isdecimal() else plugin)
    size = path.stat().st_size
    echo(f"{_name(what)}: {path} ({f'{size / 1e3:.0f} kB' if model else f'{size / 1e6:.1f} MB'})")


def _flight(saved: Path) -> Flight:
    from tandemlift.flight.record import Flight

    return Flight.load(saved)


def _name(what: Flight | Mission) -> str:
    return what.name if hasattr(what, "name") else what.mission.name


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option(
    "--target",
    required=True,
    metavar="TARGET",
    shell_complete=names("target"),
    help="wasm32, c, aarch64 or cortex-m7.",
)
@click.option("--out", metavar="DIR", help="Folder for the files; by default out/NAME-TARGET.")
@click.option("--single", is_flag=True, help="For C: compute in single precision.")
@set_option
@controller_option
def compile(
    mission: str, target: str, out: str | None, single: bool, settings: tuple[str, ...], controller: str | None
) -> None:
    """Compile a mission for another machine: pilot, body and loop, with the same bits everywhere.

    \b
    wasm32     NAME.wasm, without imports, for browsers and Node.js
    c          C99 sources with CMake: the pilot alone, and the whole flight
    aarch64    NAME.o for 64-bit ARM with Linux
    cortex-m7  NAME.o for microcontrollers with double precision

    The code takes the numbers of a mission file: masses, gains, pushes. NAME.json, the manifest, lists them with unit
    and bounds, and the channels of a flight. docs/how-to/compile.md shows how to call the code.

    \b
    Examples:
      tandemlift compile iris --target wasm32
      tandemlift compile iris --target c --single --out pilot
      tandemlift compile zigzag --target aarch64 --set vehicle.payload.mass=0.6
      tandemlift compile hover --target c --controller my_pd.py
    """
    from tandemlift.codegen.mission_module import compile_mission

    chosen = None if controller is None else chosen_controller(controller)
    what = load(mission, settings, chosen)
    folder = Path(out) if out else Path("out") / f"{what.mission.name}-{target}"
    for path in compile_mission(what, target, folder, single=single):
        echo(f"{path} ({path.stat().st_size / 1e3:.0f} kB)")
