"""The page that flies without a server, as files for any web server, or as one file that works from disk."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from tandemlift.apps.live.page_files import data_element, in_one_file, page_text, text_element, with_data, with_policy
from tandemlift.apps.live.page_modules import ENDING, FORMAT, PackedFlight
from tandemlift.apps.live.replay import replay_element
from tandemlift.codegen.mission_module import kept
from tandemlift.core.files import __version__, write_file, write_files
from tandemlift.missions import load_mission

FOLDER = "flights"  # beside the page's other files
MARK = 'id="flights"'  # in an index.html of ours
SHOWN_INSTEAD = "one-push"  # mission of the flight that a browser without WebAssembly plays
FRAME_STRIDE = 6  # frames of that flight, of which one is kept
ONLY_SERVER = (
    "another controller or gate, chosen in flight",
    "sensors tared anew",
    "missions that are not in this page, and the engines MuJoCo and Gazebo",
    "several people at one flight",
    "findings during the flight, with time and place",
    "saving into a folder, with the log of the flight; from here, `tandemlift run` makes that log of a saved file",
)
NO_MODULE = (
    "This browser runs no WebAssembly, which the flight needs, so a recorded flight is shown. "
    "Allow WebAssembly for this page, or take another browser, to fly and to push."
)
BROKEN = "the flight in this page is damaged: its checksum is wrong. Get the page again."
OTHER_VERSION = "the flight in this page was made by another version than the page. Get the page again."
_COMMON = "style-src 'self' 'unsafe-inline'; img-src data: blob:; media-src blob:; base-uri 'none'; form-action 'none'"
IN_FILES = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self'; worker-src 'self'; " + _COMMON
IN_ONE_FILE = "default-src 'none'; script-src 'sha256-{script}' 'wasm-unsafe-eval'; worker-src blob:; " + _COMMON


def offline_files(flights: Sequence[PackedFlight], files: Mapping[str, bytes]) -> dict[str, bytes]:
    """The files of a page for a web server, by their paths: those of `page_files` and the flights."""
    places = {flight.name: f"{FOLDER}/{flight.name}{ENDING}" for flight in flights}
    entries = [{**_entry(flight), "file": places[flight.name]} for flight in flights]
    html = with_policy(_with_flights(page_text(files, "/index.html"), entries), IN_FILES)
    content = {path.lstrip("/"): data for path, data in files.items() if path != "/"}
    packed = {places[flight.name]: flight.data for flight in flights}
    return {**content, "index.html": html.encode(), **packed}


def offline_html(flights: Sequence[PackedFlight], files: Mapping[str, bytes]) -> str:
    """The page as one file; its policy allows it no network."""
    worker = page_text(files, "/worker.js")
    entries = [{**_entry(flight), "data": base64.b64encode(flight.data).decode()} for flight in flights]
    html = with_data(_with_flights(page_text(files, "/index.html"), entries), text_element("worker", worker))
    return in_one_file(html, files, IN_ONE_FILE)


def write_page(
    flights: Sequence[PackedFlight], folder: Path | None, one_file: Path | None, files: Mapping[str, bytes]
) -> Iterator[str]:
    """Write a page of some files as files for a web server, as one file, or both; yields a line about each.

    Raises:
        InputError: a file cannot be written.
    """
    if folder is not None:
        written = offline_files(flights, files)
        write_files(folder, written)
        size = sum(map(len, written.values())) / 1e6
        yield f"{folder}: {len(written)} files, {size:.1f} MB; for a web server, such as: python -m http.server"
    if one_file is not None:
        write_file(one_file, offline_html(flights, files))
        yield f"{one_file}: {one_file.stat().st_size / 1e6:.1f} MB; open it in a browser"


def _entry(flight: PackedFlight) -> dict[str, Any]:
    return {"name": flight.name, "title": flight.title, "sha256": flight.sha256}


def _with_flights(html: str, entries: list[dict[str, Any]]) -> str:
    index = {
        "format": FORMAT,
        "version": __version__,
        "missions": entries,
        "only_server": ONLY_SERVER,
        "no_module": NO_MODULE,
        "broken": BROKEN,
        "other_version": OTHER_VERSION,
    }
    return with_data(html, data_element("flights", index) + _replay())


def _replay() -> str:
    """The flight that is shown where none can be flown."""
    from tandemlift.simulation.fly import fly

    mission = load_mission(SHOWN_INSTEAD)
    return kept(mission, "replay", lambda: replay_element(fly(mission), FRAME_STRIDE).encode()).decode()
