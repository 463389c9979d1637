"""A traced step of a flight: each number that the step computes, as a symbol of the step's inputs.

Inputs by kind: `fly` (leaf of the flight), `hand`, `gust`, `noise`, `t`, `dt`; `answer` of a controller in Python;
`solved`, the limit solver's result; `external`, the input of a step's caller; `moved`, the body after the step, and
`outside`, the push on it from outside the loop; `rest`, what compensated sums left over.
Inputs of values computed before the step: `push`, `gusts`, `wall` (rows), `begins`, `due`, `when`, `number`, `key`.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

from tandemlift.compiler.single import compensated
from tandemlift.compiler.tracer import Graph, Symbol, TraceError, laid_out, refused, symbols, tracer, written_out
from tandemlift.core.algebra import chosen, where
from tandemlift.core.types import leaves
from tandemlift.core.vector import ZERO, layout
from tandemlift.engines.compiled import BodyStep, first_motion
from tandemlift.engines.compiled_contact import CompiledPlant, on_feet_only, without_contact
from tandemlift.parts.contact.clearance import clearance, may_touch_wall
from tandemlift.parts.contact.hull import hull_may_touch
from tandemlift.parts.contact.polyhedron import Polyhedron
from tandemlift.parts.controllers import control
from tandemlift.parts.mechanics.push import push_at, push_moment
from tandemlift.parts.mechanics.wind import gust_velocity
from tandemlift.parts.pilot.pilot import control_input, with_command
from tandemlift.simulation.loop import step
from tandemlift.simulation.loop.external_inputs import (
    ROWS,
    draw_count,
    draw_normals,
    floor_is_near,
    nearest_walls,
    push_is_active,
    walls_are_due,
)
from tandemlift.simulation.loop.sources import leaf_offset
from tandemlift.simulation.preparation.limit_solver import LimitProblem, limit_thrusts
from tandemlift.simulation.preparation.templates import COMMAND, Templates

Symbols = list[Symbol]
UNCOMPENSATED = ("state", "sensing", "estimator", "detectors")  # parts of a flight's state
MANY = 5  # quadrotors from which on sets are arrays in memory, and operations on them loops


def graph_for(quadrotors: int, *, rolls: bool = True, real: str = "double") -> Graph:
    """An empty graph for the laws of a number of quadrotors; `rolls`: whether large sets may be loops."""
    return Graph(MANY if rolls and quadrotors >= MANY else 0, real)


class BodyInputs(NamedTuple):
    """Inputs of a body in another engine: `acting` (with thrusts and loads of the air), and the mean `push`."""

    acting: Symbols
    push: Symbols


def changed_layout(before: Any, after: Any, path: str = "") -> str:
    """The first part of a flight whose layout differs after a step, in words."""
    if type(before) is type(after) and hasattr(before, "_fields"):
        for name, a, b in zip(before._fields, before, after, strict=True):
            if layout(a) != layout(b):
                return changed_layout(a, b, f"{path}.{name}" if path else name)
    kinds = [type(x).__name__ if hasattr(x, "_fields") else "a number" for x in (before, after)]
    return f"{path or 'a step'} is {kinds[0]} before a step and {kinds[1]} after it: a law must keep its layout"


def check_layout(gains: Any, before: Any, after: Any) -> None:
    """Refuse laws that change the layout of a flight; `gains`: of the controller.

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
    """The graph of a step of flights like `templates`.

    Args:
        templates: the layouts of the values of a step.
        fuses: whether a·b + c is rounded once.
        rolls: whether large sets may be loops.
        single: whether numbers are floats, and sums over steps compensated.

    Attributes:
        rests: what compensated sums leave over, inputs `rest` of the next step.
    """

    # laws of a flight; a vehicle alone has others
    pilot, end = staticmethod(step.run_pilot), staticmethod(step.finish_sample)

    def __init__(self, templates: Templates, *, fuses: bool = True, rolls: bool = True, single: bool = False) -> None:
        self.templates, self.trace = templates, tracer(fuses)
        plant = templates.model.plant
        quadrotors = len(plant.frame.mass)
        if isinstance(getattr(plant.walls, "beam", None), Polyhedron):  # which has large sets
            quadrotors = max(quadrotors, MANY)
        self.graph = graph_for(quadrotors, rolls=rolls, real="float" if single else "double")
        self.model = self.input_of("fly", templates.model)
        self.t, self.dt = self.graph.input("t"), self.graph.input("dt")
        outer = step.StepInputs(
            self.input_of("hand", templates.given.hand),
            self.input_of("gust", ZERO),
            self.input_of("noise", templates.given.noise),
            self.model.flight_state.person,
            self.input_of("external", templates.given.external),
            self.input_of("outside", templates.given.outside),
        )
        self.given = self.trace(step.with_person)(self.model, outer, self.t, self.dt)
        self.asked: Symbols = []
        now = self.model, self.given, self.t, self.dt
        output = self._ask_python() if templates.calls_python else self.trace(self.pilot)(*now)
        self.limits: LimitProblem | None = None
        if templates.has_thrust_limits:
            output = self._limit_thrusts(output)
        output = self.trace(step.with_caller_thrusts)(output, self.given.external)
        acting = self.trace(step.actuate)(self.model, output.decision.thrusts, self.given, self.t)
        self.body = BodyInputs(self.numbers(laid_out(acting, templates.acting)), self._mean_push())
        plant = self.model.plant
        self.body_in_contact = self.numbers(self._stepped_body(plant, acting))
        self.body_on_feet, self.body_in_free_air = list[Symbol](), list[Symbol]()
        if templates.has_floor or templates.has_walls:
            self.body_on_feet = self.numbers(self._stepped_body(on_feet_only(plant), acting))
            self.body_in_free_air = self.numbers(self._stepped_body(without_contact(plant), acting))
        self.rests = list[Symbol]()
        if single:
            self._compensate_position()
        self.may_touch_walls = [self._may_touch_walls(acting)] if templates.has_walls else []
        moved = self.input_of("moved", templates.moved)
        after, sample = self.trace(self.end)(self.model, output, acting, moved, self.given, self.t, self.dt)
        check_layout(self.model.pilot.controller, templates.model.flight_state, written_out(after))
        self.next_state, self.sample = self.numbers(after), self.numbers(sample)
        if single:
            self._compensate_sums()

    def _compensate_position(self) -> None:
        """Compensate the sum of the position in all forms of the body; `moved` brings what it leaves over."""
        (at, size), first = (
            leaf_offset(self.templates.model, "flight_state", "state", "position"),
            leaves(self.templates.moved),
        )
        g, bodies = self.graph, (self.body_in_contact, self.body_on_feet, self.body_in_free_air)
        for j in range(size):
            for body in filter(None, bodies):
                node = body[j].node
                made = compensated(g, node, g.input("fly", at + j).node, g.input("rest", j).node)
                value, left = made or (node, g.constant(0.0))
                body[j] = Symbol(g, value, "f")
                body.append(Symbol(g, left, "f"))
            self.rests.append(g.input("moved", first + j))

    def _compensate_sums(self) -> None:
        """Compensate the other sums of the state; estimators correct their own, and detectors count."""
        g, flight_state = self.graph, self.templates.model.flight_state
        spans = [leaf_offset(flight_state, name) for name in flight_state._fields if name not in UNCOMPENSATED]
        for i in [i for at, size in spans for i in range(at, at + size)]:
            nodes = self.next_state[i].node, g.input("fly", i).node, g.input("rest", len(self.rests)).node
            if found := compensated(g, *nodes):
                self.next_state[i] = Symbol(g, found.value, "f")
                self.rests.append(Symbol(g, found.rest, "f"))

    @property
    def touches_before(self) -> Symbols:
        """The record of touches at the start of the step."""
        return self.numbers(self.model.flight_state.touches)

    def input_of(self, kind: str, like: Any) -> Any:
        """A nested value whose numbers are inputs of a kind."""
        return self.graph.inputs(kind, like)

    def numbers(self, value: Any) -> Symbols:
        """The numbers of a nested value."""
        return symbols(self.graph, value)

    def _ask_python(self) -> step.PilotOutput:
        f, t, dt = self.model, self.t, self.dt
        estimates, pilot_input, estimator = self.trace(step.perceive)(f, self.given, t, dt)
        memory = f.flight_state.memory
        briefed = self.trace(control_input)(f.pilot, memory, pilot_input, t, dt)
        self.asked = [*self.numbers(briefed.measured), *self.numbers(briefed.guidance.reference)]
        command = self.input_of("answer", COMMAND)
        decision, memory = self.trace(with_command)(f.pilot, memory, briefed, command, memory.controller, t)
        return step.PilotOutput(estimates, pilot_input.state.attitude, decision, memory, estimator)

    def _limit_thrusts(self, output: step.PilotOutput) -> step.PilotOutput:
        pilot, memory = self.model.pilot, self.model.flight_state.memory
        self.limits, decision, memory = limit_thrusts(self.graph, self.trace, pilot, memory, output, self.t)
        return output._replace(decision=decision, memory=memory)

    def _stepped_body(self, plant: CompiledPlant, acting: Any) -> BodyStep:
        return self.trace(step.step_body)(plant, self.model.flight_state, acting, self.given.hand, self.t, self.dt)

    @cached_property
    def may_touch_hull(self) -> Symbols:
        """Whether anything but feet may touch the floor in this step; none without a floor."""
        floor, state = self.model.plant.floor, self.model.flight_state.state
        if not self.templates.has_floor:
            return []
        return [self.trace(hull_may_touch)(floor.hull, floor.height, state, self.dt)]

    def _may_touch_walls(self, acting: Any) -> Symbol:
        """Whether anything may touch a wall in this step."""
        before, plant, dt = self.model.flight_state, self.model.plant, self.dt
        args = before.state, before.grip, before.near, acting.thrusts, acting.wind.loads, self.given.hand
        rate = self.trace(first_motion)(without_contact(plant), *args)
        room = self.trace(clearance)(plant.walls, before.near, plant.frame, before.state)
        return self.trace(may_touch_wall)(plant.walls, room, before.state, rate, dt)

    def _mean_push(self) -> Symbols:
        hand, attitude = self.given.hand, self.model.flight_state.state.attitude
        # Simpson's rule, the weights of a Runge-Kutta step
        mean = (hand.start + hand.middle * 4.0 + hand.end) * (1.0 / 6.0)
        return [*self.numbers(mean.force), *self.numbers(self.trace(push_moment)(mean, attitude))]

    # values computed before the step

    @cached_property
    def push(self) -> Symbols:
        """A row of the table of pushes at the time `when`."""
        row = self.input_of("push", ROWS.pushes)
        return self.numbers(self.trace(push_at)(self.templates.given.hand.start, row, self.graph.input("when")))

    @cached_property
    def push_is_active(self) -> Symbol:
        """Whether that push is other than zero between the times `opens` and `closes`."""
        opens, closes = self.graph.input("opens"), self.graph.input("closes")
        active: Symbol = self.trace(push_is_active)(self.input_of("push", ROWS.pushes), opens, closes)
        return active

    @cached_property
    def gust(self) -> Symbols:
        """The velocity of a row of the table of gusts."""
        return self.numbers(self.trace(gust_velocity)(self.input_of("gusts", ROWS.gusts), self.t))

    @cached_property
    def normals(self) -> list[Symbols]:
        """The standard normals of step `number`, four for each draw."""
        number, kind = self.graph.input("number", type="i"), "f" if self.graph.real == "double" else "i"
        keys = [self.graph.input("key", i, kind) for i in (0, 1)]  # no float holds 32 bits
        draws = range(draw_count(self.templates.given.noise))
        return [self.numbers(self.trace(draw_normals)(number, i, *keys)) for i in draws]

    @cached_property
    def normals_of_draw(self) -> Symbols:
        """The four standard normals of step `number` from one draw, which is an input."""
        number, draw = (self.graph.input(kind, type="i") for kind in ("number", "draw"))
        return self.numbers(self.trace(draw_normals)(number, draw, *[self.graph.input("key", i) for i in (0, 1)]))

    @cached_property
    def wall_search(self) -> tuple[Symbol, Symbols, Symbols]:
        """1 where the nearest walls are `due`: as a span `begins`, and if fast; they at first, and with a row more."""
        before, g = self.model.flight_state.near, self.graph
        found = self.trace(nearest_walls)(self.model, self.input_of("wall", ROWS.walls))
        first, more = (self.numbers(chosen(g.input("due"), near, before)) for near in (self.templates.nowhere, found))
        return where(self.trace(walls_are_due)(self.model, self.dt), 1.0, g.input("begins")), first, more

    @cached_property
    def may_touch_floor(self) -> Symbol:
        """Whether a foot may touch the floor within the steps of a span."""
        return self.trace(floor_is_near)(self.model, self.dt)
