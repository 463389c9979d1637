"""A mission as C99: its pilot and its whole flight, with self-tests, a build file and a README."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from tandemlift.codegen.c.expressions import number
from tandemlift.codegen.c.source import HASH, SourceFile
from tandemlift.codegen.c.text import wrapped
from tandemlift.codegen.c_flight import FlightFile
from tandemlift.codegen.c_pilot import PilotFile
from tandemlift.codegen.number_facts import facts_of
from tandemlift.codegen.prepare import PrepareFile
from tandemlift.core.files import check_own, write_files
from tandemlift.core.types import Array, leaves
from tandemlift.missions import Mission, tables_of
from tandemlift.simulation.fly import fly
from tandemlift.simulation.graphs import portable_mission, trace_assembly, with_values
from tandemlift.simulation.pilot_api import INPUT, Pilot, pilot_at_start
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import FlightMemory

VECTORS = 40  # stored samples of a pilot
ROWS = 12  # stored samples of a flight
MEASURED = ("position", "velocity", "attitude", "rates", "push_force")
TOLERANCE = 1e-3  # of the range of thrusts with 0, in single precision
NAN = 0x7FF8000000000000  # the value of every NaN in the sum over a log
GENERAL, MARK = ("CMakeLists.txt", "README.md"), "written by tandemlift"  # names that another project may have, too


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
        InputError: the mission's controller is plain Python, the mission changes while it is flown, or the folder has
            a CMakeLists.txt or README.md of somebody else.
    """
    for name in GENERAL:
        check_own(Path(folder) / name, MARK)
    mission = portable_mission(mission)
    file = source_file(mission, single)
    selftests = {
        f"{file.name}_pilot_selftest.c": pilot_selftest(file, pilot_vectors(mission)),
        f"{file.name}_flight_selftest.c": flight_selftest(file, FlightPlan(mission)),
    }
    return written(code_texts(mission, single) | selftests, Path(folder))


def source_file(mission: Mission, single: bool = False) -> SourceFile:
    """A file of C of a mission, as yet empty."""
    return SourceFile(mission.mission.name, single, mission.mission.step)


def with_hash(mission: Mission, texts: dict[str, str]) -> dict[str, str]:
    """Texts with the first 16 digits of a hash of the mission's tables and of the texts, which have its laws."""
    facts = json.dumps([tables_of(mission), texts], sort_keys=True, ensure_ascii=False, default=str)
    digest = hashlib.sha256(facts.encode()).hexdigest()[:16]
    return {name: text.replace(HASH, digest) for name, text in texts.items()}


def code_texts(mission: Mission, single: bool = False) -> dict[str, str]:
    """The texts of all files but the self-tests, by name."""
    mission = portable_mission(mission)
    file, of_pilot = source_file(mission, single), trace_assembly(mission, pilot_at_start)
    of_flight = trace_assembly(mission)
    pilot = PilotFile(file.anew(), with_values(of_pilot.assembled, of_pilot.graph))
    of_both = file.anew()
    of_both.unit.structs.agree(pilot.file.public(pilot.public))  # one source may include both headers
    flight = FlightFile(of_both, FlightPlan(mission, interactive=True))
    pilot_prepare = PrepareFile(file.anew(), of_pilot, "pilot")
    flight_prepare = PrepareFile(file.anew(), of_flight, "flight")
    facts = facts_of(mission, {*of_pilot.keys, *of_flight.keys})
    how = {"PRECISION": "single" if single else "double"}
    how["COMPARED"] = "within 1e-3 of the range of thrusts with 0" if single else "to the last bit"
    texts = {
        f"{file.name}_checks.h": file.filled("checks.h"),
        f"{file.name}_pilot.c": pilot.source(),
        f"{file.name}_pilot.h": pilot.header(),
        f"{file.name}_flight.c": flight.source(),
        f"{file.name}_flight.h": flight.header(),
        f"{file.name}_pilot_prepare.c": pilot_prepare.source(),
        f"{file.name}_pilot_prepare.h": pilot_prepare.header(facts),
        f"{file.name}_flight_prepare.c": flight_prepare.source(flight.traced_tables),
        f"{file.name}_flight_prepare.h": flight_prepare.header(facts, flight.traced_tables),
        "CMakeLists.txt": file.filled("CMakeLists.txt"),
        "README.md": file.filled("README.md", **how),
    }
    return with_hash(mission, texts)


