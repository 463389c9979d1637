"""Flights of a page: a mission's module and its manifest, packed into one file each.

    size of the manifest (4 bytes, little endian) | manifest (JSON) | module (WebAssembly)     compressed by gzip

A page rejects a flight whose checksum differs from that in its index.
"""

from __future__ import annotations

import functools
import gzip
import hashlib
import json
import os
import shlex
import signal
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.apps.live.page_manifest import page_functions, page_manifest
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.codegen.mission_module import kept, module_of
from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.core.files import DATA, __version__, write_file
from tandemlift.core.types import Progress
from tandemlift.missions import Mission, built_in, changed, load_mission
from tandemlift.simulation.plan import FlightPlan

MISSIONS = ("hover", "zigzag", "iris", "doorway", "rotor-loss")  # of a page, if no others are named
FORMAT = 1  # as in web/src/flight/manifest.ts
ENDING = ".flight"
SHIPPED = DATA / "flights"  # in an installed package


class PackedFlight(NamedTuple):
    """A flight as a page carries it.

    Attributes:
        name: of its mission.
        title: one line about it.
        sha256: of manifest and module, before they are compressed.
        data: compressed.
    """

    name: str
    title: str
    sha256: str
    data: bytes


def page_mission(name: str, changes: Mapping[str, Any] | None = None, controller: str | None = None) -> Mission:
    """A mission, with changes of its keys, as a page flies it: pushed by hand, and rounded alike on every machine."""
    with without_flight_warnings():
        loaded = load_mission(name, changes, controller=controller)
        return changed(interactive_mission(loaded), "mission.fma", False)


def flight_manifest(mission: Mission) -> tuple[dict[str, Any], bytes]:
    """The manifest of a page's flight, and its module."""
    with without_flight_warnings():  # rotors that may fail raise warnings of their own
        module = module_of(mission, "wasm32", page_functions)
        page = page_manifest(FlightPlan(mission))
    manifest = {"format": FORMAT, "version": __version__, "module": module.manifest, "page": page}
    return manifest, module.code


def packed_mission(mission: Mission, title: str) -> PackedFlight:
    """The flight of a mission that is as `page_mission` makes it."""
    return _packed(mission.mission.name, title, _data_of(mission))


def _packed(name: str, title: str, data: bytes) -> PackedFlight:
    return PackedFlight(name, title, hashlib.sha256(gzip.decompress(data)).hexdigest(), data)


def _data_of(mission: Mission) -> bytes:
    manifest, code = flight_manifest(mission)
    text = json.dumps(manifest, allow_nan=False, separators=(",", ":")).encode()
    return gzip.compress(len(text).to_bytes(4, "little") + text + code, 9, mtime=0)  # no time: the same bytes again


class PageFlight:
    """A flight that a page is to have.

    Args:
        given: name of a built-in mission, or the path of a file.
        controller: a registered one, or a .py file; None for the mission's own.

    Attributes:
        name: of the mission.
        ready: the flight, if it was shipped or made before.

    Raises:
        InputError: the mission cannot be loaded, or no page can fly it.
    """

    def __init__(self, given: str, controller: str | None = None) -> None:
        self.arguments = given, controller
        self._title = built_in().get(given, Path(given).name) + (f" Flown by {controller}." if controller else "")
        shipped = SHIPPED / f"{given}{ENDING}"
        self._mission = None if shipped.is_file() and not controller else page_mission(given, controller=controller)
        self.name = self._mission.mission.name if self._mission else given
        data = self._kept() if self._mission else shipped.read_bytes()
        self.ready = _packed(self.name, self._title, data) if data else None

    def _kept(self, make: Callable[[Mission], bytes] = lambda mission: b"") -> bytes:
        """The data of the flight from the cache, or else made.

        Raises:
            InputError: it cannot be compiled.
        """
        assert self._mission is not None
        try:
            return kept(self._mission, "page", functools.partial(make, self._mission))
        except InputError as error:
            live = " --controller ".join(map(shlex.quote, filter(None, self.arguments)))
            way = f"`tandemlift live {live}` also flies a controller with compiled=False"
            raise InputError(f"{error}. A page flies compiled code only; {way}.") from error

    def packed(self) -> PackedFlight:
        """The flight, made if it is not ready.

        Raises:
            InputError: it cannot be compiled.
        """
        self.ready = self.ready or _packed(self.name, self._title, self._kept(_data_of))
        return self.ready


def packed_flight(given: str, controller: str | None = None) -> PackedFlight:
    """The flight of `PageFlight`: as it was shipped, or as it was made before, or else made."""
    return PageFlight(given, controller).packed()


def packed_flights(
    given: Iterable[str] = MISSIONS, controller: str | None = None, progress: Progress | None = None
) -> list[PackedFlight]:
    """The flights of missions; those that were not made before are compiled on all processors.

    Args:
        given: names of built-in missions, or paths of files.
        controller: flies all of them: a registered one, or a .py file.
        progress: called with (flights made, flights to make).

    Raises:
        InputError: a mission cannot be loaded or compiled, or two have the same name.
    """
    flights = [PageFlight(one, controller) for one in dict.fromkeys(given)]
    names = [flight.name for flight in flights]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"mission.name = {name!r}: two missions of the page have it; it must be another in each")
    missing = [flight for flight in flights if not flight.ready]
    for done in _make(missing):
        if progress:
            progress(done, len(missing))
    return [flight.packed() for flight in flights]


def _make(missing: list[PageFlight]) -> Iterator[int]:
    """Make flights, yielding how many are made; several in processes of their own: LLVM is not parallel in one."""
    yield 0
    if len(missing) < 2:
        for flight in missing:
            flight.packed()
            yield 1
        return
    ends_at_once = signal.signal, (signal.SIGINT, signal.SIG_DFL)  # without a traceback
    count = min(len(missing), os.cpu_count() or 1)
    with ProcessPoolExecutor(count, get_context("spawn"), *ends_at_once) as pool:
        futures = {pool.submit(packed_flight, *flight.arguments): flight for flight in missing}
        for done, future in enumerate(as_completed(futures), 1):
            futures[future].ready = future.result()
            yield done


def build_modules(folder: Path, names: Iterable[str] = MISSIONS) -> list[Path]:
    """Write the flights of missions into a folder, which a wheel ships."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for flight in packed_flights(names):
        path = folder / f"{flight.name}{ENDING}"
        write_file(path, flight.data)
        written.append(path)
    return written
