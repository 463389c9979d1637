"""The unrolled graph of a step for derivatives, with pushes at points, and the selection of states.

A number of the flight is a state of the linear model if its derivative can reach the body's state or an output, over
any number of steps. Numbers that act only by comparisons have no derivative, and flags and counters are discrete.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

from tandemlift.compiler.machine_code.derivatives import smooth_arguments
from tandemlift.core.types import is_value, leaves
from tandemlift.core.vector import ZERO, Mat3
from tandemlift.simulation.graphs import LastUsed, PointPush, PushSamples, TracedStep, templates_from
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import leaf_offset

NO_PUSH = PointPush(ZERO, Mat3(ZERO, ZERO, ZERO))
CONSTANT, DISCRETE = "never changes", "a flag, a counter or a mode"
TABLE, UNSEEN = "read from a table", "acts only by comparisons, on metrics, or on nothing"
FROM_TABLES = (("near",), ("person", "leg"))  # the nearest walls and the leg of the path, found between steps


class StateChoice(NamedTuple):
    """The selection of a flight's numbers as states.

    Attributes:
        kept: their indices in the flight, in order.
        carried: the numbers whose values the following steps need, states among them.
        left_out: the reason for each other number.
        smooth: nodes by which derivatives pass.
    """

    kept: tuple[int, ...]
    carried: tuple[int, ...]
    left_out: dict[int, str]
    smooth: frozenset[int]


def no_push(p: FlightPlan) -> Any:
    """No push, as a value of the kind that a linear model of a flight has: at points, or on a beam that bends."""
    own = p.given.hand.start
    return own if leaves(own) > leaves(NO_PUSH) else NO_PUSH


def leaf_names(value: Any, path: str = "") -> list[str]:
    """The dotted names of the numbers of a nested value."""
    if not is_value(value):
        return [path]
    parts = zip(value._fields, value, strict=True)
    return [name for field, part in parts for name in leaf_names(part, f"{path}.{field}" if path else field)]


class StepGraph:
    """A traced step of flights of one layout.

    Args:
        p: the plan of such a flight.
        given: the layout of the inputs from outside; by default those of the plan, with pushes at points.

    Attributes:
        traced: the step.
        sample: the layout of its sample.
        size: numbers of a flight's state.
        names: of these numbers, dotted.
    """

    def __init__(self, p: FlightPlan, given: Any = None) -> None:
        templates = templates_from(p.model, given or p.given._replace(hand=PushSamples(*[no_push(p)] * 3)))
        self.traced = TracedStep(templates, fuses=p.mission.mission.fma, rolls=False)
        self.graph, self.sample = self.traced.graph, templates.sample
        self.next = [s.node for s in self.traced.next_state]
        self.outputs = [s.node for s in self.traced.sample]
        thrusts = leaf_offset(templates.acting, "thrusts")
        acting = self.traced.body.acting
        self.thrusts = [s.node for s in acting[thrusts.at : thrusts.at + thrusts.size]]
        like = p.model.flight_state
        self.size, self.names = leaves(like), leaf_names(like)
        self.body_state = range(leaves(like.state))
        self.tables = {
            at + i
            for path in FROM_TABLES
            for at, size in [leaf_offset(p.model, "flight_state", *path)]
            for i in range(size)
        }

    def sources(self, kind: str, index: int, *, every: bool) -> list[int]:
        """The nodes that form an input within the step; `every`: also the conditions that select them."""
        x = self.traced
        if kind == "moved":
            made = [part[index].node for part in (x.body_in_contact, x.body_in_free_air) if part]
            return made + (self.contact_tests if every else [])
        if kind == "solved" and x.limits:
            made = [s.node for s in [*x.limits.problem, x.limits.plain[index]]]
            return made + ([s.node for s in [x.limits.beyond, *x.limits.search]] if every else [])
        return []

    @cached_property
    def contact_tests(self) -> list[int]:
        """The nodes that say whether the body may touch floor or walls; none where it is computed in one way."""
        if not self.traced.body_in_free_air:
            return []
        floor = [self.traced.may_touch_floor] if self.traced.templates.has_floor else []
        return [s.node for s in [*floor, *self.traced.may_touch_walls, *self.traced.may_touch_hull]]

    def reached(
        self, roots: Iterable[int], cut: Iterable[int] = (), *, every: bool = False
    ) -> tuple[set[int], set[tuple[str, int]]]:
        """(Nodes, inputs) that roots depend on, by derivatives, or by anything if `every`; not beyond `cut`."""
        g, seen, inputs = self.graph, set(cut), set[tuple[str, int]]()
        stack = [root for root in roots if root not in seen]
        while stack:
            node = stack.pop()
            if node in seen:
                continue
            seen.add(node)
            if g.ops[node] == "in":
                inputs.add(g.args[node])
                stack += self.sources(g.args[node][0], g.args[node][1], every=every)
            elif g.ops[node] != "const":
                stack += g.args[node] if every else smooth_arguments(g, node)
        return seen, inputs

    @cached_property
    def constant(self) -> set[int]:
        """The numbers that no step changes."""
        own = [("fly", i) for i in range(self.size)]
        return {i for i, n in enumerate(self.next) if self.graph.ops[n] == "in" and self.graph.args[n] == own[i]}

    @cached_property
    def discrete(self) -> set[int]:
        """The numbers that are made of whole constants and of each other only."""
        found = set(range(self.size))
        while True:
            still = self._discrete_nodes(found)
            kept = {i for i in found if still(self.next[i])}
            if kept == found:
                return found
            found = kept

    def _discrete_nodes(self, numbers: set[int]) -> Callable[[int], bool]:
        g, known = self.graph, dict[int, bool]()

        def is_discrete(root: int) -> bool:
            for node in g.needed([root], known):
                op, args = g.ops[node], g.args[node]
                if op == "const":
                    value = args[0]
                    known[node] = not isinstance(value, bytes) or struct.unpack("<d", value)[0].is_integer()
                elif op == "in":
                    known[node] = args[0] == "fly" and args[1] in numbers
                elif op == "select":
                    known[node] = known[args[1]] and known[args[2]]
                elif op in ("fadd", "fsub", "fmul", "fneg", "fabs"):
                    known[node] = all(known[a] for a in args)
                else:
                    known[node] = op in ("sitofp", "uitofp", "floor") or g.types[node] != "f"
            return known[root]

        return is_discrete

    def choose(self, outputs: Sequence[int], cut: Sequence[int], delayed: set[int]) -> StateChoice:
        """The states of a model with these outputs.

        Args:
            outputs: nodes.
            cut: nodes that are inputs of the model: nothing before them is a state.
            delayed: numbers that pass through a delay line.
        """
        fixed = dict.fromkeys(self.constant - delayed, CONSTANT)
        fixed |= dict.fromkeys(self.discrete - self.constant, DISCRETE)
        fixed |= dict.fromkeys(self.tables, TABLE)
        body = [self.next[i] for i in self.body_state]
        smooth, kept = self._closed([*body, *outputs], cut, every=False, without=set(fixed))
        _, carried = self._closed([*body, *outputs], (), every=True, without=set())
        left_out = {i: fixed.get(i, UNSEEN) for i in range(self.size) if i not in kept}
        return StateChoice(tuple(sorted(kept)), tuple(sorted(carried | kept)), left_out, frozenset(smooth))

    def _closed(
        self, roots: list[int], cut: Sequence[int], *, every: bool, without: set[int]
    ) -> tuple[set[int], set[int]]:
        """(Nodes, numbers of the flight) on which roots depend over any number of steps."""
        numbers = set(self.body_state) - without
        while True:
            nodes, inputs = self.reached([*roots, *[self.next[i] for i in numbers]], cut, every=every)
            more = {i for kind, i in inputs if kind == "fly" and i < self.size} - without - numbers
            if not more:
                return nodes, numbers
            numbers |= more


GRAPHS = LastUsed[StepGraph](4)  # of tens of megabytes each


def step_graph(p: FlightPlan) -> StepGraph:
    """The graph of a step of such flights, traced once.

    Raises:
        TraceError: a law cannot be traced.
    """
    return GRAPHS.of(p.variant, lambda: StepGraph(p))
