"""A mission as C99: its pilot and its whole flight, with tests, a build file and a README."""

from __future__ import annotations

from pathlib import Path

from tandemlift.assembly.assemble import assemble
from tandemlift.common.errors import InputError
from tandemlift.controllers import control
from tandemlift.kernels.pilot_sampling import PilotData
from tandemlift.pilot.assemble import start_pilot
from tandemlift.settings import Mission
from tandemlift.simulation.pilot_api import INPUT
from tandemlift.targets.c.flight_file import FlightFile
from tandemlift.targets.c.pilot_file import PilotFile
from tandemlift.targets.c.source_file import SourceFile
from tandemlift.vehicle import Vehicle


def write_c(mission: Mission, folder: Path | str, single: bool = False) -> list[Path]:
    """Write a mission as C99.

    Args:
        mission: from `load_mission`.
        folder: made if it does not exist.
        single: single precision instead of double.

    Returns:
        The files.

    Raises:
        InputError: the mission's controller is plain Python.
    """
    parameters, memory = start_pilot(mission, Vehicle.from_settings(mission.vehicle))
    if type(parameters.controller) in control.interpreted:
        name = mission.controller.name
        raise InputError(f"controller {name!r} is plain Python: C needs a law; register it without compiled=False")
    file = SourceFile(mission.mission.name, single, mission.mission.step)
    pilot = PilotFile(file, PilotData(0.0, memory, parameters), INPUT)
    texts = {"checks.h": file.filled("checks.h"), "pilot.c": pilot.source(), "pilot.h": pilot.header()}
    file = SourceFile(mission.mission.name, single, mission.mission.step)
    flight = FlightFile(file, assemble(mission), mission.mission.steps, mission.mission.log_every)
    texts |= {"flight.c": flight.source(), "flight.h": flight.header()}
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name, text in texts.items():
        path = folder / (file.prefix + name)
        path.write_text(text, encoding="utf-8")
        paths.append(path)
    return paths
