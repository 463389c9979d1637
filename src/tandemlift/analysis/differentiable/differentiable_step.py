"""`tl.jax_step` and `tl.torch_step`: the closed step of a mission as a function, with its derivatives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, cast

import numpy as np

from tandemlift.analysis.differentiable.iterated import IteratedStep, StepForm
from tandemlift.analysis.differentiable.jax_step import JaxStep
from tandemlift.analysis.differentiable.torch_step import TorchStep
from tandemlift.analysis.linearization.kinks import Kink, kinks_near
from tandemlift.analysis.linearization.linearize import linearization_plan
from tandemlift.analysis.linearization.model_variables import outputs_from
from tandemlift.analysis.linearization.operating_point import OperatingPoint, flown_to
from tandemlift.analysis.linearization.period import delayed_numbers, differentiate, values_under_way
from tandemlift.analysis.linearization.step_derivative import REFINED
from tandemlift.analysis.linearization.step_graph import StepGraph, leaf_names
from tandemlift.compiler.machine_code.derivatives import inlined
from tandemlift.compiler.tracer import Function, Place, Symbol, to_integer
from tandemlift.core.algebra import where
from tandemlift.core.errors import InputError, shown, unknown
from tandemlift.core.types import Array, leaves, rebuilt
from tandemlift.missions import MissionLike, mission_of
from tandemlift.simulation.graphs import gust_velocity, push_at, write_limits, write_solver
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import GAUSSIAN, GUST, leaf_offset
from tandemlift.simulation.simulation import count_of, held_inputs

ACTIONS = ("push", "thrusts", "velocity")
MOTION = {"position": 3, "velocity": 3, "attitude": 4, "rates": 3}


def jax_step(
    mission: MissionLike, *, actions: str = "push", steps: int = 1, begin: float = 0.0, channels: Sequence[str] = ()
) -> JaxStep:
    """The closed step of a mission, pilot and body, as a function of JAX: next = step(state, parameters, action).

    It has the bits of `Simulation.step`, and exact derivatives, compiled too: it can be used in `jax.jit`, `grad`,
    `jvp`, `vmap` and `lax.scan`, on the processor and in double precision.

    Args:
        mission: from `load_mission`, or its name or path; the compiled engine flies it.
        actions: the input of a step, as of `Simulation.step`: "push" (3,) [N], "thrusts" (4N,) [N], or "velocity" of
            the reference (3,) [m/s].
        steps: number of steps of a call, during which the action is held.
        begin: time [s] at which the flight is handed over; until then it flies without actions.
        channels: further parts of the state: channels of the sample of the last step; at time 0, of that at 0.

    Returns:
        The step; see `JaxStep`, and docs/how-to/gradients.md.

    Raises:
        InputError: an argument is not allowed, JAX is not installed, the flight is lost before `begin`, or the mission
            has a part without a compiled derivative.
    """
    return _step(JaxStep, mission, actions, steps, begin, channels)


def torch_step(
    mission: MissionLike, *, actions: str = "push", steps: int = 1, begin: float = 0.0, channels: Sequence[str] = ()
) -> TorchStep:
    """The closed step of a mission as a function of PyTorch: as `jax_step`, with its arguments, bits and derivatives.

    Autograd, its forward mode, `torch.func` and `torch.compile` take it. States, parameters and actions may have
    leading dimensions: the lanes of a call, which all processors share.

    Raises:
        InputError: as of `jax_step`, or PyTorch is not installed.
    """
    return _step(TorchStep, mission, actions, steps, begin, channels)


def _step(kind: Any, mission: MissionLike, actions: str, steps: int, begin: float, channels: Sequence[str]) -> Any:
    if actions not in ACTIONS:
        raise unknown("actions", actions, ACTIONS)
    chosen = mission_of(mission)
    point = flown_to(chosen, begin)
    for refusal in _refusals(chosen):
        raise InputError(f"{refusal}: this has no compiled derivative")
    step = ClosedStep(FlightPlan(chosen, interactive=True), actions, channels)
    return kind(*step.at(point), count_of("steps", steps), step.kinks)


def _refusals(mission: Any) -> Iterator[str]:
    """The parts of a mission whose derivative is not compiled."""
    if mission.changes_in_flight:
        yield f"changes: {len(mission.changes)} given, must be none"
    if mission.all_walls:
        yield f"walls and corridor: {len(mission.all_walls)} walls, must be none"
    if mission.person.model != "none":
        yield f'person.model = "{mission.person.model}": must be "none"'


class ClosedStep:
    """A step in one graph: what comes from outside the step, delays and the number of the step are formed in it.

    Args:
        plan: of the flight, with inputs of a caller.
        actions: name of the input that a caller gives.
        channels: of the sample that the state has too.
    """

    def __init__(self, plan: FlightPlan, actions: str, channels: Sequence[str]) -> None:
        self.plan, self.graph, self.delayed = plan, StepGraph(plan, plan.given), delayed_numbers(plan)
        self.held, self.size = held_inputs(plan.given.external)[actions], self.graph.size
        self.under_way = sum(one.under_way for one in self.delayed)
        self.names = [*self.graph.names, *[f"under_way.{i}" for i in range(self.under_way)], "step"]
        self.places, self.columns, at = dict[str, slice](), list[int](), self.graph.body_state.start
        for name, count in MOTION.items():
            self.places[name], at = slice(at, at + count), at + count
        for name in channels:
            if name in MOTION:
                raise InputError(f"channels: {shown(name)} is a part of every state: leave it out")
            columns, variables = outputs_from(self.graph.sample, [name], ())
            self.places[name] = slice(len(self.names), len(self.names) + len(columns))
            self.names += [variable.name for variable in variables]
            self.columns += columns
        self.sampled = [self.graph.outputs[i] for i in self.columns]
        self.numbers = len(leaf_names(plan.model))
        self.keys = self.numbers - self.size + plan.tables.pushes.size + plan.tables.gusts.size
        self.by = self._formed()
        self.stands_for = self._solved()
        self.after = self._after()

    def _formed(self) -> dict[int, int]:
        """The nodes that form each input from the state, the parameters and the action."""
        g, x, p, dt = self.graph.graph, self.graph.traced, self.plan, self.plan.dt
        number = g.input("state", self.size + self.under_way)
        formed: dict[str, Sequence[Any]] = {
            "fly": [
                g.input(*("state", i) if i < self.size else ("parameter", i - self.size)) for i in range(self.numbers)
            ],
            "t": [number * dt],
            "dt": [dt],
            "key": [g.input("parameter", self.keys + i) for i in (0, 1)],
            "noise": [value for four in x.normals for value in four],
        }
        first = self.numbers - self.size
        hand = [0.0] * (3 * leaves(p.given.hand.start))
        for row in range(len(p.tables.pushes)):
            bell = g.inputs("parameter", GAUSSIAN, first + row * leaves(GAUSSIAN))
            times = [(number * 2.0 + float(half)) * (0.5 * dt) for half in range(3)]
            own = [s for t in times for s in x.numbers(x.trace(push_at)(p.given.hand.start, bell, t))]
            hand = [a + b for a, b in zip(hand, own, strict=True)]
        gust, first = [0.0] * 3, first + p.tables.pushes.size
        for row in range(len(p.tables.gusts)):
            own = x.numbers(
                x.trace(gust_velocity)(g.inputs("parameter", GUST, first + row * leaves(GUST)), number * dt)
            )
            gust = [a + b for a, b in zip(gust, own, strict=True)]
        external: list[Any] = [0.0] * leaves(p.given.external)
        external[self.held.place] = [g.input("action", i) for i in range(len(external[self.held.place]))]
        if self.held.flag is not None:
            external[self.held.flag] = 1.0
        formed |= {"hand": hand, "gust": gust, "external": external}
        by = {
            g.input(kind, i).node: g.number(value) for kind, values in formed.items() for i, value in enumerate(values)
        }
        whole: Any = to_integer(cast(float, number))
        return by | {g.input("number", type="i").node: whole.node}

    def _solved(self) -> dict[int, int]:
        """The nodes whose derivative the limit solver's thrusts have: more whole steps, with the held rotors held."""
        x, g = self.graph.traced, self.graph.graph
        if x.limits is None:
            return {}
        solver, (_, search_step) = x.limits.solver, x.limits.solver.laws
        problem = rebuilt(iter(x.limits.problem), solver.problem)
        found = g.inputs("found", solver.search.found)
        sides = zip(found.active, problem.limits, found.thrusts, strict=True)
        held = [where(side > 0.0, top, thrust) for side, top, thrust in sides]
        now = found._replace(thrusts=type(found.thrusts)(*held))
        for _ in range(REFINED):
            after = search_step(problem, solver.search._replace(found=now, repeated=1.0))
            now = now._replace(thrusts=after.found.thrusts)
        n = solver.rotors
        chosen = [where(x.limits.beyond, a, b) for a, b in zip(now.thrusts, x.limits.plain[n:], strict=True)]
        return {g.input("solved", n + i).node: s.node for i, s in enumerate(chosen)}

    def _after(self) -> list[int]:
        """The nodes of the next state."""
        g, after, lines, at = self.graph.graph, list(self.graph.next), list[int](), self.size
        for one in self.delayed:
            line = [g.input("state", at + j).node for j in range(one.under_way)]
            if line:
                lines += [after[one.number], *line[:-1]]
                after[one.number] = line[-1]
            at += len(line)
        return [*after, *lines, (g.input("state", at) + 1.0).node, *self.sampled]

    def _form(self, body: Sequence[Symbol], tests: Sequence[int]) -> tuple[StepForm, list[Symbol]]:
        """The step with one form of the body, and the conditions of the other."""
        g, limits = self.graph.graph, self.graph.traced.limits
        by = self.by | {g.input("moved", i).node: s.node for i, s in enumerate(body)}
        needs = [] if limits is None else [s.node for s in limits.symbols]
        made = inlined(g, [*self.after, *needs, *tests], by, self.stands_for)
        stands_for = {made[a].node: made[b].node for a, b in self.stands_for.items() if a in made}

        def begin(f: Function) -> None:
            if limits is not None:
                parts: Any = {of: [made[s.node] for s in getattr(limits, of)] for of in ("problem", "plain", "search")}
                f.read |= dict.fromkeys(("solved", "found"), lambda i: Place("%work", len(limits.problem) + i))
                write_limits(f, limits._replace(beyond=made[limits.beyond.node], **parts), 0)

        form = StepForm([made[n] for n in self.after], stands_for, begin)
        return form, [made[n] for n in tests]

    def iterated(self) -> IteratedStep:
        """The step as machine code repeats it."""
        x, graph, first = self.graph.traced, self.graph, self.size
        forms, otherwise = [self._form(x.body_in_contact, ())[0]], list[Symbol]()
        if graph.contact_tests:
            air, otherwise = self._form(x.body_in_free_air, graph.contact_tests)
            forms.insert(0, air)
        late = {one.number for one in self.delayed if one.under_way}
        moving = {*graph.choose(self.sampled, [], late).kept, *graph.constant}
        for one in self.delayed:
            moving |= set(range(first, first + one.under_way)) if one.number in moving else set()
            first += one.under_way
        moving |= set(range(first + 1, len(self.names)))
        place, limits = self.held.place, x.limits
        size = {"state": len(self.names), "parameter": self.keys + 2, "action": place.stop - place.start}
        size["work"] = len(limits.problem) + len(limits.search) if limits else 0
        smooth = {"parameter": range(self.keys), "action": range(size["action"]), "state": moving}
        return IteratedStep(
            forms=forms,
            otherwise=otherwise,
            sizes=size,
            smooth={of: frozenset(numbers) for of, numbers in smooth.items()},
            ended=leaf_offset(self.plan.model, "flight_state", "ended").at,
            shared=lambda module: write_solver(module, limits.solver, 1) if limits else None,
        )

    def at(self, point: OperatingPoint) -> tuple[Any, ...]:
        """The parts of a `FlightStep` from a point of the flight on: code, start, names and places."""
        p = self.plan
        lines = [x for values in values_under_way(self.delayed, point.ring, point.k) for x in values]
        state = np.array([*point.numbers[: self.size], *lines, point.k, *point.sample[self.columns]])
        parameters = np.concatenate(
            [point.numbers[self.size :], p.tables.pushes.ravel(), p.tables.gusts.ravel(), np.ravel(p.seeds)]
        )
        names = leaf_names(p.model)[self.size :]
        for table, like, rows in (("pushes", GAUSSIAN, p.tables.pushes), ("gusts", GUST, p.tables.gusts)):
            names += [f"{table}.{i}.{name}" for i in range(len(rows)) for name in leaf_names(like)]
        return self.iterated(), (state, parameters), (self.names, [*names, "seed.0", "seed.1"]), self.places

    def kinks(self, state: Array, parameters: Array, action: Array, tolerance: float) -> list[Kink]:
        """The kinks near a state."""
        p, at = self.plan, self.size
        k, external = int(state[at + self.under_way]), np.zeros(leaves(p.given.external))
        external[self.held.place] = action
        if self.held.flag is not None:
            external[self.held.flag] = 1.0
        ring = np.zeros_like(p.start().ring)
        for one in self.delayed:
            for j in range(1, one.under_way + 1):
                ring[(k - j) % len(ring), one.column] = state[at + j - 1]
            at += one.under_way
        numbers = np.concatenate([state[: self.size], parameters[: self.numbers - self.size]])
        recipe, _ = linearization_plan(OperatingPoint(p, k, numbers, ring, external.tolist()), "loop", None, None, 1)
        return kinks_near(recipe, differentiate(recipe), tolerance)
