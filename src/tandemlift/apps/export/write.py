"""Writes a flight as a ROS 2 bag (MCAP), a ROS 1 bag or a table (CSV); a mission as a model of other simulators.

Both bags hold the same topics, `topics.py`; a table holds every channel. A mission becomes a world of Gazebo (SDF) or a
MuJoCo model (MJCF). The same flight or mission gives the same bytes, with the same versions of the packages that write
them.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from tandemlift.apps.export.bags import write_bag, write_mcap
from tandemlift.apps.export.csv_file import write_csv
from tandemlift.core.errors import InputError
from tandemlift.core.files import atomic_write
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, check

FORMATS: dict[str, Callable[[Flight, Path], None]] = {".mcap": write_mcap, ".bag": write_bag, ".csv": write_csv}
WORLD, MODEL = ".sdf", ".xml"
OF_FLIGHT = ".mcap (ROS 2 bag), .bag (ROS 1 bag) or .csv (table)"
OF_MISSION = ".sdf (Gazebo world) or .xml (MuJoCo model)"
ENDINGS = f"must end in {OF_FLIGHT}, or for a mission in {OF_MISSION}"


def export(what: Flight | Mission, path: str | os.PathLike[str], *, plugin: int | str | None = None) -> Path:
    """Write a flight or a mission atomically to a file whose ending selects the format.

    Args:
        what: a flight, also one that diverged; or a mission. Of a flight, a world and a model are those of its mission.
        path: of the file: .mcap, .bag or .csv of a flight, .sdf or .xml of either; its folder is made if it does not
            exist.
        plugin: of a world, the port of Gazebo's plugin, or "ros" for the one that is led over ROS 1; without it the
            world has no plugin.

    Returns:
        The path.

    Raises:
        InputError: the ending is none of these, a package is missing, the flight lacks a channel, the mission's vehicle
            cannot be such a model, or the file cannot be written.
    """
    path = Path(path)
    write = _writer(what, path, plugin)
    try:
        if path.is_dir():
            raise IsADirectoryError(None, "it is a folder")
        with atomic_write(path) as partial:
            write(partial)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error
    return path


def is_model(path: Path) -> bool:
    """Whether a file of this name is a model of a mission, or else data of a flight.

    Raises:
        InputError: its ending belongs to no known format.
    """
    ending = path.suffix.lower()
    if ending not in (*FORMATS, WORLD, MODEL):
        raise InputError(f"{path}: {ENDINGS}")
    return ending in (WORLD, MODEL)


def _writer(what: Flight | Mission, path: Path, plugin: int | str | None) -> Callable[[Path], object]:
    """The function that writes it to a path.

    Raises:
        InputError: it cannot be such a file.
    """
    ending, is_of_mission = path.suffix.lower(), is_model(path)
    _check_plugin(plugin, path)
    if is_of_mission:
        mission = what if isinstance(what, Mission) else check(what.mission, f"flight {what.name!r}")
        if ending == WORLD:
            from tandemlift.engines.models.sdf import world

            text = world(mission, plugin)
        else:
            from tandemlift.engines.models.mjcf import model_text

            text = model_text(mission)
        return lambda partial: partial.write_bytes(text.encode())
    if isinstance(what, Mission):
        raise InputError(f"{path}: mission {what.mission.name!r} is no flight: fly it, or write {OF_MISSION}")
    if not len(what.time):
        raise InputError(f"flight {what.name!r} has no sample to export")
    return lambda partial: FORMATS[ending](what, partial)


def _check_plugin(plugin: int | str | None, path: Path) -> None:
    if plugin is None:
        return
    if path.suffix.lower() != WORLD:
        raise InputError(f"{path}: only a world, {WORLD}, has a plugin")
    if plugin != "ros" and not (isinstance(plugin, int) and 1 <= plugin <= 65535):
        raise InputError(f"plugin = {plugin}: must be a port, from 1 to 65535, or 'ros'")
