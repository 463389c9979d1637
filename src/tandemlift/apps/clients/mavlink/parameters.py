"""Parameters of a MAVLink vehicle, in names of at most 16 characters: of modes, the mission's keys, and readings."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from typing import Any

from tandemlift import InputError
from tandemlift.apps.clients.mavlink.messages import mavlink
from tandemlift.apps.clients.mavlink.modes import LOSS_ACTION, PARAMETERS
from tandemlift.apps.clients.mission_numbers import MissionNumber

MAX_NAME_LENGTH = 16  # characters of a name


def name_of(key: str) -> str:
    """The name of a key: its words in capitals, all but the last cut to as many letters as there is room for.

    A number behind the last word belongs to it: `wind.velocity_1` is WIND_VELOCITY_1.
    """
    words = key.replace(".", "_").upper().split("_")
    last = "_".join(words[-2:] if words[-1].isdigit() and len(words) > 1 else words[-1:])[-MAX_NAME_LENGTH:]
    first = words[: len(words) - last.count("_") - 1]
    letters = (MAX_NAME_LENGTH - len(last) - len(first)) // max(len(first), 1)
    return "_".join([*(word[:letters] for word in first if letters > 0), last])


class MavlinkParameters:
    """The parameters of one quadrotor by name: `modes` for itself, keys of the mission, readings of the flight."""

    def __init__(self, keys: Mapping[str, MissionNumber], readings: Mapping[str, Callable[[], float]]) -> None:
        self.modes = {name: value for name, (value, _, _) in PARAMETERS.items()}
        self._keys = {name_of(key): parameter for key, parameter in keys.items()}
        self._readings = {name_of(key): read for key, read in readings.items()}
        self.names = [*self.modes, *self._keys, *self._readings]

    def message(self, name: str) -> Any:
        """The PARAM_VALUE of a name; an `InputError` if there is none."""
        if name not in self.names:
            raise InputError(f"no parameter {name}")
        key, kind = self._keys.get(name), mavlink.MAV_PARAM_TYPE_REAL32
        value = key.read() if key else self.modes[name] if name in self.modes else self._readings[name]()
        if name == LOSS_ACTION:  # a whole number, of which a client gets the bytes
            kind, (value,) = mavlink.MAV_PARAM_TYPE_INT32, struct.unpack("<f", struct.pack("<i", round(value)))
        return mavlink.MAVLink_param_value_message(name.encode(), value, kind, len(self.names), self.names.index(name))

    def set(self, name: str, value: float, kind: int) -> None:
        """Set a parameter to a value, sent as a `MAV_PARAM_TYPE`; an `InputError` if it may not have it."""
        if kind == mavlink.MAV_PARAM_TYPE_INT32:
            (value,) = struct.unpack("<i", struct.pack("<f", value))
        _, low, high = PARAMETERS.get(name, (0.0, 0.0, 0.0))
        if name in self.modes and low <= value <= high and (name != LOSS_ACTION or value in (low, high)):
            self.modes[name] = float(value)
        elif name not in self._keys or not self._keys[name].take(value):
            raise InputError(f"{name}: out of bounds, or a reading")
