"""What a mission asks of a person who guides the vehicle by hand: what cannot be, and what may go badly."""

from __future__ import annotations

from collections.abc import Iterator

from tandemlift.errors import InputError
from tandemlift.missions.recording import read_recording
from tandemlift.settings import Mission


def check_company(m: Mission) -> None:
    """Refuse a person without a way to go, or who holds on where there is nothing.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    p, half = m.partner, (m.vehicle.payload.length or 0.0) / 2.0
    if p.recording is not None and p.model != "grab":
        raise InputError(f'partner.recording = "{p.recording}": must be left out where partner.model is "{p.model}"')
    if p.model == "grab" and p.recording is not None:
        read_recording(p.recording)
    if p.model in ("none", "grab"):
        return
    if not p.path and not m.corridor.centreline:
        raise InputError(
            f'partner.model = "{p.model}": must be "none" without a way to go; give [[partner.path]] or '
            "corridor.centreline"
        )
    if abs(p.grip) > half:
        raise InputError(f"partner.grip = {p.grip}: must be on the payload, within ±{half:g} m of its centre")


def doubts_of_company(m: Mission) -> Iterator[str]:
    """What may go badly, with the numbers."""
    p, e = m.partner, m.estimator
    if p.model in ("none", "grab"):
        return
    if m.pilot.guidance != "hand":
        yield 'the person of [partner] asks to land in vain: pilot.guidance is not "hand"'
    tared = None if e.tare_start is None else e.tare_start + e.tare_duration
    if m.pilot.push != "truth" and tared is not None and p.start < tared:
        yield f"partner.start = {p.start} is before the tare ends at {tared:g} s, which takes the push for a bias"
