"""Flying step by step: for a controller in plain Python, a body in another engine, or what changes in flight.

The parts of a step are compiled, and hand their values on in the memory of the flight.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np

from tandemlift.algebra.vector import layout
from tandemlift.common.types import Array, Progress
from tandemlift.controllers import control
from tandemlift.engines.registry import EngineBody, WaitingBody, engine_named
from tandemlift.kernels import GIVEN, FlightMemory, leaf_offset
from tandemlift.loop.running_metrics import EMPTY
from tandemlift.simulation.parameter_changes import ParameterChanges, ScheduledChange, hand_place
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import RawResult, take_metrics
from tandemlift.trace import flat, leaves, unflat
from tandemlift.trace.compile_events import Stopped, always
from tandemlift.vehicle import Vehicle

PROGRESS_EVERY = 1000  # steps
STATE = 13  # numbers of a state
NEVER = -1  # the number of no step


def body_in(engine: str, p: FlightPlan) -> EngineBody | None:
    """The body of a mission at t = 0 in an engine; None for the compiled one.

    Raises:
        InputError: the engine is not known, not installed, or cannot take the mission.
    """
    chosen, plant = engine_named(engine), p.flying.plant
    if chosen.load is None:
        return None
    return chosen.start(p.mission, Vehicle.from_settings(p.mission.vehicle), plant.floor, plant.walls)


class Stepper:
    """One flight, a step at a time.

    Args:
        p: the mission, ready.
        body: where the body lives; None for the compiled one.

    Attributes:
        a: the flight's numbers.
        row: the numbers of the sample of the last step.
    """

    def __init__(self, p: FlightPlan, body: EngineBody | None = None) -> None:
        self.body, self.changing = body, ParameterChanges(p)
        self._lay_out(p)

    def _lay_out(self, p: FlightPlan, before: FlightMemory | None = None) -> None:
        """Make the memory in which a mission's step works; what waits in delay lines is kept."""
        self.p, self.interpreted = p, p.interpreted
        leaves_body = self.body is not None
        self.by_parts = leaves_body or self.interpreted is not None
        self.code = p.kernels.parts(leaves_body=leaves_body) if self.by_parts else p.kernels.loop(1)
        start = p.start()
        if before is not None:
            start = start._replace(ring=before.ring.reshape(start.ring.shape))
        self.memory = FlightMemory(self.code, [start], p.grid(1, 1), leaves(p.sample))
        self.a, self.row = self.memory.numbers, self.memory.log[0, 0]
        self.at_lost, self.hand = leaf_offset(p.flying, "moving", "lost").at, hand_place(p)
        self._find_rooms()

    def _find_rooms(self) -> None:
        """Where a step's parts leave what Python or another engine takes, and look for what it answers."""
        room = {
            name: self.memory.work[self.memory.span(name)]
            for name in ("asked", "answer", "external", "acting", "push", "moved")
        }
        acting = self.p.kernels.templates.acting
        thrusts, air = leaf_offset(acting, "thrusts"), leaf_offset(acting, "weather", "loads")
        self.x, self.y, self.v, self.push = room["asked"], room["answer"], room["moved"], room["push"]
        self.external = room["external"]
        if self.body is not None:
            self.v[:] = flat(self.p.kernels.templates.moved)
        self.thrusts = room["acting"][thrusts.at : thrusts.at + thrusts.size]
        self.loads = room["acting"][air.at : air.at + air.size]

    def change(self, due: ScheduledChange) -> None:
        """Let the flight go on as a changed mission; what takes other laws is changed at once."""
        if due.prepared.variant == self.p.variant:
            self.changing.become(self.a, self.p, due)
            self.p = due.prepared
        else:
            self._hand_over(due.prepared)

    def _hand_over(self, p: FlightPlan) -> None:
        """Go on by other laws; a controller begins with a fresh memory if it remembers other things; ramps jump."""
        size, hand, row = leaves(self.p.flying.moving), self.a[self.hand].copy(), self.row
        moving = unflat(self.a[:size], self.p.flying.moving)
        memory, fresh = moving.memory, p.flying.moving.memory.controller
        if layout(memory.controller) != layout(fresh):
            memory = memory._replace(controller=fresh)
        self.changing.ramps.clear()
        self._lay_out(p, self.memory)
        self.a[:] = flat(p.flying._replace(moving=moving._replace(memory=memory)))
        self.hold(hand)
        self.row[:] = row

    def hold(self, hand: np.ndarray) -> None:
        """Move the hand that is moved from outside: the numbers of a `laws.person.virtual_hand.Held`."""
        self.a[self.hand] = hand
        self.memory.put("fresh", 1)

    def _change(self, k: int) -> None:
        for due in self.changing.take_due(k):
            self.change(due)
        if self.changing.apply(self.a, k):
            self.memory.put("fresh", 1)
        hand = self.changing.hand_at(k)
        if hand is not None:
            self.hold(hand)

    def step(self, k: int, *, final: bool = False, external: Array | None = None) -> None:
        """Take step number k; its sample is left in `row`.

        Args:
            k: the step.
            final: whether only the sample is taken. A body in another engine moves all the same.
            external: the numbers of a `person.caller_inputs.External`, where the mission was prepared as interactive.
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
            call["fly"](at)
        else:
            if self.interpreted is not None:
                call["ask"](at)
                self._answer()
            if self.body is not None:
                call["decide"](at)
                self._advance(self.body)
            call["complete"](at)
        put("fresh", 0)

    def _answer(self) -> None:
        """Let the controller in plain Python decide."""
        assert self.interpreted
        gains, memory = self.interpreted
        measured, reference = unflat(self.x, GIVEN)
        command, memory = control(gains, memory, measured, reference)
        self.interpreted, self.y[:] = (gains, memory), flat(command)

    def _advance(self, body: EngineBody) -> None:
        body.advance(self.thrusts, self.loads, self.push[:3], self.push[3:])
        self.v[:STATE] = body.state
        self.v[STATE : STATE + body.readings.size] = body.readings

    def rest(self) -> None:
        """Take no step for now; to be called ten times a second, or more often, by who lets a flight wait."""
        if isinstance(self.body, WaitingBody):
            self.body.rest()

    @property
    def lost(self) -> bool:
        """Whether the state is no longer sound."""
        return bool(self.a[self.at_lost] != 0.0)


def fly_stepwise(
    p: FlightPlan,
    rows: int,
    every: int,
    progress: Progress | None = None,
    body: EngineBody | None = None,
    going: Callable[[], bool] = always,
) -> RawResult:
    """Fly a mission step by step; as the loop does, to the last bit if the body is the same."""
    stepper, columns = Stepper(p, body), leaves(p.sample)
    log, last = np.zeros((rows, columns)), np.full(columns, math.nan)
    began, early, k = time.perf_counter(), EMPTY, 0
    while k <= p.steps:
        if k == p.late_step < p.steps:
            (early,) = take_metrics(stepper.a, stepper.p.flying, 1)
        if stepper.lost:
            break
        stepper.step(k, final=k == p.steps)
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
    like = stepper.p.flying.moving
    moving = unflat(stepper.a[: leaves(like)], like)
    return RawResult(moving, early, k, log, last, time.perf_counter() - began)
