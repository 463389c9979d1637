"""The function `advance_flight`: one step of a flight, from its traced graph."""

from __future__ import annotations

from typing import Any

from tandemlift.codegen.c_expressions import UNARY
from tandemlift.codegen.c_limits import Solver, write_limits
from tandemlift.codegen.c_source import SourceFile
from tandemlift.codegen.c_statements import Statements, law_function
from tandemlift.codegen.c_text import FunctionHead, function
from tandemlift.core.types import leaves, rebuilt
from tandemlift.core.vector import ZERO
from tandemlift.parts.rotors.allocation import ConstrainedAllocation
from tandemlift.simulation.loop_code.traced_step import Symbols, TracedStep

COMMENT = """/* One step of a flight from time t [s] by dt [s]: its state after it, and the sample at its start
 * (tandemlift.simulation.loop_code.traced_step). */
"""


class FlightStep:
    """The functions of a step.

    Args:
        file: the names of the mission, and its precision.
        traced: the step.
    """

    def __init__(self, file: SourceFile, traced: TracedStep) -> None:
        self.file, self.traced = file, traced
        g, x = traced.graph, traced
        symbols = [*x.next_state, *x.sample, *x.body_in_contact, *x.body_on_feet, *x.body_in_free_air]
        symbols += [*x.may_touch_walls, *x.may_touch_hull]
        if x.limits:
            symbols += [x.limits.beyond, *x.limits.problem, *x.limits.plain, *x.limits.search]
        self.roots = [s.node for s in symbols]
        kinds = {g.args[n][0] for n in g.needed(self.roots) if g.ops[n] == "in"}
        self.has_gusts, self.has_noise = "gust" in kinds, "noise" in kinds
        self.branches = bool(x.body_in_free_air)

    @property
    def arguments(self) -> list[str]:
        """The arguments of the caller between the push and the time."""
        noise = ["&noise"] * (leaves(self.traced.templates.given.noise) > 0)
        return ["gust"] * self.has_gusts + noise + ["flight->low"] * self.branches

    def functions(self, done: list[int]) -> list[str]:
        """The functions of the laws that a step calls, and of the step."""
        unit, texts = self.file.unit, list[str]()
        for number in unit.reached(self.traced.graph, self.roots):
            done.append(number)
            texts.append(law_function(unit, number))
        if isinstance(allocation := self.traced.templates.model.pilot.allocation, ConstrainedAllocation):
            texts += Solver(unit, allocation).functions(done)
        return [*texts, self._advance()]

    def _advance(self) -> str:
        x, unit, templates = self.traced, self.file.unit, self.traced.templates
        graph, body = x.graph, Statements(unit, x.graph, self.roots)
        for name in ("model", "hand", "gust", "noise", "low", "t", "dt", "sample"):
            body.taken.new(name)
        kind = lambda value: unit.structs.of(value).name  # noqa: E731
        given = [f"const {kind(templates.model)} *model", f"const {kind(templates.given.hand)} *hand"]
        body.know(graph.inputs("fly", templates.model), "model", pointer=True)
        body.know(graph.inputs("hand", templates.given.hand), "hand", pointer=True)
        if self.has_gusts:
            given.append(f"{kind(ZERO)} gust")
            body.know(graph.inputs("gust", ZERO), "gust")
        if leaves(templates.given.noise):
            given.append(f"const {kind(templates.given.noise)} *noise")
            body.know(graph.inputs("noise", templates.given.noise), "noise", pointer=True)
        given += ["bool low"] * self.branches
        given += [f"{unit.real} t", f"{unit.real} dt", f"{kind(templates.sample)} *sample"]
        body.know(graph.input("t"), "t")
        body.know(graph.input("dt"), "dt")
        if x.limits and isinstance(allocation := templates.model.pilot.allocation, ConstrainedAllocation):
            write_limits(body, x.limits, allocation)
        self._move_body(body)
        body.compute([s.node for s in [*x.sample, *x.next_state]])
        sample = rebuilt(iter(x.sample), templates.sample)
        after = rebuilt(iter(x.next_state), templates.model.flight_state)
        last = [f"*sample = {body.value(sample)};", f"return {body.value(after)};"]
        head = FunctionHead(COMMENT, kind(templates.model.flight_state), "advance_flight", given)
        return function(head, body.made, "\n".join(last))

    def _move_body(self, body: Statements) -> None:
        """The body's part of the step: near walls or with all parts near the floor, on its feet, or in free air."""
        x = self.traced
        like = x.templates.moved
        moved = body.variable(body.graph.inputs("moved", like), "moved")

        def move(numbers: Symbols) -> None:
            value: Any = rebuilt(iter(numbers), like)
            body.compute([s.node for s in numbers])
            body.line(f"{moved} = {body.value(value)};")

        if not self.branches:
            move(x.body_in_contact)
            return
        body.compute([s.node for s in [*x.may_touch_walls, *x.may_touch_hull]])
        walls, hull = ([body.number(s.node).within(UNARY) for s in t] for t in (x.may_touch_walls, x.may_touch_hull))
        with body.branch(f"if ({' || '.join([*walls, *[f'(low && {test})' for test in hull]])}) {{", last=False):
            move(x.body_in_contact)
        with body.branch("} else if (low) {", last=False):
            move(x.body_on_feet)
        with body.branch("} else {", last=True):
            move(x.body_in_free_air)
