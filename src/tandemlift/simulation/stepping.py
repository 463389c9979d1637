"""Flights step by step: for controllers in plain Python, other engines, and changes in flight.

The parts of a step are compiled and exchange values through the memory of the flight.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from tandemlift.core.progress import Stopped, always
from tandemlift.core.refusals import Refusals
from tandemlift.core.types import Array, Progress, flat, leaves, unflat
from tandemlift.core.vector import layout
from tandemlift.engines.registry import EngineBody, EngineLost, PushedBody, TouchingBody, WaitingBody, engine_named
from tandemlift.flight.record import interruption
from tandemlift.parts.controllers import control
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.simulation.loop.running_metrics import EMPTY
from tandemlift.simulation.loop.step import FlightState
from tandemlift.simulation.parameter_changes import ParameterChanges, ScheduledChange, hand_place
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import GIVEN, FlightMemory, leaf_offset, machine_of
from tandemlift.simulation.refusals import refusals_of
from tandemlift.simulation.results import RawResult, take_metrics

PROGRESS_EVERY = 1000  # steps
STATE = 13  # numbers of a state
NO_TOUCHES: Array = np.zeros(0)
NEVER = -1  # the number of no step
GUIDANCE_MEMORY = ("flight_state", "memory", "guidance")


def body_of(p: FlightPlan) -> EngineBody | None:
    """The body of a plan at t = 0 in its engine; None for the compiled one.

    Raises:
        InputError: the engine is not installed, or cannot fly the mission.
    """
    chosen, plant = engine_named(p.engine), p.model.plant
    if chosen.load is None:
        return None
    return chosen.start(p.mission, Vehicle.from_settings(p.mission.vehicle), plant.floor, plant.walls)


class Stepper:
    """One flight, a step at a time.

    Args:
        p: the plan of the flight.
        body: a body of another engine; None for the compiled one.

    Attributes:
        a: the flight's numbers.
        row: the sample of the last step, as numbers.
    """

    def __init__(self, p: FlightPlan, body: EngineBody | None = None) -> None:
        self.body, self.changing = body, ParameterChanges(p)
        self._pushed = body.pushed if isinstance(body, PushedBody) else None
        self._lay_out(p)

    def _lay_out(self, p: FlightPlan, before: FlightMemory | None = None) -> None:
        """Allocate the memory of a step; the content of the delay lines is kept."""
        self.p, self.interpreted = p, p.interpreted
        leaves_body = self.body is not None
        machine = machine_of(self.body) if self.interpreted is None else None
        self.by_parts = self.interpreted is not None or (leaves_body and machine is None)
        loop = p.loop_code
        self.code = loop.parts(leaves_body=leaves_body) if self.by_parts else loop.loop(1, around=machine)
        start = p.start()
        if before is not None:
            start = start._replace(ring=before.ring.reshape(start.ring.shape))
        self.memory = FlightMemory(self.code, [start], p.grid(1, 1), leaves(p.sample), machine=machine)
        self.a, self.row = self.memory.numbers, self.memory.log[0, 0]
        self.before = self.a.copy()
        self.at_lost, self.hand = leaf_offset(p.model, "flight_state", "ended").at, hand_place(p)
        self._bind_views()

    def _bind_views(self) -> None:
        """Bind views of the memory that the parts of a step exchange with Python or another engine."""
        names = ("asked", "answer", "moved", "push", "external", "outside", "acting")
        views = [self.memory.work[self.memory.span(name)] for name in names]
        self.asked, self.answer, self.moved, self.push, self.external, self.outside, acting = views
        layout_of_acting = self.p.loop_code.templates.acting
        thrusts, air = leaf_offset(layout_of_acting, "thrusts"), leaf_offset(layout_of_acting, "wind", "loads")
        self.thrusts = acting[thrusts.at : thrusts.at + thrusts.size]
        self.loads = acting[air.at : air.at + air.size]
        if self.body is not None:
            moved = self.p.loop_code.templates.moved
            self.touches = self.body.touches if isinstance(self.body, TouchingBody) else NO_TOUCHES
            self.moved[:] = flat(moved._replace(touches=self.p.model.flight_state.touches))

    def change(self, due: ScheduledChange) -> None:
        """Change the mission: ramp its numbers, or exchange the laws at once."""
        if due.prepared.variant == self.p.variant:
            self.changing.ramp_to(self.a, self.p, due)
            self.p = due.prepared
        else:
            self._exchange_laws(due.prepared)

    def _exchange_laws(self, p: FlightPlan) -> None:
        """Continue with other laws. A controller of another layout starts with an initial memory; ramps end at once."""
        hand, row, flight_state = self.a[self.hand].copy(), self.row, self.flight_state
        memory, fresh = flight_state.memory, p.model.flight_state.memory.controller
        if layout(memory.controller) != layout(fresh):
            memory = memory._replace(controller=fresh)
        self.changing.ramps.clear()
        self._lay_out(p, self.memory)
        self.a[:] = flat(p.model._replace(flight_state=flight_state._replace(memory=memory)))
        self.move_hand(hand)
        self.row[:] = row

    def move_hand(self, hand: np.ndarray) -> None:
        """Move the virtual hand: the numbers of its input, see `parts.person.virtual_hand`."""
        self.a[self.hand] = hand
        self.memory.put("fresh", 1)

    def _change(self, k: int) -> None:
        for due in self.changing.take_due(k):
            self.change(due)
        if self.changing.apply(self.a, k):
            self.memory.put("fresh", 1)
        hand = self.changing.hand_at(k)
        if hand is not None:
            self.move_hand(hand)

    def step(self, k: int, *, final: bool = False, external: Array | None = None) -> None:
        """Take step k, and write its sample into `row`.

        Args:
            k: the step.
            final: whether only the sample is taken; a body in another engine moves nevertheless.
            external: the numbers of a `simulation.loop.caller_inputs.CallerInput`, if the plan is interactive.

        Raises:
            EngineLost: the engine took no step; the flight's numbers are those before it.
        """
        self._change(k)
        if external is not None:
            self.external[:] = external
        put, call, at = self.memory.put, self.code.held, self.memory.address
        put("k", k)
        put("since", k)
        put("steps", k if final else NEVER)
        if not self.by_parts:
            put("stop", k + 1)
            self.memory.call(call["fly"])
        else:
            if self.interpreted is not None:
                call["ask"](at)
                self._ask_controller()
            if self.body is not None:
                self.before[:] = self.a
                call["decide"](at)
                self._advance(self.body)
            call["complete"](at)
        put("fresh", 0)

    def _ask_controller(self) -> None:
        """Call the controller in plain Python."""
        assert self.interpreted
        gains, memory = self.interpreted
        measured, reference = unflat(self.asked, GIVEN)
        command, memory = control(gains, memory, measured, reference)
        self.interpreted, self.answer[:] = (gains, memory), flat(command)

    def _advance(self, body: EngineBody) -> None:
        try:
            body.advance(self.thrusts, self.loads, self.push[:3], self.push[3:])
        except OSError as error:
            self.a[:] = self.before
            raise EngineLost(error) from error
        self.moved[:STATE] = body.state
        self.moved[STATE : STATE + body.readings.size] = body.readings
        if self.touches.size:
            self.moved[self.moved.size - self.touches.size :] = self.touches
        if self._pushed is not None:
            self.outside[:] = self._pushed

    def rest(self) -> None:
        """Keep a waiting flight alive; call it at least ten times a second while no step is taken."""
        if isinstance(self.body, WaitingBody):
            self.body.rest()

    def refusals(self, t: float) -> Refusals:
        """The refusals that would apply at time t [s], after the last step, with reasons."""
        model = self.p.model
        guidance = self._part(model.pilot.guidance, "pilot", "guidance")
        return refusals_of(guidance, self._part(model.flight_state.memory.guidance, *GUIDANCE_MEMORY), t)

    def _part(self, like: Any, *path: str) -> Any:
        """A part of the flight as it is now, by its path from `FlightModel`."""
        at, size = leaf_offset(self.p.model, *path)
        return unflat(self.a[at : at + size], like)

    @property
    def flight_state(self) -> FlightState:
        """The state of the flight as it is now."""
        return self._part(self.p.model.flight_state, "flight_state")

    @property
    def lost(self) -> bool:
        """Whether the flight has crashed or diverged."""
        return bool(self.a[self.at_lost] != 0.0)


def fly_stepwise(
    p: FlightPlan,
    rows: int,
    every: int,
    progress: Progress | None = None,
    body: EngineBody | None = None,
    going: Callable[[], bool] = always,
    lead: Callable[[Stepper, int], Array | None] | None = None,
) -> RawResult:
    """Fly a mission step by step; with the compiled body bit-identical to the compiled loop.

    `lead` is called before each step, and returns the caller's inputs of an interactive plan.

    Raises:
        EngineLost: the engine took no step at all. Later, the result has the flight so far, and the reason.
    """
    stepper, columns = Stepper(p, body), leaves(p.sample)
    log, last = np.zeros((rows, columns)), np.full(columns, math.nan)
    began, early, k, ending = time.perf_counter(), EMPTY, 0, None
    while k <= p.steps:
        if k == p.late_step < p.steps:
            (early,) = take_metrics(stepper.a, stepper.p.model, 1)
        if stepper.lost:
            break
        try:
            stepper.step(k, final=k == p.steps, external=lead(stepper, k) if lead else None)
        except EngineLost as error:
            if k == 0:
                raise
            ending = interruption(k * p.dt, error)
            break
        if k % every == 0:
            log[k // every] = stepper.row
        if k == p.steps:
            last[:] = stepper.row
            break
        k += 1
        if k % PROGRESS_EVERY == 0:
            if not going():
                raise Stopped
            if progress:
                progress(k, p.steps)
    return RawResult(stepper.flight_state, early, k, log, last, time.perf_counter() - began, ending, stepper.p)
