"""The compiled loops over steps: one flight, a block of flights, and the parts of a step around Python.

A flight is a flat array of the numbers of a `FlightModel`; a block holds LANES of them interleaved, so that the same
instruction serves all of them. The laws are the same, and so is every bit of the result.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cached_property

from tandemlift.kernels.external_inputs import GAUSSIAN, GUST, HALVES, LANES, SPAN, InputTables
from tandemlift.kernels.loops import LoopWriter
from tandemlift.kernels.memory import FlightMemory, FlightStart, TimeGrid
from tandemlift.kernels.offsets import delayed_spans, leaf_offset
from tandemlift.kernels.templates import COMMAND, GIVEN, PythonController, Templates, templates_from
from tandemlift.kernels.traced_step import TracedStep
from tandemlift.loop.step import FlightModel, StepInputs
from tandemlift.trace import machine
from tandemlift.trace.code import Code, Written
from tandemlift.trace.compile_events import always
from tandemlift.trace.key import key_of

__all__ = [
    "COMMAND",
    "GAUSSIAN",
    "GIVEN",
    "GUST",
    "HALVES",
    "LANES",
    "SPAN",
    "FlightMemory",
    "FlightStart",
    "InputTables",
    "Kernels",
    "PythonController",
    "Templates",
    "TimeGrid",
    "leaf_offset",
]


class Kernels:
    """The compiled loops for flights like `flying` with inputs like `given`; each compiles when first asked for."""

    def __init__(self, flying: FlightModel, given: StepInputs) -> None:
        self.likes = templates_from(flying, given)
        self.lines = delayed_spans(self.likes.flying)
        self._lock, self._codes = threading.RLock(), dict[tuple[str, int], Code]()

    @cached_property
    def asks(self) -> bool:
        """Whether a controller in Python is asked in the middle of a step."""
        return isinstance(self.likes.flying.pilot.controller, PythonController)

    @cached_property
    def _traced(self) -> TracedStep:
        return TracedStep(self.likes, self.asks)

    def loop(self, lanes: int, going: Callable[[], bool] = always) -> Code:
        """`fly`, the loop over steps, for one flight or for a block of LANES; it is compiled while `going`.

        Raises:
            Stopped: it was not compiled.
        """
        return self._code("loop", lanes, ["fly"], going)

    def parts(self, *, leaves_body: bool) -> Code:
        """A step in parts: `ask` up to a controller in Python, `decide` up to another body, `complete` to its end."""
        names = ["ask"] * self.asks + ["decide"] * leaves_body + ["complete"]
        return self._code("parts", int(leaves_body), names)

    def _code(self, kind: str, number: int, names: list[str], going: Callable[[], bool] = always) -> Code:
        with self._lock:
            if (kind, number) not in self._codes:
                x = self.likes
                key = key_of((x.flying, x.given), kind, number, x.nowhere)
                best = machine.BEST_OF_VECTORS if kind == "loop" and number > 1 else machine.BEST
                self._codes[kind, number] = Code(key, names, lambda: self._written(kind, number), best, going)
            return self._codes[kind, number]

    def _written(self, kind: str, number: int) -> Written:
        with self._lock:
            step = LoopWriter(self._traced, number if kind == "loop" else 1)
            text = step.write_loop() if kind == "loop" else step.write_parts(bool(number))
            rooms = {name: room for name, room in step.rooms.at.items() if "_" not in name}
            return Written(text, {"size": step.rooms.size, "rooms": rooms})
