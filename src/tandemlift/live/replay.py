"""A saved flight played again in the live page: its scene and frames are data in the page itself.

A page that has an element with the id `flight` plays the data in it and opens no socket.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from tandemlift.common.errors import InputError
from tandemlift.common.types import Array
from tandemlift.flight.record import Flight
from tandemlift.live.session.frame_values import arrays_of, components_of, field_values, phase_times
from tandemlift.live.session.scene_builder import scene_of_tables
from tandemlift.live.wire.frames import RATE, layout_for, pack_frames
from tandemlift.live.wire.scene import FlightScene, SceneReplay
from tandemlift.rendering.stage import FlightStage

MAX_FRAMES = 36_000  # ten minutes at the full rate; a longer flight has fewer frames a second
OFFLINE = (
    "default-src 'none'; script-src 'sha256-{script}'; style-src 'unsafe-inline'; img-src data: blob:; "
    "media-src blob:; base-uri 'none'; form-action 'none'"
)
SCRIPT = r"<script\b[^>]*\bsrc=[\"']?(?:\./|/)?page\.js[\"']?[^>]*>\s*</script>"
STYLE = r"<link\b[^>]*\bhref=[\"']?(?:\./|/)?page\.css[\"']?[^>]*>"


def scene_and_frames(flight: Flight) -> tuple[FlightScene, NDArray[np.float32]]:
    """The scene of a flight and its frames (count, width): samples of its log, 60 a second at most.

    Raises:
        InputError: nothing of the flight can be shown.
    """
    stage = FlightStage(flight)
    shown = np.flatnonzero(np.isin(flight.time, stage.time))
    shown = shown[:: _stride(flight.time[shown])]
    channels = {name: components_of(flight[name][shown]) for name in flight.channels}
    values = arrays_of(field_values(channels, flight.time[shown], phase_times(flight.mission["phases"])))
    frames = pack_frames(layout_for(stage.vehicle.rotor_count), values, len(shown))
    scene = scene_of_tables(flight.mission, stage.vehicle, flight.version.get("engine", ""), stage.floor)
    scene["replay"] = SceneReplay(start=float(flight.time[shown[0]]), end=float(flight.time[shown[-1]]), speed=1)
    return scene, frames


def replay_files(flight: Flight, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """The files of the page, with a flight in its data element."""
    html = _with_data(_text(files, "/index.html"), _data(flight)).encode()
    return {**files, "/": html, "/index.html": html}


def replay_html(flight: Flight, files: Mapping[str, bytes]) -> str:
    """One self-contained page that plays a flight; its policy allows it no network."""
    html = _with_data(_text(files, "/index.html"), _data(flight))
    script = re.sub(r"</(script)", r"<\\/\1", _text(files, "/page.js"), flags=re.I).replace("<!--", r"<\!--")
    style = re.sub(r"</(style)", r"<\\/\1", _text(files, "/page.css"), flags=re.I)
    policy = OFFLINE.format(script=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode())
    html = _once(STYLE, f"<style>{style}</style>", html)
    html = _once(SCRIPT, f'<script type="module">{script}</script>', html)
    return _once(r"<head\b[^>]*>", f'<head><meta http-equiv="Content-Security-Policy" content="{policy}">', html)


def _stride(time: Array) -> int:
    """The n of 'every n-th sample is shown'."""
    if len(time) < 2:
        return 1
    interval = float(np.median(np.diff(time)))
    return max(1, math.ceil(1.0 / (RATE * interval) - 1e-6), math.ceil(len(time) / MAX_FRAMES))


def _data(flight: Flight) -> str:
    """The element with scene and frames; no text of a mission can end it."""
    scene, frames = scene_and_frames(flight)
    data = {"scene": scene, "frames": base64.b64encode(frames.tobytes()).decode()}
    text = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    return f'<script type="application/json" id="flight">{text}</script>\n'


def _with_data(html: str, data: str) -> str:
    """A page with an element of data before the script that plays it."""
    return re.sub(f"(?={SCRIPT})", lambda _: data, html, count=1, flags=re.I)


def _once(pattern: str, new: str, html: str) -> str:
    html, count = re.subn(pattern, lambda _: new, html, flags=re.I)
    if count != 1:
        raise InputError(f"index.html of the page must have one element like {pattern}, it has {count}")
    return html


def _text(files: Mapping[str, bytes], path: str) -> str:
    """A file with the line ends that a browser's parser makes of it, so that its hash is right."""
    if path not in files:
        raise InputError(f"the page has no {path[1:]}; it is built from web/ and ships with an installed tandemlift")
    return files[path].decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
