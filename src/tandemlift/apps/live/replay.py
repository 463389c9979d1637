"""A saved flight played again in the live page: its scene and frames are data in the page itself.

A page that has an element with the id `flight` plays the data in it and opens no socket.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from tandemlift.apps.live.page_files import data_element, in_one_file, page_files, page_text, with_data, with_element
from tandemlift.apps.live.session.frames import (
    RATE,
    arrays_of,
    components_of,
    field_values,
    layout_for,
    pack_frames,
    phase_times,
)
from tandemlift.apps.live.session.scene_builder import scene_of_tables
from tandemlift.apps.live.session.server_messages import FlightScene, SceneChange, SceneReplay
from tandemlift.apps.live.session.status import scene_ending, told
from tandemlift.core import errors
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.flight.record import Flight
from tandemlift.pictures.drawing.stage import FlightStage

IN_REPORT = 3000  # frames of a flight in its report, at most
MAX_FRAMES = 36_000  # ten minutes at the full rate; a longer flight has fewer frames a second
OFFLINE = (
    "default-src 'none'; script-src 'sha256-{script}'; style-src 'unsafe-inline'; img-src data: blob:; "
    "media-src blob:; base-uri 'none'; form-action 'none'"
)


def scene_and_frames(flight: Flight) -> tuple[FlightScene, NDArray[np.float32]]:
    """The scene of a flight and its frames (count, width): samples of its log, 60 a second at most.

    Raises:
        InputError: nothing of the flight can be shown.
    """
    stage = FlightStage(flight)
    samples = np.flatnonzero(np.isin(flight.time, stage.time))
    samples = samples[:: _stride(flight.time[samples])]
    channels = {name: components_of(flight[name][samples]) for name in flight.channels}
    values = arrays_of(field_values(channels, flight.time[samples], phase_times(flight.mission["phases"])))
    frames = pack_frames(layout_for(stage.vehicle.rotor_count), values, len(samples))
    engine = flight.version.get("engine", "")
    scene = scene_of_tables(flight.mission, flight.walls, stage.vehicle, engine, stage.floor)
    start, end = (float(flight.time[samples[i]]) for i in (0, -1))
    ending = scene_ending(flight.ending, flight["position"][samples[-1]])
    changes = flight.mission.get("changes", ())
    scene["replay"] = SceneReplay(
        start=start,
        end=end,
        speed=1,
        ending=ending,
        findings=told(flight.findings),
        changes=[SceneChange(time=c["time"], text=f"{c['key']} = {errors.shown(c['value'])}") for c in changes],
    )
    return scene, frames


def replay_files(flight: Flight, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """The files of the page, with a flight in its data element."""
    return with_element(files, replay_element(flight))


def replay_html(flight: Flight, files: Mapping[str, bytes], most: int = MAX_FRAMES) -> str:
    """One self-contained page that plays a flight, of `most` frames; its policy allows it no network."""
    return in_one_file(with_data(page_text(files, "/index.html"), replay_element(flight, most=most)), files, OFFLINE)


def report_replay(flight: Flight) -> str | None:
    """The page that plays a flight in its report; None if nothing of the flight can be shown."""
    try:
        return replay_html(flight, page_files(), IN_REPORT)
    except InputError:
        return None


def replay_element(flight: Flight, every: int = 1, most: int = MAX_FRAMES) -> str:
    """The element with scene and frames; `every`: n of 'every n-th frame', at least so many that no more are left."""
    scene, frames = scene_and_frames(flight)
    every = max(every, math.ceil(len(frames) / most))
    return data_element("flight", {"scene": scene, "frames": base64.b64encode(frames[::every].tobytes()).decode()})


def _stride(time: Array) -> int:
    """The n of 'every n-th sample is shown'."""
    if len(time) < 2:
        return 1
    interval = float(np.median(np.diff(time)))
    return max(1, math.ceil(1.0 / (RATE * interval) - 1e-6), math.ceil(len(time) / MAX_FRAMES))
