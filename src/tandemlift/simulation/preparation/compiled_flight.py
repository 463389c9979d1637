"""The machine code of flights of one layout: the loop over steps, and the parts of a step."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence
from functools import cached_property

import numpy as np

from tandemlift.compiler.machine_code import machine
from tandemlift.compiler.machine_code.code import Code, Written
from tandemlift.compiler.machine_code.store import key_of
from tandemlift.core.progress import always
from tandemlift.simulation.loop.external_inputs import LANES
from tandemlift.simulation.loop.sources import LeafSpan, delayed_spans, leaf_offset
from tandemlift.simulation.loop.step import FlightModel, StepInputs
from tandemlift.simulation.preparation.loops import LoopWriter
from tandemlift.simulation.preparation.many_blocks import write_many_blocks
from tandemlift.simulation.preparation.memory import AT, FlightStart
from tandemlift.simulation.preparation.templates import templates_from
from tandemlift.simulation.preparation.traced_step import TracedStep

PARTS = FlightModel._fields[1:]  # those with parameters
DRAWN = "sensors"  # the one with numbers that are drawn by the seed


class LoopCode:
    """The compiled loops for flights laid out like `model`, with inputs laid out like `given`.

    Each loop is compiled on first use. `fuses`: whether a·b + c is rounded once. `single`: whether its numbers are
    floats; then there are only loops for blocks.

    Attributes:
        lanes: flights of a block.
    """

    def __init__(self, model: FlightModel, given: StepInputs, *, fuses: bool = True, single: bool = False) -> None:
        self.templates, self.fuses, self.single = templates_from(model, given), fuses, single
        self.lanes = 2 * LANES if single else LANES
        self.delayed = delayed_spans(self.templates.model)
        self._lock, self._codes = threading.RLock(), dict[tuple[str, int], Code]()
        self._own = set[str]()

    @cached_property
    def traced(self) -> TracedStep:
        """The graph of a step."""
        return TracedStep(self.templates, fuses=self.fuses, single=self.single)

    def loop(
        self, lanes: int, going: Callable[[], bool] = always, *, differ: Collection[str] = (), around: object = None
    ) -> Code:
        """`fly`, the loop over steps, for one flight or for a block of `lanes`; compiled only while `going()` is true.

        `around`: a body in another engine, if there is one.

        The code of a block reads as scalars the parameters of parts in which its lanes do not `differ`. The first block
        decides which these are; for blocks that this does not fit, there is code without such scalars.

        Raises:
            Stopped: `going()` was false before the compilation began.
        """
        if lanes == 1:
            return self._code("around" if around else "loop", lanes, ["fly"], going)
        with self._lock:
            self._own = self._own or {DRAWN, *differ}
            own = self._own if self._own.issuperset(differ) else PARTS
        return self._code(" ".join(["loop", *sorted(own)]), lanes, ["fly", "fly_blocks"], going)

    def parts_that_differ(self, starts: Sequence[FlightStart]) -> set[str]:
        """The parts of a `FlightModel` in whose parameters flights differ by a bit; all if these have most of them."""
        numbers = np.array([start.numbers for start in starts]).view(np.int32 if self.single else np.int64)
        differ = (numbers != numbers[0]).any(axis=0)
        found = {name: size for name, (at, size) in self._spans.items() if differ[at : at + size].any()}
        return set(found if 2 * sum(found.values()) < sum(span.size for span in self._spans.values()) else PARTS)

    @cached_property
    def _spans(self) -> dict[str, LeafSpan]:
        return {name: leaf_offset(self.templates.model, name) for name in PARTS}

    def parts(self, *, leaves_body: bool) -> Code:
        """A step in parts: `ask` up to a controller in Python, `decide` up to another body, `complete` to its end."""
        names = ["ask"] * self.templates.calls_python + ["decide"] * leaves_body + ["complete"]
        return self._code("parts", int(leaves_body), names)

    def _code(self, kind: str, number: int, names: list[str], going: Callable[[], bool] = always) -> Code:
        with self._lock:
            if (kind, number) not in self._codes:
                key = self.key(kind, number)
                best = machine.BEST_OF_VECTORS if kind != "parts" and number > 1 else machine.BEST
                self._codes[kind, number] = Code(key, names, lambda: self.written(kind, number), best, going)
            return self._codes[kind, number]

    def key(self, kind: str, number: int) -> str:
        """The key of the code of a loop or of parts by its sources (`key_of`)."""
        x = self.templates
        return key_of((x.model, x.given), kind, number, x.nowhere, self.fuses, self.single)

    def written(self, kind: str, number: int) -> Written:
        """The module of a loop or of parts as text."""
        with self._lock:
            (what, *own), lanes = kind.split(), 1 if kind == "parts" else number
            alike = [span for name, span in self._spans.items() if lanes > 1 and name not in own]
            step = LoopWriter(self.traced, lanes, alike=[i for at, size in alike for i in range(at, at + size)])
            text = step.write_parts(bool(number)) if what == "parts" else step.write_loop(around=what == "around")
            if lanes > 1:
                write_many_blocks(step, AT)
                text = step.module.text
            spans = {name: span for name, span in step.scratch.spans.items() if "_" not in name}
            about = {"size": step.scratch.size, "rooms": spans, "own": own, "rests": len(self.traced.rests)}
            return Written(text, about)
