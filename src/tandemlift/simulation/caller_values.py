"""Checks of values from a simulation's caller: arrays of finite numbers, and seeds."""

from __future__ import annotations

import math
import operator
from pathlib import Path
from typing import Any

import numpy as np

from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import Array
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
    gains = type(pilot_at_start(portable).parameters.controller)
    if gains in control.interpreted:
        code, name = control.table[gains].__code__, mission.controller.name
        place = f"{code.co_name}() in {Path(code.co_filename).name}, line {code.co_firstlineno},"
        way = "register it as a law, without compiled=False"
        text = f"controller.name = {name!r}: {place} is plain Python, of which no other machine has code; {way}"
        raise InputError(text)
    return portable


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


def checked_seed(seed: Any) -> int:
    """A seed as a whole number.

    Raises:
        InputError: the seed is not allowed.
    """
    try:
        number = operator.index(seed)
    except TypeError:
        number = -1
    if not 0 <= number <= MOST_SEED:
        raise InputError(f"seed = {shown(seed)}: must be a whole number from 0 to {MOST_SEED:g}")
    return number
