"""A mission prepared for interactive flight: people push instead of the mission's pushes, and nothing ends it early."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from tandemlift.apps.live.session.page_messages import FlyMessage
from tandemlift.core.errors import InputError, unknown
from tandemlift.missions import Mission, built_in, changed, load_mission, mission_from_text

MAX_DURATION = 3600.0  # s
NEVER = 1e6  # s
SPRING = {"model": "virtual-hand", "stiffness": 6.0, "damping": 2.0, "lag": 0.08, "max_force": 4.0}  # N/m, N s/m, s, N
ALWAYS: dict[str, Any] = {
    "pushes": [],
    "requests": [],
    "mission.duration": MAX_DURATION,
    "phases.land_start": NEVER,
    "admittance.feel": None,  # mass and damping, which it comes to, are changed in flight
}
WHERE_POSSIBLE = {"detection.model": "residual", "supervision.model": "on", "contact.model": "on"}
FAINT_WIND = {"model": "air", "turbulence": 1e-3}  # m/s: the mission has a wind, which can be raised in flight


def interactive_mission(mission: Mission) -> Mission:
    """The mission with a virtual hand in place of its pushes and its person, and without a landing at a set time.

    Where the mission allows it, it also gets a wind, rotors that can fail, rotor-failure detection and supervision.
    """
    hand = SPRING if mission.person.model != "virtual-hand" else {}
    for key, value in {"person": {**hand, "recording": None}, **ALWAYS}.items():
        mission = changed(mission, key, value)
    failing = {(f.quadrotor, f.rotor) for f in mission.faults}
    rotors = [(q + 1, r + 1) for q in range(len(mission.vehicle.quadrotors)) for r in range(4)]
    faults = [{"quadrotor": q, "rotor": r, "time": NEVER} for q, r in rotors if (q, r) not in failing]
    kept = [f.model_dump(mode="json", exclude_none=True) for f in mission.faults]
    wind = {"wind": FAINT_WIND} if mission.wind.model == "none" else {}
    for key, value in {"faults": [*kept, *faults], **WHERE_POSSIBLE, **wind}.items():
        with suppress(InputError):
            mission = changed(mission, key, value)
    return mission


def other_mission(m: FlyMessage) -> Mission:
    """The mission that a page chooses, made interactive.

    Raises:
        InputError: there is no such built-in mission, or the file cannot be flown.
    """
    if m.toml is not None:
        return interactive_mission(mission_from_text(m.mission, m.toml))
    if m.mission not in built_in():
        raise unknown("mission", m.mission, built_in())
    return interactive_mission(load_mission(m.mission))


def with_whole_rotors(now: Mission, first: Mission) -> Mission:
    """The present mission, with the rotor faults of the first one."""
    return now.model_copy(update={"faults": first.faults})