def written(texts: dict[str, str], folder: Path) -> list[Path]:
    """Write texts to files of a folder: all of them, or none."""
    return write_files(folder, texts)


# ---- Programs that compare pilot and flight with stored samples of native flights


def braced(file: SourceFile, values: Iterable[float]) -> str:
    """Numbers in braces."""
    return "{" + ", ".join(number(float(x), file.real) for x in values) + "}"


def pilot_vectors(mission: Mission) -> list[tuple[Array, Array, Array]]:
    """(Memory, input, thrusts) of samples; the pilot is given the logged states of a flight one after the other."""
    pilot, flight, vectors = Pilot(mission), fly(mission, "compiled"), []
    rows = np.hstack([flight[name] for name in MEASURED])
    rows = rows[np.isfinite(rows).all(axis=1)]
    hold = max(1, mission.mission.steps // VECTORS)
    for row in rows[np.linspace(0, len(rows) - 1, VECTORS).astype(int)]:
        measurement = np.ascontiguousarray(row)
        for _ in range(hold - 1):
            pilot.step(measurement)
        memory = pilot.memory
        thrusts = pilot.step(measurement).copy()
        pilot_input = np.zeros(leaves(INPUT))
        pilot_input[:16], pilot_input[22] = measurement, 1.0
        vectors.append((memory, pilot_input, thrusts))
    return vectors


def pilot_selftest(file: SourceFile, vectors: Sequence[tuple[Array, Array, Array]]) -> str:
    """The program that compares the pilot with samples of `pilot_vectors`."""
    lines = [wrapped("{" + ", ".join(braced(file, part) for part in vector) + "},") for vector in vectors]
    memory, pilot_input, _ = vectors[0]
    span = np.ptp([np.append(thrusts, 0.0) for *_, thrusts in vectors])  # they may be constant
    words = {
        "VECTORS": str(len(vectors)),
        "MEMORY": str(len(memory)),
        "INPUT": str(len(pilot_input)),
        "TOLERANCE": number(TOLERANCE * float(span), "float"),
        "DATA": "\n".join(lines),
    }
    return file.filled("pilot_selftest.c", **words)


def sum_over(log: Array) -> int:
    """The sum over the bits of all numbers of a log, each times an odd weight; NaN counts as one number."""
    numbers = np.ascontiguousarray(log).ravel()
    bits = np.where(np.isnan(numbers), np.uint64(NAN), numbers.view(np.uint64))
    # an odd factor has an inverse modulo 2⁶⁴, so a change of any single bit changes the sum
    weights = 2 * np.arange(len(bits), dtype=np.uint64) + 1
    return int(np.sum(bits * weights, dtype=np.uint64))


def flight_selftest(file: SourceFile, p: FlightPlan) -> str:
    """The program that compares the whole flight."""
    memory = FlightMemory(p.loop_code.loop(1), [p.start()], p.grid(p.steps // p.every + 1, p.every), leaves(p.sample))
    memory.fly(p.steps + 1)
    log = memory.log[0][: min(memory.k, p.steps) // p.every + 1]
    if memory.k < p.steps and memory.k % p.every == 0:  # it diverged before the sample of that step
        log = log[:-1]
    rows = sorted(set(np.linspace(0, len(log) - 1, ROWS).astype(int)))
    data = [wrapped(braced(file, log[row]) + ",") for row in rows]
    words = {
        "ROWS": str(len(rows)),
        "STEPS_OF": ", ".join(str(row * p.every) for row in rows),
        "COLUMNS": str(log.shape[1]),
        "SUM": f"0x{sum_over(log):016X}",
        "DATA": "\n".join(data),
    }
    return file.filled("flight_selftest.c", **words)
