"""Flights of mission files that flew before, from disk: with neither tables nor laws.

The first numbers of a flight, its metrics and its findings are functions of the mission's file, its settings, the
sources of this package, the versions of what it uses, and the processor. An entry beside the machine code, under a hash
of all these, holds the first numbers; and the metrics and findings, with a hash of the numbers that they were made
from. The flight itself is always flown. If it ends with other numbers, it is prepared and flown anew.

No user's code can be in an entry, or meet one. It is made and used only if no module with tables or laws was loaded
before: what is not loaded has not been replaced. Missions that read further files or are warned of have none, nor have
flights that ended early; and a process whose sources may have changed since it began makes and uses none.
"""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import json
import os
import re
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tandemlift.compiler.machine_code import store
from tandemlift.compiler.machine_code.code import Code, Written
from tandemlift.core.errors import FlightWarning
from tandemlift.core.files import DATA, LOADED, versions
from tandemlift.core.findings import finding_from
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Progress, flat, leaves
from tandemlift.flight.reading_stamps import reading_stamps
from tandemlift.flight.record import Flight
from tandemlift.simulation.preparation.memory import FlightMemory, FlightStart, Numbers, TimeGrid

if TYPE_CHECKING:
    from tandemlift.missions import MissionLike
    from tandemlift.simulation.plan import FlightPlan
    from tandemlift.simulation.results import RawResult

ROOMS = ("core", "parts", "compiler", "engines", "simulation", "missions", "flight", "pictures/report")
WITH_LAWS = re.compile(
    r"tandemlift\.(parts|missions|engines|compiler\.tracer)\b"
    r"|tandemlift\.simulation\.(?!(known_flights|preparation|preparation\.memory)$)"
)
MATHEMATICS = ("OPENBLAS", "OMP_", "MKL_", "BLIS_", "NPY_")  # beginnings of variables that may change its last bits
MISSIONS = DATA / "missions"
MARGIN = 2 * 10**7  # ns, by which the clock of files may be late
_CODES = dict[str, Code]()  # that fly in this process
TABLES = ("pushes", "gusts", "walls", "legs")


def fly(mission: MissionLike, engine: str | None = None, *, progress: Progress | None = None) -> Flight:
    """Fly a mission.

    Args:
        mission: from `load_mission`, or its name or path.
        engine: name of the engine; if None, that of the mission's recording, or "compiled".
        progress: called from time to time with (steps flown, steps in all); by default, a notebook shows a bar.

    Returns:
        The flight. If it crashed or diverged, or its engine was lost, it holds the samples until then, and `ending`
        has the reason.

    Raises:
        OSError: the engine in another process took no step at all.
        InputError: the engine is unknown, or the mission cannot be loaded or built.
    """
    file = FlightFile(mission) if engine in (None, "compiled") and isinstance(mission, (str, os.PathLike)) else None
    if file and (known := file.known()) and (flight := known.fly(progress)):
        return flight
    from tandemlift.simulation.fly import fly_plan, plan_of

    p = plan_of(mission, engine)
    flight, flown = fly_plan(p, progress)
    if file:
        file.remember(p, flight, flown)
    return flight


