"""Checks of values from a simulation's caller: arrays of finite numbers, and seeds."""

from __future__ import annotations

import math
import operator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import Array
from tandemlift.missions import Mission, changed
from tandemlift.parts.controllers import control
from tandemlift.simulation.loop.caller_inputs import CallerInput
from tandemlift.simulation.pilot_api import pilot_at_start
from tandemlift.simulation.preparation import leaf_offset


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
    gains = type(pilot_at_start(portable).parameters.controller)
    if gains in control.interpreted:
        code, name = control.table[gains].__code__, mission.controller.name
        place = f"{code.co_name}() in {Path(code.co_filename).name}, line {code.co_firstlineno},"
        way = "register it as a law, without compiled=False"
        text = f"controller.name = {name!r}: {place} is plain Python, of which no other machine has code; {way}"
        raise InputError(text)
    return portable


class Held(NamedTuple):
    """Inputs of a caller: place in a `CallerInput`, meaning, and place of the flag that makes them count, or None."""

    place: slice
    meaning: str
    flag: int | None


def held_inputs(external: CallerInput) -> dict[str, Held]:
    """The inputs of a caller by their names in `Simulation.step`."""
    spans = {name: leaf_offset(external, *path) for name, path in PATHS.items()}
    places = {name: slice(span.at, span.at + span.size) for name, span in spans.items()}
    flags = {"thrusts": places["override"].start, "velocity": places["given"].start}
    return {name: Held(places[name], meaning, flags.get(name)) for name, meaning in MEANINGS.items()}


PATHS = {
    "push": ("force",),
    "point": ("point",),
    "thrusts": ("thrusts",),
    "override": ("override",),
    "velocity": ("lead", "velocity"),
    "given": ("lead", "given"),
}
MEANINGS = {
    "push": "N, in world axes",
    "point": "m, in body axes",
    "thrusts": "N, one for each rotor",
    "velocity": "m/s, in world axes",
}
MOST_SEED = 10**18  # as `mission.seed`


def numbers(name: str, value: Any, count: int, what: str) -> Array:
    """An array of `count` finite numbers.

    Raises:
        InputError: the value is something else.
    """
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        array = np.empty(0, dtype=object)
    if array.shape != (count,) or array.dtype.kind not in "fiu" or not all(map(math.isfinite, array.tolist())):
        plain = value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
        raise InputError(f"{name} = {shown(plain)}: must be {count} finite numbers ({what})")
    return array


def count_of(name: str, value: Any) -> int:
    """A whole number of at least 1.

    Raises:
        InputError: the value is something else.
    """
    number = _whole(value)
    if number is None or number < 1:
        raise InputError(f"{name} = {shown(value)}: must be a whole number of at least 1")
    return number


def checked_seed(seed: Any) -> int:
    """A seed as a whole number.

    Raises:
        InputError: the seed is not allowed.
    """
    number = _whole(seed)
    if number is None or not 0 <= number <= MOST_SEED:
        raise InputError(f"seed = {shown(seed)}: must be a whole number from 0 to {MOST_SEED:g}")
    return number


def _whole(value: Any) -> int | None:
    try:
        return operator.index(value)
    except TypeError:
        return None
