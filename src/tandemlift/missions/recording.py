"""Recordings of a virtual hand, step by step: the file that a recorded mission names in `person.recording`.

A NumPy archive (.npz) of `step` (n,), whole and rising, and `hand` (n, 14): from that step on, held, grip (3), target
(3), force (3), lift, land, stop, enabled, as in a `VirtualHandInput`; and `engine`, the one that it was
recorded in ("compiled" where there is none).
"""

from __future__ import annotations

import atexit
import functools
import hashlib
import io
import shutil
import tempfile
import zipfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.errors import InputError
from tandemlift.core.files import atomic_write, unpacked_size

WIDTH = 14  # numbers of a `VirtualHandInput`
ENGINE = "compiled"  # the default engine
MISSION_FILE, HAND_FILE = "recorded.toml", "hand.npz"  # of a saved flight
MAX_UNPACKED = 200_000_000  # bytes of one of them, and of an unpacked recording: an hour has some 60 million
_held: dict[str, bytes] = {}


class Recording(NamedTuple):
    """Steps (n,), the numbers of the hand from each of them on (n, 14), and the engine of the flight."""

    steps: NDArray[np.int64]
    hands: NDArray[np.float64]
    engine: str = ENGINE


def write_recording(path: Path, recording: Recording) -> None:
    """Write a recording atomically."""
    with atomic_write(path) as partial, partial.open("wb") as file:
        np.savez_compressed(file, step=recording.steps, hand=recording.hands, engine=recording.engine)


def hold_recording(name: str, content: bytes) -> str:
    """Hold the content of a recording in this process; returns the path by which `read_recording` finds it.

    A study can thus fly its recording without a temporary file.
    """
    path = f"<study>/{hashlib.sha256(content).hexdigest()[:16]}/{Path(name).name}"
    _held[path] = content
    return path


def recording_bytes(path: str) -> bytes:
    """The content of a recording, held or from its file; an OSError if that cannot be read."""
    return _held[path] if path in _held else Path(path).read_bytes()


def read_recording(path: str) -> Recording:
    """Read a recording.

    Raises:
        InputError: the file does not exist or is no recording; the message has the reason.
    """
    try:
        with np.load(io.BytesIO(recording_bytes(path)), allow_pickle=False) as archive:
            if (size := unpacked_size(archive.zip)) > MAX_UNPACKED:
                raise InputError(f"it unpacks to {size} bytes, more than {MAX_UNPACKED}")
            engine = archive["engine"] if "engine" in archive else np.array(ENGINE)
            recording = Recording(archive["step"], archive["hand"], str(engine))
    except FileNotFoundError:
        raise InputError(f"person.recording = {path!r}: there is no such file") from None
    except Exception as error:  # all errors that arbitrary content can cause in the readers of ZIP and NPY
        raise InputError(f"person.recording = {path!r}: not a recording: {error}") from None
    _check(path, recording)
    return recording


def _check(path: str, recording: Recording) -> None:
    steps, hands, _ = recording
    if steps.dtype != np.int64 or steps.ndim != 1 or (steps.size and (steps[0] < 0 or np.any(np.diff(steps) <= 0))):
        raise InputError(f"person.recording = {path!r}: `step` must be int64 (n,), rising from 0 or more")
    if hands.dtype != np.float64 or hands.shape != (steps.size, WIDTH) or not np.isfinite(hands).all():
        raise InputError(f"person.recording = {path!r}: `hand` must be finite float64 ({steps.size}, {WIDTH})")


@functools.lru_cache(maxsize=32)
def unpacked_recording(path: Path, changed: int) -> Path:
    """The mission of a flight that a page saved as a .zip file, unpacked until the process ends.

    Args:
        path: of the file.
        changed: when it was changed last [ns].

    Raises:
        InputError: the file is not a saved flight.
    """
    folder = Path(tempfile.mkdtemp(prefix="tandemlift-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    try:
        with zipfile.ZipFile(path) as archive:
            for name in (MISSION_FILE, HAND_FILE):
                if archive.getinfo(name).file_size > MAX_UNPACKED:
                    raise InputError(f"{path}: {name} in it is larger than {MAX_UNPACKED} bytes")
                (folder / name).write_bytes(archive.read(name))
    except (KeyError, RuntimeError, NotImplementedError, zipfile.BadZipFile) as error:
        raise InputError(f"{path} is not a flight that a page saved: {error}") from None
    return folder / MISSION_FILE


def engine_of(recording: str | None) -> str:
    """The default engine of a mission: the engine of its recording, if it has one.

    Raises:
        InputError: the recording cannot be read.
    """
    return read_recording(recording).engine if recording else ENGINE


def portable(tables: dict[str, Any]) -> dict[str, Any]:
    """A mission's tables without the folder of its recording, which is stored beside the file of the tables."""
    recording = tables.get("person", {}).get("recording")
    return (
        tables if recording is None else {**tables, "person": {**tables["person"], "recording": Path(recording).name}}
    )
