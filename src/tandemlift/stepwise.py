"""Flying step by step: for a controller in plain Python, or a body that lives in another engine.

The parts of a step are compiled, and hand their values on in flat arrays.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np

from tandemlift.changing import Changing, Due, hand_place
from tandemlift.engines import Body, Waiting
from tandemlift.flown import Flown, take_tallies
from tandemlift.jit import flat, leaves, unflat
from tandemlift.kernels import COMMAND, GIVEN, place
from tandemlift.laws.controllers import control
from tandemlift.prepared import Prepared
from tandemlift.tally import EMPTY
from tandemlift.vector import layout

Progress = Callable[[int, int], None]
PROGRESS_EVERY = 1000  # steps
STATE = 13  # numbers of a state


class Stepper:
    """One flight, a step at a time.

    Args:
        p: the mission, ready.
        body: where the body lives; None for the compiled one.
    """

    def __init__(self, p: Prepared, body: Body | None = None) -> None:
        self.body, self.changing = body, Changing(p)
        self.a, self.ring, self.work = np.array(flat(p.flying)), p.ring(), np.zeros(p.kernels.work_size)
        self._lay_out(p)

    def _lay_out(self, p: Prepared) -> None:
        """Make the arrays in which the parts of a mission's step hand their values on."""
        likes = p.kernels.likes
        self.p, self.parts = p, p.kernels.parts
        self.g, self.m, self.c, self.v, self.row = (np.zeros(leaves(x)) for x in likes[1:-1])
        self.v[:] = flat(likes.moved)
        self.x, self.y, self.scratch = np.zeros(leaves(GIVEN)), np.zeros(leaves(COMMAND)), self.work[p.kernels.limits :]
        self.interpreted, self.at_lost = p.interpreted, place(p.flying, "moving", "lost").at
        self.hand = hand_place(p)
        thrusts, air = place(likes.acting, "thrusts"), place(likes.acting, "weather", "loads")
        self.thrusts = self.c[thrusts.at : thrusts.at + thrusts.size]
        self.loads, self.push = self.c[air.at : air.at + air.size], np.zeros(6)

    def compile(self) -> None:
        """Let the parts of a step compile, and fly nothing."""
        p, parts, a = self.p, self.parts, self.a.copy()
        parts.outside(a, p.tables, self.work.copy(), p.seeds, self.g, 0, p.dt)
        if self.interpreted is None:
            parts.whole(a, self.g, self.m, self.scratch, 0, p.dt)
        else:
            parts.before(a, self.g, self.x, 0, p.dt)
            parts.after(a, self.g, self.y, self.m, self.scratch, 0, p.dt)
        parts.acting(a, self.g, self.m, self.c, self.push, 0, p.dt)
        if self.body is None:
            parts.moved(a, self.g, self.c, self.v, 0, p.dt)
        parts.observed(a, self.ring.copy(), p.delays, self.g, self.m, self.c, self.v, self.row, 0, True)

    def change(self, due: Due) -> None:
        """Let the flight go on as a changed mission; what takes other laws is changed at once."""
        if due.prepared.variant == self.p.variant:
            self.changing.become(self.a, self.p, due)
            self.p = due.prepared
        else:
            self._hand_over(due.prepared)

    def _hand_over(self, p: Prepared) -> None:
        """Go on by other laws; a controller begins with a fresh memory if it remembers other things; ramps jump."""
        size, hand, row = leaves(self.p.flying.moving), self.a[self.hand], self.row
        moving = unflat(self.a[:size], self.p.flying.moving)
        memory, fresh = moving.memory, p.flying.moving.memory.controller
        if layout(memory.controller) != layout(fresh):
            memory = memory._replace(controller=fresh)
        self.a = np.array(flat(p.flying._replace(moving=moving._replace(memory=memory))))
        self.changing.ramps.clear()
        self._lay_out(p)
        self.hold(hand)
        self.row[:] = row

    def hold(self, hand: np.ndarray) -> None:
        """Move the hand that is moved from outside: the numbers of a `laws.grab.Held`."""
        self.a[self.hand] = hand

    def _change(self, k: int) -> None:
        for due in self.changing.take_due(k):
            self.change(due)
        self.changing.apply(self.a, k)
        hand = self.changing.hand_at(k)
        if hand is not None:
            self.hold(hand)

    def step(self, k: int, *, final: bool = False) -> None:
        """Take step number k; its sample is left in `row`. If `final`, only the sample is taken."""
        self._change(k)
        p, parts = self.p, self.parts
        parts.outside(self.a, p.tables, self.work, p.seeds, self.g, k, p.dt)
        if self.interpreted is None:
            parts.whole(self.a, self.g, self.m, self.scratch, k, p.dt)
        else:
            self._control(k)
        parts.acting(self.a, self.g, self.m, self.c, self.push, k, p.dt)
        if self.body is None:
            parts.moved(self.a, self.g, self.c, self.v, k, p.dt)
        else:
            self._advance(self.body)
        parts.observed(self.a, self.ring, p.delays, self.g, self.m, self.c, self.v, self.row, k, final)

    def _control(self, k: int) -> None:
        """Let the controller in plain Python decide."""
        p, parts = self.p, self.parts
        assert self.interpreted
        gains, memory = self.interpreted
        parts.before(self.a, self.g, self.x, k, p.dt)
        measured, reference = unflat(self.x, GIVEN)
        command, memory = control(gains, memory, measured, reference)
        self.interpreted, self.y[:] = (gains, memory), flat(command)
        parts.after(self.a, self.g, self.y, self.m, self.scratch, k, p.dt)

    def _advance(self, body: Body) -> None:
        body.advance(self.thrusts, self.loads, self.push[:3], self.push[3:])
        self.v[:STATE] = body.state
        self.v[STATE : STATE + body.felt.size] = body.felt

    def rest(self) -> None:
        """Take no step for now; to be called ten times a second, or more often, by who lets a flight wait."""
        if isinstance(self.body, Waiting):
            self.body.rest()

    @property
    def lost(self) -> bool:
        """Whether the state is no longer sound."""
        return bool(self.a[self.at_lost] != 0.0)


def fly_stepwise(
    p: Prepared, rows: int, every: int, progress: Progress | None = None, body: Body | None = None
) -> Flown:
    """Fly a mission step by step; as `single` of the compiled loops, to the last bit if the body is the same."""
    stepper, columns = Stepper(p, body), leaves(p.sample)
    log, last = np.zeros((rows, columns)), np.full(columns, math.nan)
    stepper.compile()
    began, early, k = time.perf_counter(), EMPTY, 0
    while k <= p.steps and not stepper.lost:
        if k == p.late_step < p.steps:
            (early,) = take_tallies(stepper.a, stepper.p.flying, 1)
        stepper.step(k, final=k == p.steps)
        if k % every == 0:
            log[k // every] = stepper.row
        if k == p.steps:
            last[:] = stepper.row
            break
        k += 1
        if progress and k % PROGRESS_EVERY == 0:
            progress(k, p.steps)
    like = stepper.p.flying.moving
    moving = unflat(stepper.a[: leaves(like)], like)
    return Flown(moving, early, k, log, last, time.perf_counter() - began)
