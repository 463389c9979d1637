"""The machine code of flights of one layout: the loop over steps, and the parts of a step."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cached_property

from tandemlift.compiler.machine_code import machine
from tandemlift.compiler.machine_code.code import Code, Written
from tandemlift.compiler.machine_code.store import key_of
from tandemlift.core.progress import always
from tandemlift.simulation.loop.step import FlightModel, StepInputs
from tandemlift.simulation.preparation.loops import LoopWriter
from tandemlift.simulation.preparation.templates import PythonController, delayed_spans, templates_from
from tandemlift.simulation.preparation.traced_step import TracedStep


class LoopCode:
    """The compiled loops for flights laid out like `model`, with inputs laid out like `given`.

    Each loop is compiled on first use. `fuses`: whether a·b + c is rounded once.
    """

    def __init__(self, model: FlightModel, given: StepInputs, *, fuses: bool = True) -> None:
        self.templates, self.fuses = templates_from(model, given), fuses
        self.delayed = delayed_spans(self.templates.model)
        self._lock, self._codes = threading.RLock(), dict[tuple[str, int], Code]()

    @cached_property
    def calls_python(self) -> bool:
        """Whether a controller in plain Python is called in the middle of a step."""
        return isinstance(self.templates.model.pilot.controller, PythonController)

    @cached_property
    def traced(self) -> TracedStep:
        """The graph of a step."""
        return TracedStep(self.templates, self.calls_python, fuses=self.fuses)

    def loop(self, lanes: int, going: Callable[[], bool] = always) -> Code:
        """`fly`, the loop over steps, for one flight or for a block of LANES; compiled only while `going()` is true.

        Raises:
            Stopped: `going()` was false before the compilation began.
        """
        return self._code("loop", lanes, ["fly"], going)

    def parts(self, *, leaves_body: bool) -> Code:
        """A step in parts: `ask` up to a controller in Python, `decide` up to another body, `complete` to its end."""
        names = ["ask"] * self.calls_python + ["decide"] * leaves_body + ["complete"]
        return self._code("parts", int(leaves_body), names)

    def _code(self, kind: str, number: int, names: list[str], going: Callable[[], bool] = always) -> Code:
        with self._lock:
            if (kind, number) not in self._codes:
                x = self.templates
                key = key_of((x.model, x.given), kind, number, x.nowhere, self.fuses)
                best = machine.BEST_OF_VECTORS if kind == "loop" and number > 1 else machine.BEST
                self._codes[kind, number] = Code(key, names, lambda: self._written(kind, number), best, going)
            return self._codes[kind, number]

    def _written(self, kind: str, number: int) -> Written:
        with self._lock:
            step = LoopWriter(self.traced, number if kind == "loop" else 1)
            text = step.write_loop() if kind == "loop" else step.write_parts(bool(number))
            spans = {name: span for name, span in step.scratch.spans.items() if "_" not in name}
            return Written(text, {"size": step.scratch.size, "rooms": spans})
