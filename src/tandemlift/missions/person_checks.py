"""What a mission asks of a person who guides the vehicle by hand or pushes it: what cannot be, what may go badly."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.settings import Mission
from tandemlift.missions.recording import read_recording
from tandemlift.missions.values import shown
from tandemlift.parts.vehicle import Vehicle

GRIP = slice(1, 4)  # of a recorded hand
FARTHEST = 0.5  # m, of a push from the box of all parts


def check_point(m: Mission, key: str, point: Sequence[float]) -> None:
    """Refuse a push that does not act on the vehicle.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    vehicle = Vehicle.from_settings(m.vehicle)
    if vehicle.beside(point) > FARTHEST:
        low, high = (shown(np.round(corner, 3).tolist()) for corner in vehicle.box)
        given = f"{key} = {shown([float(x) for x in point])}"
        raise InputError(f"{given}: must be on the vehicle, whose parts reach from {low} to {high} m")


def check_person(m: Mission) -> None:
    """Refuse a person without a way to go, or who holds on where there is nothing.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    for i, push in enumerate(m.pushes):
        check_point(m, f"pushes.{i}.point", push.point)
    p, half = m.person, (m.vehicle.payload.length or 0.0) / 2.0
    if p.recording is not None and p.model != "virtual-hand":
        raise InputError(f'person.recording = "{p.recording}": must be left out where person.model is "{p.model}"')
    if p.model == "virtual-hand" and p.recording is not None:
        for grip in np.unique(read_recording(p.recording).hands[:, GRIP], axis=0):
            check_point(m, f"person.recording: a grip in {p.recording}", grip)
    if p.model in ("none", "virtual-hand"):
        return
    if not p.path and not m.corridor.centreline:
        raise InputError(
            f'person.model = "{p.model}": must be "none" without a way to go; give [[person.path]] or '
            "corridor.centreline"
        )
    if abs(p.grip) > half:
        raise InputError(f"person.grip = {p.grip}: must be on the payload, within ±{half:g} m of its centre")


def person_warnings(m: Mission) -> Iterator[str]:
    """What may go badly, with the numbers."""
    p, e = m.person, m.estimator
    if p.model in ("none", "virtual-hand"):
        return
    if m.pilot.guidance != "interactive":
        yield 'the person of [person] asks to land in vain: pilot.guidance is not "interactive"'
    tared = None if e.tare_start is None else e.tare_start + e.tare_duration
    if m.pilot.push != "truth" and tared is not None and p.start_time < tared:
        start = f"person.start_time = {p.start_time}"
        yield f"{start} is before the tare ends at {tared:g} s, which takes the push for a bias"
