"""Flights of a page: a mission's module and its manifest, packed into one file each.

    size of the manifest (4 bytes, little endian) | manifest (JSON) | module (WebAssembly)     compressed by gzip

A page rejects a flight whose checksum differs from that in its index.
"""

from __future__ import annotations

import gzip
import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.apps.live.page_functions import page_functions
from tandemlift.apps.live.page_manifest import page_manifest
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.codegen.mission_module import module_of
from tandemlift.core.errors import unknown, without_flight_warnings
from tandemlift.core.files import DATA, __version__, write_file
from tandemlift.missions import Mission, built_in, changed, load_mission
from tandemlift.simulation.plan import FlightPlan

MISSIONS = ("hover", "zigzag", "iris", "doorway", "rotor-loss")  # in the page's menu
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


def page_mission(name: str, changes: Mapping[str, Any] | None = None) -> Mission:
    """A mission, with changes of its keys, as a page flies it: pushed by hand, and rounded alike on every machine."""
    with without_flight_warnings():
        return changed(interactive_mission(load_mission(name, changes)), "mission.fma", False)


def flight_manifest(mission: Mission) -> tuple[dict[str, Any], bytes]:
    """The manifest of a page's flight, and its module."""
    with without_flight_warnings():  # rotors that may fail raise warnings of their own
        module = module_of(mission, "wasm32", page_functions)
        page = page_manifest(FlightPlan(mission))
    manifest = {"format": FORMAT, "version": __version__, "module": module.manifest, "page": page}
    return manifest, module.code


def packed_flight(name: str) -> PackedFlight:
    """The flight of a mission: as it was shipped, or else made; its module is compiled if it is in no cache."""
    shipped = SHIPPED / f"{name}{ENDING}"
    if not shipped.is_file():
        return packed_mission(page_mission(name), built_in()[name])
    data = shipped.read_bytes()
    return PackedFlight(name, built_in()[name], hashlib.sha256(gzip.decompress(data)).hexdigest(), data)


def packed_mission(mission: Mission, title: str) -> PackedFlight:
    """The flight of a mission that is as `page_mission` makes it."""
    manifest, code = flight_manifest(mission)
    text = json.dumps(manifest, allow_nan=False, separators=(",", ":")).encode()
    whole = len(text).to_bytes(4, "little") + text + code
    return PackedFlight(
        mission.mission.name, title, hashlib.sha256(whole).hexdigest(), gzip.compress(whole, 9, mtime=0)
    )


def packed_flights(
    names: Iterable[str] = MISSIONS, begun: Callable[[str], None] = lambda name: None
) -> list[PackedFlight]:
    """The flights of missions of the menu; `begun` is called with the name of each before it is built.

    Raises:
        InputError: a page has no such mission; nothing is built.
    """
    names, found = list(names), list[PackedFlight]()
    for name in names:
        if name not in MISSIONS:
            raise unknown("mission of a page", name, MISSIONS)
    for name in names:
        begun(name)
        found.append(packed_flight(name))
    return found


def build_modules(folder: Path, names: Iterable[str] = MISSIONS) -> list[Path]:
    """Write the flights of missions into a folder, which a wheel ships."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for flight in packed_flights(names):
        path = folder / f"{flight.name}{ENDING}"
        write_file(path, flight.data)
        written.append(path)
    return written
