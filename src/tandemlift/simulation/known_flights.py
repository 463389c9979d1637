"""Flights of mission files that flew before, from disk: with neither tables nor laws.

The first numbers of a flight, its metrics and its findings follow from the mission's file, its settings, the sources of
this package, the versions of what it uses, and the processor. An entry beside the machine code, under a hash of all of
them, holds the first numbers; and metrics and findings, with a hash of the numbers that they were made from. The flight
itself is always flown. If it ends with other numbers, it is prepared and flown anew.

No user's code can be in an entry, or meet one: it is made and used only if no module with tables or laws was loaded
before, and what is not loaded has not been replaced. Missions that read further files or are warned of have none, nor
have flights that ended early; a process whose sources may have changed since it began makes and uses none.
"""

from __future__ import annotations

import json
import os
import re
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.compiler.machine_code import store
from tandemlift.compiler.machine_code.code import Code
from tandemlift.core.errors import FlightWarning
from tandemlift.core.files import versions
from tandemlift.core.findings import finding_from
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Progress, flat, leaves
from tandemlift.flight.channels import reading_stamps
from tandemlift.flight.record import Flight

if TYPE_CHECKING:
    from tandemlift.missions import MissionLike
    from tandemlift.simulation.plan import FlightPlan
    from tandemlift.simulation.results import RawResult

# this module is in a room of laws, and has none: it would hide every flight
WITH_LAWS = re.compile(r"tandemlift\.((parts|missions|engines|compiler\.tracer)\b|simulation\.(?!known_flights))")
_CODES = dict[str, Code]()  # that fly in this process
Numbers = NDArray[np.float64]
STRETCH, FIRST_STRETCH = 0.1, 5_000  # as in `simulation.fly`: s of a stretch of flight, steps of the first one


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
    file = KnownFile(mission) if engine in (None, "compiled") and isinstance(mission, (str, os.PathLike)) else None
    if file and (known := file.flight()):
        return known.fly(progress)
    from tandemlift.simulation.fly import fly_plan, plan_of

    p = plan_of(mission, engine)
    flight, flown = fly_plan(p, progress)
    if file:
        file.remember(p, flight, flown)
    return flight


class KnownFile:
    """A mission's file with some changes, as `load_mission` takes them, and what is on disk of its flight."""

    def __init__(self, name: str | os.PathLike[str], changes: Mapping[str, Any] | None = None) -> None:
        self._began, self._warnings = time.time_ns(), FlightWarning.count
        self._name, self._changes = _named(os.fspath(name)), dict(changes or {})
        self._key = _key(self._name, self._changes) if self._name else ""

    def flight(self) -> KnownFlight | None:
        """Its flight as it was prepared before; None if it is not known."""
        found = self._found()
        return found and KnownFlight(found, self._plan)

    def _plan(self) -> FlightPlan:
        from tandemlift.missions import load_mission
        from tandemlift.simulation.plan import FlightPlan

        return FlightPlan(load_mission(self._name, self._changes))

    def _found(self) -> store.StoredCode | None:
        """The entry of its flight, if the files that it was made from have not changed."""
        found = store.read(f"{self._key}-flight") if self._key else None
        return (
            found
            if found and all(store.hash_of_file(path) == of for path, of in found.about["files"].items())
            else None
        )

    def remember(self, p: FlightPlan, flight: Flight, flown: RawResult) -> None:
        """Keep what a flight of this file was prepared from, and what became of it, if these are certain."""
        from tandemlift.missions.loading import layers_of, path_of

        mission = p.mission
        reads = bool(mission.plugins or mission.person.recording or mission.vehicle.payload.mesh)
        alone = p.engine == "compiled" and not (p.stepwise or p.single or reads or flown.lost)
        if not self._key or not alone or FlightWarning.count != self._warnings or not store.hash_of_sources():
            return
        sources = [layer.source for layer in layers_of(path_of(self._name, Path()))]
        files = [source for source in sources if os.path.isabs(source)]  # built-in missions are in the key
        if store.are_older(files, self._began) and (entry := _entry(p, flight, flown)):
            about = {**entry.about, "files": {file: store.hash_of_file(file) for file in files}}
            store.write(f"{self._key}-flight", entry._replace(about=about))

    def facts(self, name: str, make: Callable[[], Any]) -> Any:
        """What `make` returns, as JSON, of nothing but the mission of the known flight; kept with the flight."""
        if not (found := self._found()):
            return make()
        key = f"{store.hash_of(self._key, found.about['mission'])}-{name}"
        if not (known := store.read(key)):
            store.write(key, known := store.StoredCode({"facts": make()}, b""))
        return known.about["facts"]


