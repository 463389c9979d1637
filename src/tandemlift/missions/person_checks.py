"""What a mission asks of a person who guides the vehicle by hand: what cannot be, and what may go badly."""

from __future__ import annotations

from collections.abc import Iterator

from tandemlift.common.errors import InputError
from tandemlift.missions.recording import read_recording
from tandemlift.settings import Mission


def check_person(m: Mission) -> None:
    """Refuse a person without a way to go, or who holds on where there is nothing.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    p, half = m.person, (m.vehicle.payload.length or 0.0) / 2.0
    if p.recording is not None and p.model != "grab":
        raise InputError(f'person.recording = "{p.recording}": must be left out where person.model is "{p.model}"')
    if p.model == "grab" and p.recording is not None:
        read_recording(p.recording)
    if p.model in ("none", "grab"):
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
    if p.model in ("none", "grab"):
        return
    if m.pilot.guidance != "hand":
        yield 'the person of [person] asks to land in vain: pilot.guidance is not "hand"'
    tared = None if e.tare_start is None else e.tare_start + e.tare_duration
    if m.pilot.push != "truth" and tared is not None and p.start_time < tared:
        start = f"person.start_time = {p.start_time}"
        yield f"{start} is before the tare ends at {tared:g} s, which takes the push for a bias"
