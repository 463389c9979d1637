"""A mission as C99: its pilot and its whole flight, with self-tests, a build file and a README."""

from __future__ import annotations

from pathlib import Path

from tandemlift.codegen.c_flight import FlightFile
from tandemlift.codegen.c_pilot import PilotFile, PrepareFile
from tandemlift.codegen.c_selftests import flight_selftest, native_flight, pilot_selftest
from tandemlift.codegen.c_source import SourceFile
from tandemlift.missions import Mission
from tandemlift.simulation.assembly.traced_assembly import assembled_by_graph, assembled_flight, trace_assembly
from tandemlift.simulation.caller_values import portable_mission
from tandemlift.simulation.pilot_api import INPUT, pilot_at_start


def write_c(mission: Mission, folder: Path | str, single: bool = False) -> list[Path]:
    """Write a mission as C99: the pilot, the whole flight, self-tests, CMakeLists.txt and README.md.

    In double precision the code computes the bits of a native flight with `mission.fma = false`.

    Args:
        mission: from `load_mission`.
        folder: made if it does not exist.
        single: single precision instead of double.

    Returns:
        The files.

    Raises:
        InputError: the mission's controller is plain Python, or the mission changes while it is flown.
    """
    mission = portable_mission(mission)
    texts = code_texts(mission, single)
    unfused, flight = native_flight(mission)
    file = SourceFile(mission.mission.name, single, mission.mission.step)
    texts |= {
        f"{file.name}_pilot_selftest.c": pilot_selftest(file, unfused, flight),
        f"{file.name}_flight_selftest.c": flight_selftest(file, unfused),
    }
    return written(texts, Path(folder))


def code_texts(mission: Mission, single: bool = False) -> dict[str, str]:
    """The texts of all files but the self-tests, by name."""
    mission = portable_mission(mission)
    start = assembled_by_graph(mission, pilot_at_start)
    given = mission.mission.name, single, mission.mission.step
    file = SourceFile(*given)
    pilot = PilotFile(SourceFile(*given), start, INPUT)
    flight = FlightFile(SourceFile(*given), assembled_flight(mission), mission.mission.steps, mission.mission.log_every)
    pilot_prepare = PrepareFile(SourceFile(*given), trace_assembly(mission, pilot_at_start), "pilot")
    flight_prepare = PrepareFile(SourceFile(*given), trace_assembly(mission), "flight")
    how = {"PRECISION": "single" if single else "double"}
    how["COMPARED"] = "within 1e-3 of the range of thrusts" if single else "to the last bit"
    return {
        f"{file.name}_checks.h": file.filled("checks.h"),
        f"{file.name}_pilot.c": pilot.source(),
        f"{file.name}_pilot.h": pilot.header(),
        f"{file.name}_flight.c": flight.source(),
        f"{file.name}_flight.h": flight.header(),
        f"{file.name}_pilot_prepare.c": pilot_prepare.source(),
        f"{file.name}_pilot_prepare.h": pilot_prepare.header(),
        f"{file.name}_flight_prepare.c": flight_prepare.source(flight.traced_tables),
        f"{file.name}_flight_prepare.h": flight_prepare.header(flight.traced_tables),
        "CMakeLists.txt": file.filled("CMakeLists.txt"),
        "README.md": file.filled("README.md", **how),
    }


def written(texts: dict[str, str], folder: Path) -> list[Path]:
    """Write texts to files of a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / name for name in texts]
    for path, text in zip(paths, texts.values(), strict=True):
        path.write_text(text, encoding="utf-8")
    return paths
