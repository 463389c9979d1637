"""The machine code of flights of one layout: the loop over steps, and the parts of a step."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from tandemlift.compiler.machine_code import machine
from tandemlift.compiler.machine_code.code import Code, Written
from tandemlift.compiler.machine_code.store import key_of
from tandemlift.core.progress import always
from tandemlift.core.types import is_value, leaves
from tandemlift.simulation.loop.external_inputs import LANES
from tandemlift.simulation.loop.sources import delayed_spans
from tandemlift.simulation.loop.step import FlightModel, StepInputs
from tandemlift.simulation.preparation.loops import LoopWriter
from tandemlift.simulation.preparation.many_blocks import write_many_blocks
from tandemlift.simulation.preparation.memory import AT, FlightStart
from tandemlift.simulation.preparation.templates import templates_from
from tandemlift.simulation.preparation.traced_step import TracedStep

DRAWN = "sensors"  # the part of a flight with numbers that are drawn by the seed
DEPTH = 3  # of names: values further inside are one with theirs


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
        self._own = list[set[str]]()

    @cached_property
    def traced(self) -> TracedStep:
        """The graph of a step."""
        return TracedStep(self.templates, fuses=self.fuses, single=self.single)

    def loop(
        self, lanes: int, going: Callable[[], bool] = always, *, differ: Collection[str] = (), around: object = None
    ) -> Code:
        """`fly`, the loop over steps, for one flight or for a block of `lanes`; compiled only while `going()` is true.

        `around`: a body in another engine, if there is one.

        The code of a block reads as scalars the parameters of values in which its lanes do not `differ`. The first
        block decides which these are. For blocks that this does not fit there is one code more, in which whole parts of
        the flights may differ, and one without such scalars.

        Raises:
            Stopped: `going()` was false before the compilation began.
        """
        if lanes == 1:
            return self._code("around" if around else "loop", lanes, ["fly"], going)
        with self._lock:
            own = next((own for own in self._own if own.issuperset(differ)), None)
            if own is None:
                own = self._next_own({*differ})
                self._own.append(own)
        return self._code(" ".join(["loop", *sorted(own)]), lanes, ["fly", "fly_blocks"], going)

    def _next_own(self, differ: set[str]) -> set[str]:
        """The values with parameters that are no scalars in the next code of a block."""
        drawn = {name for name in self.values if name.startswith(DRAWN)}
        parts = {name.partition(".")[0] for name in differ.union(drawn, *self._own)}
        wider = drawn | differ, {name for name in self.values if name.partition(".")[0] in parts}
        return next((own for own in wider[len(self._own) :] if own.issuperset(differ)), set(self.values))

    def parts_that_differ(self, starts: Sequence[FlightStart]) -> set[str]:
        """The `values` in whose parameters flights differ by a bit; all if these have most of the parameters."""
        numbers = np.array([start.numbers for start in starts]).view(np.int32 if self.single else np.int64)
        differ = (numbers != numbers[0]).any(axis=0)
        found = {name: len(at) for name, at in self.values.items() if differ[at].any()}
        return set(found if 2 * sum(found.values()) < sum(map(len, self.values.values())) else self.values)

    @cached_property
    def values(self) -> dict[str, list[int]]:
        """The values of a flight that have parameters, such as `plant.floor.hull`, with the places of these."""
        model, found = self.templates.model, dict[str, list[int]]()
        at = leaves(model.flight_state)
        for part in FlightModel._fields[1:]:
            at = _find_values(getattr(model, part), (part,), at, found)
        return found

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
            alike = [i for name, at in self.values.items() if lanes > 1 and name not in own for i in at]
            step = LoopWriter(self.traced, lanes, alike=alike)
            text = step.write_parts(bool(number)) if what == "parts" else step.write_loop(around=what == "around")
            if lanes > 1:
                write_many_blocks(step, AT)
                text = step.module.text
            spans = {name: span for name, span in step.scratch.spans.items() if "_" not in name}
            about = {"size": step.scratch.size, "rooms": spans, "own": own, "rests": len(self.traced.rests)}
            return Written(text, about)


def _find_values(value: Any, path: tuple[str, ...], at: int, found: dict[str, list[int]]) -> int:
    """Add a value whose first number is at a place, and those inside, to the values found; where it ends."""
    for name, part in zip(value._fields, value, strict=True):
        if is_value(part):
            at = _find_values(part, (*path, name), at, found)
        else:
            found.setdefault(".".join(path[:DEPTH]), []).append(at)
            at += 1
    return at
