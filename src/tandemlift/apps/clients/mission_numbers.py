"""The numbers of a mission that clients may change in flight, as parameters of their protocols."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass

from tandemlift import InputError
from tandemlift.apps.clients.flight import RealTimeFlight
from tandemlift.apps.live.session.page_messages import SetMessage
from tandemlift.apps.live.session.server_messages import SceneParameter


@dataclass
class MissionNumber:
    """A number of a mission: its value, and what is called with a new one, which may refuse it."""

    value: float
    changed: Callable[[float], bool]

    def take(self, value: float) -> bool:
        """Change it; whether it may have the value."""
        if not math.isfinite(value) or not self.changed(value):
            return False
        self.value = value
        return True


def mission_numbers(flight: RealTimeFlight) -> Iterator[tuple[str, str, MissionNumber]]:
    """Table, name and number of each, lists by component: `wind`, `velocity_1`."""
    for shown in flight.session.scene["parameters"]:
        table, _, rest = shown["key"].partition(".")
        value = shown["value"]
        if isinstance(value, str):
            continue
        numbers = list(value) if isinstance(value, list | tuple) else [value]
        for n, number in enumerate(numbers):
            name = rest.replace(".", "_") + (f"_{n + 1}" if len(numbers) > 1 else "")
            yield table, name, MissionNumber(number, _changer(flight, shown, numbers, n))


PENDING = threading.BoundedSemaphore(8)  # changes at a time; a client that sends more is refused until some are made


def _changer(flight: RealTimeFlight, shown: SceneParameter, numbers: list[float], n: int) -> Callable[[float], bool]:
    """A function that changes the number `n` of a parameter in flight, in a thread, as that may compile.

    It returns False for a number that is out of bounds, or if too many changes wait.
    """

    def change(number: float) -> bool:
        if not shown.get("min", number) <= number <= shown.get("max", number):
            return False
        if not PENDING.acquire(blocking=False):
            return False
        numbers[n] = number
        value = tuple(numbers) if len(numbers) > 1 else number

        def apply() -> None:
            try:
                with suppress(InputError):  # it has no effect in this mission, or the flight is over
                    flight.session.apply(SetMessage(seq=0, key=shown["key"], value=value))
            finally:
                PENDING.release()

        threading.Thread(target=apply, daemon=True).start()
        return True

    return change
