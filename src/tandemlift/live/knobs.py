"""The settings of a flight, turned by those who watch it: set, brought back, and rotors that are stopped.

A change is made ready beside the flight, which goes on meanwhile, one after the other.
"""

from __future__ import annotations

import threading
from typing import Any

from tandemlift.common.errors import InputError
from tandemlift.live.by_hand import NEVER
from tandemlift.live.controls import BY_KEY, CHOICES, CONTROLLER, bounds_of, keys_of, value_of
from tandemlift.live.recorded import RecordedFlight
from tandemlift.live.taring import TARE, check_in_time, start_of_tare
from tandemlift.missions import tables_of
from tandemlift.missions.values import MISSING, shown
from tandemlift.settings import Mission

RAMP = 0.5  # s, within which a setting changes
Told = list[dict[str, Any]]


class Knobs:
    """Turns the settings of flights that began as one mission.

    Args:
        first: the mission that settings are brought back to.
        lock: of the flight's thread.

    Attributes:
        turn: of who changes a flight; to be taken before the other lock.
    """

    def __init__(self, first: Mission, lock: threading.RLock) -> None:
        self._first, self._lock = first, lock
        self.turn = threading.RLock()

    def set(self, flight: RecordedFlight, key: str, value: Any) -> Told:
        """Set a control, and tell of it.

        Raises:
            InputError: it is none, or the value is beyond its bounds or cannot be taken in flight.
        """
        self._check(key, value)
        return self._set_to(flight, key, [value] * len(keys_of(self._first, key)))

    def restore(self, flight: RecordedFlight, key: str | None) -> Told:
        """Bring a control back to what the first mission says, or all of them; what cannot be is told, not raised."""
        told = Told()
        for one in [*CHOICES, *BY_KEY] if key is None else [key]:
            try:
                told += self._restored(flight, one)
            except InputError as error:
                told.append({"type": "refused", "what": f"restore {one}", "reason": str(error)})
        return told

    def kill(self, flight: RecordedFlight, rotor: int) -> None:
        """Stop a rotor for good; counted over the whole vehicle, from 0.

        Raises:
            InputError: it cannot fail, or does so already.
        """
        faults = flight.now.faults
        at = [i for i, f in enumerate(faults) if 4 * (f.quadrotor - 1) + f.rotor - 1 == rotor]
        if not at:
            raise InputError(f"rotor = {rotor}: the rotors of this mission cannot fail")
        if faults[at[0]].time < NEVER:
            raise InputError(f"rotor = {rotor}: fails at {faults[at[0]].time:g} s already")
        self._change(flight, f"faults.{at[0]}.time", flight.step * flight.dt, 0.0)

    def tare(self, flight: RecordedFlight) -> str:
        """Begin a tare of the force sensors, in a moment; from when to when.

        Raises:
            InputError: the mission has none that can be begun, or it did not become ready in time.
        """
        with self.turn:
            start = start_of_tare(flight)
            due = flight.prepare(TARE, start)
            with self._lock:
                check_in_time(flight, start)
                flight.change(due, TARE, start)
        return f"from {start:g} s to {start + flight.now.estimator.tare_duration:g} s"

    def _check(self, key: str, value: Any) -> None:
        """Refuse what is no control, or beyond its bounds."""
        if key in CHOICES:
            return
        if key not in BY_KEY:
            raise InputError(f"{key}: is not among the controls; there are {', '.join([*CHOICES, *BY_KEY])}")
        low, high = bounds_of(BY_KEY[key], self._first)
        for number in value if isinstance(value, list) else [value]:
            if isinstance(number, bool) or not isinstance(number, (int, float)):
                raise InputError(f"{key} = {shown(value)}: must be a number, or a list of numbers")
            if not low <= number <= high:
                raise InputError(f"{key} = {shown(value)}: must be from {low:g} to {high:g}")

    def _restored(self, flight: RecordedFlight, key: str) -> Told:
        first, now = tables_of(self._first), tables_of(flight.now)
        keys = keys_of(self._first, key)
        values = [value_of(first, one) for one in keys]
        if MISSING in values or values == [value_of(now, one) for one in keys]:
            return []
        return self._set_to(flight, key, values)

    def _set_to(self, flight: RecordedFlight, key: str, values: list[Any]) -> Told:
        """Set what a control stands for, one value each."""
        duration = 0.0 if key in CHOICES else RAMP
        for one, value in zip(keys_of(self._first, key), values, strict=True):
            self._change(flight, one, value, duration)
        now = value_of(tables_of(flight.now), key)
        return [{"type": "changed", "key": key, "value": now, "duration": duration}]

    def _change(self, flight: RecordedFlight, key: str, value: Any, duration: float) -> None:
        """Make a change ready beside the flight, and let it begin."""
        with self.turn:
            if flight.over:
                raise InputError(f"{key}: the flight is over; reset it first")
            if key == CONTROLLER and value == self._first.controller.name:  # with the mission's own settings
                key, value = "controller", tables_of(self._first)["controller"]
            due = flight.prepare(key, value, duration)
            with self._lock:
                flight.change(due, key, value, duration)
            flight.optimise()