class FlightFile:
    """A mission's file with some changes, as `load_mission` takes them, and what is on disk of its flight."""

    def __init__(self, name: str | os.PathLike[str], changes: Mapping[str, Any] | None = None) -> None:
        self._began, self._warnings = time.time_ns(), FlightWarning.count
        self._name, self._changes = _named(os.fspath(name)), dict(changes or {})
        self._key = _key(self._name, self._changes) if self._name else ""

    def known(self) -> KnownFlight | None:
        """Its flight as it was prepared before; None if it is not known."""
        found = self._found()
        return found and KnownFlight(found, lambda: _plan(self._name, self._changes).loop_code.written("loop", 1))

    def _found(self) -> store.StoredCode | None:
        """The entry of its flight, if the files that it was made from have not changed."""
        found = store.read(f"{self._key}-flight") if self._key else None
        return found if found and all(_hash_of(path) == of for path, of in found.about["files"].items()) else None

    def remember(self, p: FlightPlan, flight: Flight, flown: RawResult) -> None:
        """Keep what a flight of this file was prepared from, and what became of it, if these are certain."""
        from tandemlift.missions.loading import layers_of, path_of

        mission = p.mission
        reads = mission.person.recording is not None or mission.vehicle.payload.mesh is not None
        alone = p.engine == "compiled" and not p.stepwise and not reads and not flown.lost
        if not self._key or not alone or FlightWarning.count != self._warnings or not _sources():
            return
        sources = [layer.source for layer in layers_of(path_of(self._name, Path()))]
        files = [source for source in sources if os.path.isabs(source)]  # built-in missions are in the key
        if any(os.stat(file).st_ctime_ns > self._began - MARGIN for file in files):
            return
        if entry := _entry(p, flight, flown):
            about = {**entry.about, "files": {file: _hash_of(file) for file in files}}
            store.write(f"{self._key}-flight", entry._replace(about=about))

    def facts(self, name: str, make: Callable[[], Any]) -> Any:
        """What `make` returns, as JSON, of nothing but the mission of the known flight; kept with the flight."""
        if not (found := self._found()):
            return make()
        of = hashlib.sha256(f"{self._key} {found.about['mission']}".encode()).hexdigest()[:32]
        key = f"{of}-{name}"
        known = store.read(key)
        if known is None:
            known = store.StoredCode({"facts": make()}, b"")
            store.write(key, known)
        return known.about["facts"]


