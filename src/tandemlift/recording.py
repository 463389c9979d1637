"""A hand as it was moved, step by step: the file that a recorded mission names in `partner.recording`.

A NumPy archive (.npz) of `step` (n,), whole and rising, and `hand` (n, 14): from that step on, held, grip (3), target
(3), force (3), lift, land, stop, enabled, as `laws.grab.Held` has them.
"""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.errors import InputError
from tandemlift.files import whole

WIDTH = 14  # numbers of a `Held`


class Recording(NamedTuple):
    """Steps (n,) and, from each on, the numbers of the hand (n, 14)."""

    steps: NDArray[np.int64]
    hands: NDArray[np.float64]


def write_recording(path: Path, recording: Recording) -> None:
    """Write a recording, whole or not at all."""
    with whole(path) as partial, partial.open("wb") as file:
        np.savez_compressed(file, step=recording.steps, hand=recording.hands)


def read_recording(path: str) -> Recording:
    """Read a recording.

    Raises:
        InputError: the file does not exist, or holds something else; the message says what.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            recording = Recording(archive["step"], archive["hand"])
    except FileNotFoundError:
        raise InputError(f"partner.recording = {path!r}: there is no such file") from None
    except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        raise InputError(f"partner.recording = {path!r}: not a recording: {error}") from None
    _check(path, recording)
    return recording


def _check(path: str, recording: Recording) -> None:
    steps, hands = recording
    if steps.dtype != np.int64 or steps.ndim != 1 or (steps.size and (steps[0] < 0 or np.any(np.diff(steps) <= 0))):
        raise InputError(f"partner.recording = {path!r}: `step` must be int64 (n,), rising from 0 or more")
    if hands.dtype != np.float64 or hands.shape != (steps.size, WIDTH) or not np.isfinite(hands).all():
        raise InputError(f"partner.recording = {path!r}: `hand` must be finite float64 ({steps.size}, {WIDTH})")
