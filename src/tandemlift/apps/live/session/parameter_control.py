"""Changes in flight: parameters set and restored, rotors stopped, sensors tared.

Each change is prepared beside the flight, one after the other; the flight does not wait for it.
"""

from __future__ import annotations

import threading
from typing import Any

from tandemlift.apps.live.session import refusal_texts as texts
from tandemlift.apps.live.session.checks import TARE, check_in_time, tare_start_for
from tandemlift.apps.live.session.interactive_mission import NEVER
from tandemlift.apps.live.session.tunable_parameters import BY_KEY, CHOICES, CONTROLLER, bounds_of, keys_of, value_of
from tandemlift.apps.live.wire.server_messages import Answer, ChangedMessage, RefusedMessage
from tandemlift.core.errors import InputError, shown
from tandemlift.missions import Mission, tables_of
from tandemlift.missions.changes import MISSING
from tandemlift.simulation.recorded_flight import RecordedFlight

RAMP = 0.5  # s, within which a parameter changes to its new value


class ParameterControl:
    """Changes flights that began as one mission.

    Args:
        first: the mission that parameters are restored to.
        lock: of the flight.

    Attributes:
        turn: lock of who changes a flight; to be taken before that of the flight.
    """

    def __init__(self, first: Mission, lock: threading.RLock) -> None:
        self._first, self._lock = first, lock
        self.turn = threading.RLock()

    def set(self, flight: RecordedFlight, key: str, value: object) -> list[Answer]:
        """Set a parameter; return a message about it.

        Raises:
            InputError: there is no such parameter, or the value is out of bounds or cannot be taken in flight.
        """
        self._check(key, value)
        return self._set_to(flight, key, [value] * len(keys_of(self._first, key)))

    def restore(self, flight: RecordedFlight, key: str | None) -> list[Answer]:
        """Set a parameter, or all, back to the first mission; return messages, refusals among them."""
        answers: list[Answer] = []
        for one in [*CHOICES, *BY_KEY] if key is None else [key]:
            try:
                answers += self._restore(flight, one)
            except InputError as error:
                answers.append(RefusedMessage(type="refused", what=f"restore {one}", reason=str(error)))
        return answers

    def stop_rotor(self, flight: RecordedFlight, rotor: int) -> None:
        """Stop a rotor for good; counted over the whole vehicle, from 0.

        Raises:
            InputError: it cannot fail, or has failed already.
        """
        faults = flight.now.faults
        at = [i for i, f in enumerate(faults) if 4 * (f.quadrotor - 1) + f.rotor - 1 == rotor]
        if not at:
            raise InputError(texts.WHOLE_ROTORS.format(rotor=rotor))
        if faults[at[0]].time < NEVER:
            raise InputError(texts.FAILED_ALREADY.format(rotor=rotor, time=faults[at[0]].time))
        self._change(flight, f"faults.{at[0]}.time", flight.step * flight.dt, 0.0)

    def tare(self, flight: RecordedFlight) -> str:
        """Schedule a tare of the force sensors; from when to when.

        Raises:
            InputError: the mission has no tare that can be scheduled, or preparing it took too long.
        """
        with self.turn:
            start = tare_start_for(flight)
            due = flight.prepare(TARE, start)
            with self._lock:
                check_in_time(flight, start)
                flight.change(due, TARE, start)
        return f"from {start:g} s to {start + flight.now.estimator.tare_duration:g} s"

    def _check(self, key: str, value: object) -> None:
        """Refuse an unknown key, or a value out of bounds."""
        if key in CHOICES:
            return
        if key not in BY_KEY:
            raise InputError(texts.UNKNOWN.format(key=key, known=", ".join([*CHOICES, *BY_KEY])))
        low, high = bounds_of(BY_KEY[key], self._first)
        for number in value if isinstance(value, list) else [value]:
            if isinstance(number, bool) or not isinstance(number, (int, float)):
                raise InputError(texts.NO_NUMBER.format(key=key, value=shown(value)))
            if not low <= number <= high:
                raise InputError(texts.OUT_OF_BOUNDS.format(key=key, value=shown(value), low=low, high=high))

    def _restore(self, flight: RecordedFlight, key: str) -> list[Answer]:
        first, now = tables_of(self._first), tables_of(flight.now)
        keys = keys_of(self._first, key)
        values = [value_of(first, one) for one in keys]
        if MISSING in values or values == [value_of(now, one) for one in keys]:
            return []
        return self._set_to(flight, key, values)

    def _set_to(self, flight: RecordedFlight, key: str, values: list[Any]) -> list[Answer]:
        """Set the keys that a parameter stands for, one value each."""
        duration = 0.0 if key in CHOICES else RAMP
        for one, value in zip(keys_of(self._first, key), values, strict=True):
            self._change(flight, one, value, duration)
        now = value_of(tables_of(flight.now), key)
        return [ChangedMessage(type="changed", key=key, value=now, duration=duration)]

    def _change(self, flight: RecordedFlight, key: str, value: object, duration: float) -> None:
        """Prepare a change beside the flight, and let it begin."""
        with self.turn:
            if flight.over:
                raise InputError(texts.OVER.format(key=key))
            if key == CONTROLLER and value == self._first.controller.name:  # with the mission's own settings
                key, value = "controller", tables_of(self._first)["controller"]
            due = flight.prepare(key, value, duration)
            with self._lock:
                flight.change(due, key, value, duration)
            flight.optimise()