class KnownFlight:
    """A flight that was prepared before.

    Attributes:
        name: of the mission.
    """

    def __init__(self, entry: store.StoredCode, write: Callable[[], Written]) -> None:
        self._about, self._write, at = entry.about, write, 0
        self._arrays = dict[str, Numbers]()
        for name, shape in entry.about["arrays"].items():
            size = int(np.prod(shape))
            self._arrays[name] = np.frombuffer(entry.code, np.float64, size, at).reshape(shape)
            at += 8 * size
        self.name: str = entry.about["mission"]["mission"]["name"]

    def fly(self, progress: Progress | None = None) -> Flight | None:
        """Fly it; `progress` as for `fly`. None if it ends with other numbers than before."""
        about, numbers, mission = self._about, self._arrays, self._about["mission"]
        steps, every, late, dt = (about[name] for name in ("steps", "every", "late", "dt"))
        start = FlightStart(numbers["numbers"], [numbers[t] for t in TABLES], numbers["ring"], numbers["keys"])
        grid = TimeGrid(steps, every, steps // every + 1, dt, numbers["delays"].astype(np.int64))
        with progress_or_own(self.name, progress, "steps") as shown:
            code = _CODES.get(key := about["code"]) or _CODES.setdefault(key, Code(key, ["fly"], self._write))
            memory = FlightMemory(code, [start], grid, about["columns"])
            began, early, sums = time.perf_counter(), np.zeros(0), memory.numbers[slice(*about["metrics"])]
            for k in memory.stretches(late):
                if k == late < steps:
                    early, sums[:] = sums.copy(), numbers["empty"]
                if shown:
                    shown(k, steps)
        wall, log = time.perf_counter() - began, memory.log[0]
        if _ending(memory.k, memory.numbers[: about["state"]], early, log[0], memory.last) != about["ending"]:
            return None
        times = np.arange(grid.rows, dtype=np.float64) * every * dt
        channels = {name: log[:, place] for name, place in _places(about["channels"])}
        return Flight(
            time=times,
            channels=channels | reading_stamps(mission, times, channels),
            mission=mission,
            results={**about["results"], "wall_s": wall},
            version={**versions("compiled"), "engine": "compiled"},
            findings=tuple(map(finding_from, about["findings"])),
        )


def _plan(name: str, changes: Mapping[str, Any]) -> FlightPlan:
    from tandemlift.missions import load_mission
    from tandemlift.simulation.plan import FlightPlan

    return FlightPlan(load_mission(name, changes))


def _places(columns: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """The place of each channel in a row of the log: a view of it where possible."""
    for name, place in columns.items():
        joined = isinstance(place, list) and place == list(range(place[0], place[0] + len(place)))
        yield name, slice(place[0], place[-1] + 1) if joined else place


def _ending(step: int, *numbers: Any) -> str:
    """A hash of all numbers that metrics and findings are made from."""
    digest = hashlib.blake2b(str(step).encode(), digest_size=16)
    for part in numbers:
        digest.update(b"|" + np.ascontiguousarray(part, np.float64).tobytes())
    return digest.hexdigest()


def _entry(p: FlightPlan, flight: Flight, flown: RawResult) -> store.StoredCode | None:
    """The entry of a flight; None if its code is not known by its sources, or its record is more than JSON holds."""
    from tandemlift.simulation.results import channel_columns

    start, grid = p.start(), p.grid(1, 1)
    arrays: dict[str, Any] = dict(zip(TABLES, start.tables, strict=True)) | {
        "numbers": start.numbers,
        "ring": start.ring,
    }
    arrays |= {"keys": start.keys, "delays": grid.delays, "empty": np.array(flat(p.model.flight_state.metrics))}
    early = flat(flown.early) if p.late_step < p.steps else []
    about = {
        "code": p.loop_code.key("loop", 1),
        "mission": flight.mission,
        "results": {**flight.results, "wall_s": 0.0},
        "findings": [finding.as_table() for finding in flight.findings],
        "ending": _ending(flown.step, flat(flown.flight_state), early, flown.log[0], flown.last),
        "steps": p.steps,
        "every": p.every,
        "dt": p.dt,
        "late": p.late_step,
        "columns": leaves(p.sample),
        "state": leaves(p.model.flight_state),
        "metrics": [at := p.place("flight_state", "metrics").at, at + arrays["empty"].size],
        "channels": {name: place.tolist() for name, place in channel_columns(p.sample).items()},
        "arrays": {name: list(array.shape) for name, array in arrays.items()},
    }
    whole = repr(json.loads(json.dumps(about))) == repr(about)
    code = b"".join(np.ascontiguousarray(array, np.float64).tobytes() for array in arrays.values())
    return store.StoredCode(about, code) if about["code"] and whole else None


# ---- The key


def _named(name: str) -> str:
    """The name of a built-in mission, or the whole path of a mission's file; "" if it is neither by its name."""
    if re.fullmatch(r"[\w-]+", name) and (MISSIONS / f"{name}.toml").is_file():
        return name
    return os.path.abspath(name) if name.endswith(".toml") else ""


def _key(name: str, changes: dict[str, Any]) -> str:
    """The key of a mission's file with some changes; "" if its flight cannot be known."""
    if any(map(WITH_LAWS.match, sys.modules)) or not _is_plain(changes):
        return ""
    sources = _sources()
    return sources and hashlib.sha256(f"{sources} {name!r} {changes!r}".encode()).hexdigest()[:32]


def _is_plain(value: Any) -> bool:
    """Whether a value is plain through and through, so that its text is the whole of it."""
    if type(value) in (dict, list, tuple):
        return all(map(_is_plain, [*value, *value.values()] if type(value) is dict else value))
    return type(value) in (str, int, float, bool)


def _sources() -> str:
    """A hash of what a flight follows from beside its mission; "" if a source may have changed since the start."""
    import llvmlite

    from tandemlift.compiler.machine_code.machine import processor

    pydantic = importlib.util.find_spec("pydantic")
    checks = Path(pydantic.origin).with_name("version.py") if pydantic and pydantic.origin else None
    if checks is None:
        return ""
    rooms = [entry for room in ROOMS for entry in os.walk(store.PACKAGE / room)]
    files = [os.path.join(folder, name) for folder, _, names in rooms for name in names if name.endswith(".py")]
    files += [str(checks), *map(str, MISSIONS.glob("*.toml"))]
    if any(os.stat(file).st_ctime_ns > LOADED - MARGIN for file in files):
        return ""
    arithmetic = sorted(item for item in os.environ.items() if item[0].startswith(MATHEMATICS))
    facts = sys.version, np.__version__, llvmlite.__version__, processor(), arithmetic
    return hashlib.sha256(f"{facts} {_hash_of_all(tuple(sorted(files)))}".encode()).hexdigest()


@functools.cache
def _hash_of_all(files: tuple[str, ...]) -> str:
    """A hash of the paths and contents of files that did not change since the start, and so are read once."""
    digest = hashlib.sha256()
    for file in files:
        with open(file, "rb", buffering=0) as opened:
            digest.update(f"\0{file}\0".encode() + opened.read())
    return digest.hexdigest()


def _hash_of(path: str) -> str:
    """A hash of a file's content; "" if it cannot be read."""
    try:
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()
    except OSError:
        return ""
