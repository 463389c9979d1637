"""Shared by tests of linear models: points of flights, the step in plain Python, differences of the compiled step."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from law_values import flat, rebuilt

import tandemlift as tl
from tandemlift.analysis.linearization.linearize import linearization_plan
from tandemlift.analysis.linearization.model_variables import given_at
from tandemlift.analysis.linearization.operating_point import flown_to
from tandemlift.analysis.linearization.period import (
    LinearizationPlan,
    PeriodDerivative,
    differentiate,
    values_under_way,
)
from tandemlift.analysis.linearization.step_graph import no_push
from tandemlift.simulation.loop.step import step_flight
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.stepping import Stepper

QUIET = {  # sensors without noise, whose resolution is a straight line as it is in the model
    **{
        f"sensors.joints.{kind}_{what}": 0.0
        for kind in ("force", "torque")
        for what in ("noise", "drift", "resolution")
    },
    **{f"sensors.{sensor}.{what}": 0.0 for sensor in ("accelerometer", "gyroscope") for what in ("noise", "drift")},
    **{f"sensors.motion.{what}_noise": 0.0 for what in ("position", "velocity", "attitude")},
}


class Linearized(NamedTuple):
    """What is differentiated, and its derivative."""

    recipe: LinearizationPlan
    made: PeriodDerivative


def linearized(name: str, changes: dict[str, Any], at: float | None, steps: int | None = None) -> Linearized:
    """A built-in mission, linearized at a time."""
    recipe, _ = linearization_plan(flown_to(tl.load_mission(name, changes), at), "loop", None, None, steps)
    return Linearized(recipe, differentiate(recipe))


def local_jacobian(of: Linearized) -> np.ndarray:
    """The derivative of the first step by the states but those under way, and by the inputs: states, then outputs."""
    r, d = of
    nodes = [*[r.graph.next[i] for i in r.choice.kept], *r.outputs]
    return d.steps[0].nodes.rows_of(nodes, len(r.choice.kept) + len(r.inputs))


class PlainStep:
    """The first step in plain Python as a function of states and inputs, for other tools that differentiate it."""

    def __init__(self, r: LinearizationPlan) -> None:
        plan, t = r.point.plan, r.point.k * r.point.plan.dt
        self.r, self.t, self.dt, self.model, given = r, t, plan.dt, plan.model, plan.given
        outer = given_at(plan, t)
        self.given = given._replace(hand=type(given.hand)(*[no_push(plan)] * 3))
        noise = [0.0] * len(flat(given.noise))
        self.outer = [*outer["hand"], *outer["gust"], *noise]
        self.places = {"hand": 0, "gust": len(outer["hand"])}
        self.x0 = np.concatenate([r.point.numbers[list(r.choice.kept)], np.zeros(len(r.inputs))])

    def __call__(self, x: Any) -> list[Any]:
        """States and outputs; x: states, and changes of the inputs."""
        r, values = self.r, list(x)
        kept, numbers, outer = list(r.choice.kept), [float(v) for v in r.point.numbers], list(self.outer)
        for i, value in zip(kept, values, strict=False):
            numbers[i] = value
        for column, value in zip(r.inputs, values[len(kept) :], strict=True):
            for kind, index, weight in column.seeds:
                if kind == "fly":
                    numbers[index] = numbers[index] + value * weight
                else:
                    outer[self.places[kind] + index] = outer[self.places[kind] + index] + value * weight
        source = iter(outer)
        hand, gust, noise = (rebuilt(source, part) for part in self.given[:3])
        model = rebuilt(numbers, self.model)
        given = self.given._replace(hand=hand, gust=gust, noise=noise, person=model.flight_state.person)
        after, sample = step_flight(model, given, self.t, self.dt)
        state, row = flat(after), flat(sample)
        return [*[state[i] for i in kept], *[row[r.graph.outputs.index(node)] for node in r.outputs]]


class NativePeriod:
    """A period of the compiled flight as a function of its state at the point."""

    def __init__(self, r: LinearizationPlan) -> None:
        self.r, self.plan = r, FlightPlan(r.point.plan.mission)
        self.stepper = Stepper(self.plan)
        for k in range(r.point.k):
            self.stepper.step(k)
        self.ring0 = self.stepper.memory.ring.copy()
        self.shape = self.plan.start().ring.shape

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """The state after a period from the state x."""
        r, s, kept = self.r, self.stepper, list(self.r.choice.kept)
        s.a[:] = r.point.numbers
        s.a[kept] = x[: len(kept)]
        s.memory.ring[:] = self.ring0
        ring = s.memory.ring.reshape(self.shape)
        for (i, ago), value in zip(r.waiting, x[len(kept) :], strict=True):
            ring[(r.point.k - ago) % len(ring), r.delayed[i].column] = value
        for step in range(r.steps):
            s.step(r.point.k + step)
        late = values_under_way(list(r.delayed), ring, r.point.k + r.steps)
        return np.concatenate([s.a[kept], [late[i][ago - 1] for i, ago in r.waiting]])

    def jacobian(self, x: np.ndarray, h: float) -> np.ndarray:
        """Central differences, extrapolated to order four."""
        made = np.zeros((len(x), len(x)))
        for j in range(len(x)):
            change = np.zeros(len(x))
            change[j] = h
            near, far = self(x + change) - self(x - change), self(x + 2.0 * change) - self(x - 2.0 * change)
            made[:, j] = (8.0 * near - far) / (12.0 * h)
        return made
