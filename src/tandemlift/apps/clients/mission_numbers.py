"""The numbers of a mission that clients may change in flight, as parameters of their protocols."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from contextlib import suppress

from tandemlift import InputError
from tandemlift.apps.clients.flight import RealTimeFlight
from tandemlift.apps.live.session.page_messages import SetMessage
from tandemlift.apps.live.session.parameters import value_of
from tandemlift.apps.live.session.server_messages import SceneParameter

PENDING = threading.BoundedSemaphore(8)  # changes at a time; a client that sends more is refused until some are made


class MissionNumber:
    """Number `n` of a parameter, `shown` as pages have it, with its `first` numbers; others change it in flight."""

    def __init__(self, flight: RealTimeFlight, shown: SceneParameter, first: list[float], n: int) -> None:
        self._flight, self._shown, self._first, self._n = flight, shown, first, n
        self._asked: float | None = None  # which the flight is to have soon

    def read(self) -> float:
        """The number now, or the one that a client asked for while that change is made."""
        asked = self._asked
        return self._numbers()[self._n] if asked is None else asked

    def take(self, number: float) -> bool:
        """Change it in flight, in a thread, as that may compile; of several numbers, to the last one.

        It returns False for a number that is out of bounds, or if too many changes wait.
        """
        low, high = self._shown.get("min", number), self._shown.get("max", number)
        if not (math.isfinite(number) and low <= number <= high and PENDING.acquire(blocking=False)):
            return False
        self._asked = number
        threading.Thread(target=self._change, daemon=True).start()
        return True

    def _numbers(self) -> list[float]:
        """All numbers of the parameter as they are now; the first ones under another controller, which has none."""
        value = value_of(self._flight.session.flight.now.model_dump(mode="json"), self._shown["key"])
        if isinstance(value, int | float):
            return [value]
        return list(value if isinstance(value, list) else self._first)

    def _change(self) -> None:
        """Make the change that was asked for last, unless another thread has made it."""
        session = self._flight.session
        try:
            with session.turn, suppress(InputError):  # it has no effect in this mission, or the flight is over
                if (number := self._asked) is None:
                    return
                try:
                    numbers = self._numbers()
                    numbers[self._n] = number
                    value = tuple(numbers) if len(numbers) > 1 else number
                    session.apply(SetMessage(seq=0, key=self._shown["key"], value=value))
                finally:
                    if self._asked == number:
                        self._asked = None
        finally:
            PENDING.release()


def mission_numbers(flight: RealTimeFlight) -> Iterator[tuple[str, str, MissionNumber]]:
    """Table, name and number of each, lists by component: `wind`, `velocity_1`."""
    for shown in flight.session.scene["parameters"]:
        table, _, rest = shown["key"].partition(".")
        value = shown["value"]
        if isinstance(value, str):
            continue
        numbers = list(value) if isinstance(value, list | tuple) else [value]
        for n in range(len(numbers)):
            name = rest.replace(".", "_") + (f"_{n + 1}" if len(numbers) > 1 else "")
            yield table, name, MissionNumber(flight, shown, numbers, n)
