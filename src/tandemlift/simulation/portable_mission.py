"""Missions as other machines fly them."""

from __future__ import annotations

from tandemlift.core.errors import InputError
from tandemlift.missions import Mission, changed
from tandemlift.parts.controllers import control
from tandemlift.simulation.pilot_api import pilot_at_start


def portable_mission(mission: Mission) -> Mission:
    """The mission with `mission.fma = false`, and with mass and damping in place of `[admittance.feel]`.

    Raises:
        InputError: its controller is plain Python, or it changes while it is flown.
    """
    if mission.changes:
        count = len(mission.changes)
        raise InputError(f"changes: {count} given, but other machines fly a mission as it begins; remove them")
    if mission.person.recording:
        recording = str(mission.person.recording)
        raise InputError(f"person.recording = {recording!r}: other machines play no recorded hand; remove it")
    portable = changed(mission, "mission.fma", False) if mission.mission.fma else mission
    if portable.admittance.feel:
        portable = changed(portable, "admittance.feel", None)
    if type(pilot_at_start(portable).parameters.controller) in control.interpreted:
        name = mission.controller.name
        way = "register it as a law, without compiled=False"
        raise InputError(f"controller.name = {name!r}: is plain Python, of which no other machine has code; {way}")
    return portable