class KnownFlight:
    """A flight that was prepared before, of the mission `name`; `plan` prepares it anew."""

    def __init__(self, entry: store.StoredCode, plan: Callable[[], FlightPlan]) -> None:
        self._about, self._plan, at = entry.about, plan, 0
        self._arrays = dict[str, Numbers]()
        for name, shape in entry.about["arrays"].items():
            size = int(np.prod(shape))
            self._arrays[name] = np.frombuffer(entry.code, np.float64, size, at).reshape(shape)
            at += 8 * size
        self.name: str = entry.about["mission"]["mission"]["name"]

    def fly(self, progress: Progress | None = None) -> Flight:
        """Fly it; `progress` as for `tl.fly`. If it ends with other numbers than before, it is prepared anew."""
        with progress_or_own(self.name, progress, "steps") as shown:
            flight = self._flown(shown)
        if flight:
            return flight
        from tandemlift.simulation.fly import fly_plan

        return fly_plan(self._plan(), progress)[0]

    def _flown(self, progress: Progress | None) -> Flight | None:
        about, mission, key = self._about, self._about["mission"], self._about["code"]
        steps, late, (at, end) = about["steps"], about["late"], about["metrics"]
        code = _CODES.get(key) or _CODES.setdefault(
            key, Code(key, ["fly"], lambda: self._plan().loop_code.written("loop", 1))
        )
        held = {name: _placed(array) for name, array in self._arrays.items()}
        held |= {"work": _placed(np.zeros(code.about["size"])), "log": np.zeros(about["log"])}
        words, numbers, k, early = held["words"].view(np.int64), held["flight"], 0, np.zeros(0)
        place = about["places"]
        for name in about["pointers"]:
            words[place[name]] = held[name].ctypes.data
        began, pace = time.perf_counter(), code.pace or FIRST_STRETCH
        while k < steps:
            until = late if k < late < steps else steps + 1
            stop = until if k + pace >= until - 1 else k + pace  # never the last sample alone
            words[place["k"]], words[place["stop"]], before, at_once = k, stop, k, time.perf_counter()
            k = code.free["fly"](words.ctypes.data)
            words[place["fresh"]] = 0
            code.add_time(spent := time.perf_counter() - at_once)
            if k == late < steps:
                early, numbers[at:end] = numbers[at:end].copy(), held["empty"]
            if progress:
                progress(k, steps)
            if k < min(stop, steps):
                break
            pace = code.pace = max(FIRST_STRETCH, int((k - before) * min(STRETCH / max(spent, 1e-9), 4.0)))
        wall, log = time.perf_counter() - began, held["log"]
        if _ending(k, numbers[: about["state"]], early, log[0], held["last"]) != about["ending"]:
            return None
        times = np.arange(len(log), dtype=np.float64) * about["every"] * about["dt"]
        channels = {name: log[:, column] for name, column in _places(about["channels"])}
        return Flight(
            time=times,
            channels=channels | reading_stamps(mission, times, channels),
            mission=mission,
            results={**about["results"], "wall_s": wall},
            version={**versions("compiled"), "engine": "compiled"},
            findings=tuple(map(finding_from, about["findings"])),
        )


def _placed(array: Numbers) -> Numbers:
    """A copy that begins at a multiple of 64 bytes, as the code expects it."""
    padded = np.zeros(array.size + 8)
    first = -padded.ctypes.data % 64 // padded.itemsize
    placed = padded[first : first + array.size]
    placed[:] = array.ravel()
    return placed


def _places(columns: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """The place of each channel in a row of the log: a view of it where possible."""
    for name, place in columns.items():
        joined = isinstance(place, list) and place == list(range(place[0], place[0] + len(place)))
        yield name, slice(place[0], place[-1] + 1) if joined else place


def _ending(step: int, *numbers: Any) -> str:
    """A hash of all numbers that metrics and findings are made from."""
    return store.hash_of(step, *(np.ascontiguousarray(part, np.float64).tobytes() for part in numbers))


def _entry(p: FlightPlan, flight: Flight, flown: RawResult) -> store.StoredCode | None:
    """The entry of a flight; None if its code is not known by its sources, or its record is more than JSON holds."""
    from tandemlift.simulation.preparation import FlightMemory
    from tandemlift.simulation.preparation.memory import AT
    from tandemlift.simulation.results import channel_columns

    rows, columns = p.steps // p.every + 1, leaves(p.sample)
    memory = FlightMemory(p.loop_code.loop(1), [p.start()], p.grid(rows, p.every), columns)
    arrays: dict[str, Any] = {**memory.held, "empty": np.array(flat(p.model.flight_state.metrics))}
    early = flat(flown.early) if p.late_step < p.steps else []
    at, counts = p.place("flight_state", "metrics").at, {"steps": p.steps, "every": p.every, "late": p.late_step}
    about = {
        **{**counts, "dt": p.dt, "log": [rows, columns], "state": leaves(p.model.flight_state)},
        "code": p.loop_code.key("loop", 1),
        "mission": flight.mission,
        "results": {**flight.results, "wall_s": 0.0},
        "findings": [finding.as_table() for finding in flight.findings],
        "ending": _ending(flown.step, flat(flown.flight_state), early, flown.log[0], flown.last),
        "metrics": [at, at + arrays["empty"].size],
        "channels": {name: place.tolist() for name, place in channel_columns(p.sample).items()},
        "places": AT,
        "pointers": [*(name for name in memory.held if name != "words"), "work", "log"],
        "arrays": {name: list(array.shape) for name, array in arrays.items()},
    }
    whole = repr(json.loads(json.dumps(about))) == repr(about)
    code = b"".join(np.ascontiguousarray(array).tobytes() for array in arrays.values())
    return store.StoredCode(about, code) if about["code"] and whole else None


# ---- The key


def _named(name: str) -> str:
    """The name of a built-in mission, or the whole path of a mission's file; "" if it is neither by its name."""
    if re.fullmatch(r"[\w-]+", name) and (store.MISSIONS / f"{name}.toml").is_file():
        return name
    return os.path.abspath(name) if name.endswith(".toml") else ""


def _key(name: str, changes: dict[str, Any]) -> str:
    """The key of a mission's file with some changes; "" if its flight cannot be known."""
    if any(map(WITH_LAWS.match, sys.modules)) or not _is_plain(changes):
        return ""
    sources = store.hash_of_sources()
    return sources and store.hash_of(sources, name, changes)


def _is_plain(value: Any) -> bool:
    """Whether a value is plain through and through, so that its text is the whole of it."""
    if type(value) in (dict, list, tuple):
        return all(map(_is_plain, [*value, *value.values()] if type(value) is dict else value))
    return type(value) in (str, int, float, bool)
