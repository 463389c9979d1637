"""`tandemlift export`: a saved flight as a ROS bag or a table, a mission as a model of other simulators."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.results import flight_file
from tandemlift.cli.run import echo, parse_setting
from tandemlift.common.errors import InputError

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission


@click.command()
@click.argument("flight_or_mission")
@click.option("--out", metavar="FILE", required=True, help="FILE.mcap, FILE.bag, FILE.csv, FILE.sdf or FILE.xml.")
@click.option("--set", "settings", multiple=True, metavar="KEY=VALUE", help="Change one key of a mission.")
@click.option("--plugin", metavar="PORT|ros", help="Of FILE.sdf: with the plugin that pilots fly it through.")
def export(flight_or_mission: str, out: str, settings: tuple[str, ...], plugin: str | None) -> None:
    """Write a flight or a mission for other tools; the ending of FILE tells what.

    \b
    Of a flight:             .mcap  ROS 2 bag     .bag  ROS 1 bag     .csv  table
    Of a flight or mission:  .sdf   Gazebo world  .xml  MuJoCo model

    FLIGHT_OR_MISSION is a saved flight (flight.npz, or the folder that it is in), or a mission. Bags need the package
    rosbags (pip install 'tandemlift[export]'), MuJoCo models the package mujoco. What is in the files: docs/export.md.

    \b
    Examples:
      tandemlift export out/iris --out iris.mcap
      tandemlift export out/iris/flight.npz --out iris.bag
      tandemlift export zigzag --out zigzag.sdf
      tandemlift export four --set initial.euler=0.0 --out four.xml
    """
    from tandemlift.export import write as exporting

    path = Path(out)
    model = exporting.is_model(path)
    _, saved = flight_file(flight_or_mission)
    if settings and (saved or not model):
        raise InputError("--set is for a mission that is written to FILE.sdf or FILE.xml; a flight is what it is")
    if not saved and not model:
        raise InputError(
            f"{flight_or_mission} is no saved flight: give flight.npz, or the folder that a run wrote it to"
        )
    what = _flight(saved) if saved else _mission(flight_or_mission, settings)
    exporting.export(what, path, plugin=int(plugin) if plugin and plugin.isdecimal() else plugin)
    size = path.stat().st_size
    echo(f"{_name(what)}: {path} ({f'{size / 1e3:.0f} kB' if model else f'{size / 1e6:.1f} MB'})")


def _flight(saved: Path) -> Flight:
    from tandemlift.flight.record import Flight

    return Flight.load(saved)


def _mission(given: str, settings: tuple[str, ...]) -> Mission:
    from tandemlift.missions import load_mission

    return load_mission(given, dict(map(parse_setting, settings)))


def _name(what: Flight | Mission) -> str:
    return what.name if hasattr(what, "name") else what.mission.name
