"""A mission made ready to be flown by the hands of those who watch it: nobody else pushes, and it goes on."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

from tandemlift.common.errors import FlightWarning, InputError
from tandemlift.missions import changed
from tandemlift.settings import Mission

LONGEST = 3600.0  # s
NEVER = 1e6  # s
HAND = {"model": "grab", "stiffness": 6.0, "damping": 2.0, "lag": 0.06, "max_force": 4.0}  # N/m, N s/m, s, N
CALM = 1e-3  # m/s, of turbulence: a wind that can be made to blow


def by_hand(mission: Mission) -> Mission:
    """The mission with a hand that is moved from outside instead of pushes and a person, and without a set landing.

    Where it can have them, a wind that can be made to blow, rotors that can be made to fail, and a pilot that looks out
    for both.
    """
    with warnings.catch_warnings():  # of what may go badly with rotors that may fail
        warnings.simplefilter("ignore", FlightWarning)
        return _by_hand(mission)


def renewed(now: Mission, first: Mission) -> Mission:
    """The mission that a flight has become, with rotors that are whole again, as they were in the first."""
    return now.model_copy(update={"faults": first.faults})


def _by_hand(mission: Mission) -> Mission:
    hand = HAND if mission.person.model != "grab" else {}
    mission = changed(mission, "person", {**hand, "recording": None})
    for key, value in _always(mission):
        mission = changed(mission, key, value)
    for key, value in _if_possible(mission):
        try:
            mission = changed(mission, key, value)
        except InputError:
            continue
    return mission


def _always(mission: Mission) -> Iterator[tuple[str, Any]]:
    yield "pushes", []
    yield "mission.duration", LONGEST
    yield "phases.land_start", NEVER


def _if_possible(mission: Mission) -> Iterator[tuple[str, Any]]:
    failing = {(f.quadrotor, f.rotor) for f in mission.faults}
    rotors = [(q + 1, r + 1) for q in range(len(mission.vehicle.quadrotors)) for r in range(4)]
    faults = [{"quadrotor": q, "rotor": r, "time": NEVER} for q, r in rotors if (q, r) not in failing]
    kept = [f.model_dump(mode="json", exclude_none=True) for f in mission.faults]
    yield "faults", [*kept, *faults]
    yield "detection.model", "residual"
    yield "supervision.model", "watch"
    if mission.wind.model == "none":
        yield "wind", {"model": "air", "turbulence": CALM}
