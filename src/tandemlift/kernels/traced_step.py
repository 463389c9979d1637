"""A step of a flight, traced: every number that it gives, as a symbol of what it is given.

Inputs by kind: `fly` (leaf of the flight), `hand`, `gust`, `noise`, `t`, `dt`; `answer` of a controller in Python;
`solved` by the allocation within limits; `external`, what the caller of a step adds; `moved`, the body after the step.
Of what is formed ahead: `push` and `gusts` (a row of a table), `wall`, `when`, `number`, `key`.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

from tandemlift.algebra.ops import where
from tandemlift.algebra.vector import ZERO, layout, total
from tandemlift.controllers import control
from tandemlift.engines.compiled import first_motion, untouched
from tandemlift.kernels.external_inputs import GAUSSIAN, GUST, SPAN, active, draws
from tandemlift.kernels.templates import COMMAND, Templates
from tandemlift.laws.estimation.rotor_loss_detection import left_of, with_trials
from tandemlift.laws.mechanics.clearance import clearance, may_press
from tandemlift.laws.mechanics.contact import may_touch
from tandemlift.laws.mechanics.push import moment_of, push_of
from tandemlift.laws.mechanics.rectangle import WALL
from tandemlift.laws.mechanics.walls import consider
from tandemlift.laws.mechanics.wind import gust_velocity
from tandemlift.laws.rotors.allocation import AllocationState, beyond, commanded, limits_at
from tandemlift.laws.rotors.thrust_limits import BoundedProblem, Search, begun, searched
from tandemlift.laws.signals.random_numbers import normals
from tandemlift.loop.step import (
    PilotOutput,
    StepInputs,
    actuate,
    finish_sample,
    perceive,
    run_pilot,
    step_body,
    with_caller_thrusts,
    with_person,
)
from tandemlift.pilot.pilot import control_input, with_allocation, with_command, with_thrusts
from tandemlift.trace import Graph, Symbol, TraceError, leaves, refused, symbols, traced, written_out

Symbols = list[Symbol]
MANY = 5  # quadrotors whose sets are arrays in memory, and served by loops


def graph_for(quadrotors: int) -> Graph:
    """An empty graph for the laws of so many quadrotors."""
    return Graph(MANY if quadrotors >= MANY else 0)


class TracedSolver:
    """A step of the solver of limits, traced: inputs `problem`, and `search` as it goes on."""

    def __init__(self, like: BoundedProblem, rolls_from: int = 0) -> None:
        self.graph, rotors = Graph(rolls_from), like.unlimited
        self.rotors, self.problem_size = len(rotors), leaves(like)
        problem = self.graph.inputs("problem", like)
        search = self.graph.inputs("search", Search(AllocationState(rotors, rotors), 0.0, 0.0, 0.0))
        self.begun = symbols(self.graph, self._unless_ended(search, begun(problem.limits, search.found)))
        self.after = symbols(self.graph, self._unless_ended(search, searched(problem, search)))

    def _unless_ended(self, s: Search, after: Search) -> Search:
        """A search that has ended stays as it is."""
        over = s.ended > 0.0
        found = AllocationState(*[where(over, a, b) for a, b in zip(s.found, after.found, strict=True)])
        return Search(found, *[where(over, a, b) for a, b in zip(s[1:], after[1:], strict=True)])


class LimitProblem(NamedTuple):
    """Thrusts within limits: whether thrusts leave them, what is solved for, the search without it and at its start."""

    beyond: Symbol
    problem: Symbols
    plain: Symbols
    search: Symbols
    solver: TracedSolver


class BodyInputs(NamedTuple):
    """What another engine's body is given: thrusts and the air's loads stand among the values of `acting`."""

    acting: Symbols
    push: Symbols


def changed_layout(before: Any, after: Any, path: str = "") -> str:
    """Which part of a flight is laid out otherwise after a step than before it."""
    if type(before) is type(after) and hasattr(before, "_fields"):
        for name, a, b in zip(before._fields, before, after, strict=True):
            if layout(a) != layout(b):
                return changed_layout(a, b, f"{path}.{name}" if path else name)
    kinds = [type(x).__name__ if hasattr(x, "_fields") else "a number" for x in (before, after)]
    return f"{path or 'a step'} is {kinds[0]} before a step and {kinds[1]} after it: a law returns what it was given"


def check_layout(gains: Any, before: Any, after: Any) -> None:
    """Refuse laws that lay out a flight otherwise after a step than before it; `gains`: of the controller.

    Raises:
        TraceError: with the law, if it is the controller's.
    """
    if layout(before) == layout(after):
        return
    what, law = changed_layout(before, after), control.table.get(type(gains))
    if law is not None and "memory.controller" in what:
        raise refused(f"returns another layout: {what}", law.__code__, law.__code__.co_firstlineno)
    raise TraceError(what)


class TracedStep:
    """The graph of a step of flights like `likes`.

    Args:
        likes: the layouts of what passes through a step.
        asks: whether a controller in Python is asked in the middle of the step.
    """

    def __init__(self, likes: Templates, asks: bool = False) -> None:
        self.likes, self.asks = likes, asks
        self.graph = graph_for(len(likes.flying.plant.frame.mass))
        self.flying = self.given_by("fly", likes.flying)
        self.t, self.dt = self.graph.input("t"), self.graph.input("dt")
        outer = StepInputs(
            self.given_by("hand", likes.given.hand),
            self.given_by("gust", ZERO),
            self.given_by("noise", likes.given.noise),
            self.flying.moving.person,
            self.given_by("external", likes.given.external),
        )
        self.given = traced(with_person)(self.flying, outer, self.t, self.dt)
        self.asked: Symbols = []
        thought = self._asking() if asks else traced(run_pilot)(self.flying, self.given.hand.start, self.t, self.dt)
        self.limits: LimitProblem | None = None
        if likes.constrained:
            thought = self._limited(thought)
        thought = traced(with_caller_thrusts)(thought, self.given.external)
        acting = traced(actuate)(self.flying, thought.decision.thrusts, self.given, self.t)
        self.body = BodyInputs(self.all(acting), self._mean_push())
        self.near, self.apart = self.all(self._swung(self.flying.plant, acting)), list[Symbol]()
        if likes.grounded or likes.walled:
            self.apart = self.all(self._swung(untouched(self.flying.plant), acting))
        self.pressing = [self._pressing(acting)] if likes.walled else []
        moved = self.given_by("moved", likes.moved)
        moving, sample = traced(finish_sample)(self.flying, thought, acting, moved, self.given)
        check_layout(self.flying.pilot.controller, likes.flying.moving, written_out(moving))
        self.moving, self.sample = self.all(moving), self.all(sample)

    def given_by(self, kind: str, like: Any) -> Any:
        """A nested value whose numbers are inputs of a kind."""
        return self.graph.inputs(kind, like)

    def all(self, value: Any) -> Symbols:
        """The numbers of a nested value."""
        return symbols(self.graph, value)

    def _asking(self) -> PilotOutput:
        f, push, t, dt = self.flying, self.given.hand.start, self.t, self.dt
        known, heard, estimator = traced(perceive)(f, push, t, dt)
        memory = f.moving.memory
        briefed = traced(control_input)(f.pilot, memory, heard, t, dt)
        self.asked = [*self.all(briefed.measured), *self.all(briefed.guidance.reference)]
        command = self.given_by("answer", COMMAND)
        decision, memory = traced(with_command)(f.pilot, memory, briefed, command, memory.controller)
        return PilotOutput(known, heard.state.attitude, decision, memory, estimator)

    def _limited(self, thought: PilotOutput) -> PilotOutput:
        self.limits, decision, memory = limited(self, self.flying.pilot, self.flying.moving.memory, thought, self.t)
        return thought._replace(decision=decision, memory=memory)

    def _swung(self, plant: Any, acting: Any) -> Any:
        return traced(step_body)(plant, self.flying.moving, acting, self.given.hand, self.dt)

    def _pressing(self, acting: Any) -> Symbol:
        """Whether anything may touch a wall in this step."""
        before, plant, dt = self.flying.moving, self.flying.plant, self.dt
        free, air = untouched(plant), acting.wind.loads
        args = before.state, before.grip, before.near, acting.thrusts, air, self.given.hand
        rate = traced(first_motion)(free, *args)
        room = traced(clearance)(plant.walls, before.near, plant.frame, before.state)
        return traced(may_press)(plant.walls, room, before.state, rate, dt)

    def _mean_push(self) -> Symbols:
        hand, attitude = self.given.hand, self.flying.moving.state.attitude
        mean = (hand.start + hand.middle * 4.0 + hand.end) * (1.0 / 6.0)
        return [*self.all(mean.force), *self.all(traced(moment_of)(mean, attitude))]

    # what is formed ahead of the step, or beside it

    @property
    def when(self) -> Symbol:
        """The time at which a push is evaluated."""
        return self.graph.input("when")

    @cached_property
    def push(self) -> Symbols:
        """A row of the table of pushes at the time `when`."""
        return self.all(traced(push_of)(self.likes.given.hand.start, self.given_by("push", GAUSSIAN), self.when))

    @cached_property
    def pressed(self) -> Symbol:
        """Whether that push is other than zero between the times `opens` and `closes`."""
        return active(self.given_by("push", GAUSSIAN), self.graph.input("opens"), self.graph.input("closes"))

    @cached_property
    def gust(self) -> Symbols:
        """The velocity of a row of the table of gusts."""
        return self.all(traced(gust_velocity)(self.given_by("gusts", GUST), self.t))

    @cached_property
    def normals(self) -> list[Symbols]:
        """The standard normals of step `number`, four for each draw."""
        number, keys = self.graph.input("number", type="i"), [self.graph.input("key", i) for i in (0, 1)]
        return [self.all(traced(normals)(number, i, *keys)) for i in range(draws(self.likes.given.noise))]

    @cached_property
    def nearest(self) -> Symbols:
        """The nearest walls once a row of the table of walls was looked at."""
        f, wall = self.flying, self.given_by("wall", WALL)
        return self.all(traced(consider)(f.plant.walls, wall, f.moving.near, f.plant.frame, f.moving.state))

    @cached_property
    def touch(self) -> Symbol:
        """Whether a foot may touch the floor within the steps of a span."""
        return traced(may_touch)(self.flying.plant.floor, self.flying.moving.state, self.dt * float(SPAN))


def limited(owner: Any, pilot: Any, held: Any, thought: Any, t: Any) -> Any:
    """(`LimitProblem`, a decision within them, the memory after it); `held`: the pilot's memory before.

    Args:
        owner: of the graph; gives symbols of a kind by `given_by`, and those of a value by `all`.
        pilot: its parameters.
        held: its memory before.
        thought: with its decision and its memory after it, without limits.
        t: time [s].
    """
    how, decision = pilot.allocation, thought.decision
    wished = decision.thrusts
    limits = traced(limits_at)(how, traced(left_of)(pilot.detection, held.detection), t)
    outside = total(traced(beyond)(wished, limits)) > 0.0
    problem, plain, before = (
        BoundedProblem(how.rows, how.weights, decision.command.wrench, wished, limits),
        AllocationState(wished * 0.0, wished),
        held.allocation,
    )
    start = AllocationState(where(outside, before.active, plain.active), where(outside, before.thrusts, plain.thrusts))
    search = Search(start, 1.0, 0.0, where(outside, 0.0, 1.0))
    solver = TracedSolver(written_out(problem), owner.graph.rolls_from)
    needs = LimitProblem(outside, owner.all(problem), owner.all(plain), owner.all(search), solver)
    solved = owner.given_by("solved", written_out(plain))
    commands = traced(with_trials)(pilot.detection, held.detection, traced(commanded)(how, solved.thrusts, t), t)
    return needs, traced(with_thrusts)(decision, commands), traced(with_allocation)(thought.memory, solved)
