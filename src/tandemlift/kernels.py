"""The compiled loops over steps: one flight, a block of flights, and the halves around an interpreted controller.

A flight is a flat array of the numbers of a `Flying`; a block holds LANES of them interleaved, so that the same
instruction serves all of them. The laws are the same, and so is every bit of the result.

The force of the person is evaluated SPAN steps ahead at every half step: pushes depend on time alone, and a push that
is over costs nothing. So their number is data, at no cost to the step.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numba
from numba.extending import register_jitable

from tandemlift.jit import cached_in, folder, install, leaves, load, load_lane, store, store_lane, zeroed
from tandemlift.laws.body import Wrench
from tandemlift.laws.controllers import Command, Measured, Reference
from tandemlift.laws.push import SUPPORT, Gaussian, Hand, push_of
from tandemlift.loop import Flying, blank_sample, commit, move
from tandemlift.pilot import conclude, guide
from tandemlift.vector import ZERO

LANES = 8
SPAN = 16  # steps
HALVES = 2 * SPAN + 1
GAUSSIAN = Gaussian(ZERO, 0.0, 0.0, ZERO)
COMMAND = Command(Wrench(0.0, ZERO), ZERO)

COMPILE = {"error_model": "numpy", "fastmath": False}


class Given(NamedTuple):
    """What a controller is given at a sample."""

    measured: Measured
    reference: Reference


@register_jitable(forceinline=True, **COMPILE)
def active(p, opens, closes):
    """Whether a push is other than zero somewhere between two times [s]."""
    around = SUPPORT / p.per_sigma
    return (p.time + around > opens) & (p.time - around < closes)


@register_jitable(forceinline=True, **COMPILE)
def feel(hands, pushes, k, dt, push_like):
    """Fill the table of pushes with the sum of one flight's at the half steps of the SPAN steps that hold step k."""
    first, width = k - k % SPAN, hands.size // HALVES
    hands[:] = 0.0
    for i in range(pushes.shape[0]):
        p = load(pushes[i], GAUSSIAN)
        if active(p, first * dt, (first + SPAN) * dt):
            for j in range(HALVES):
                push = push_of(push_like, p, (2 * first + j) * (0.5 * dt))
                store_lane(hands, j * width, 1, load_lane(hands, j * width, 1, push_like) + push)


@register_jitable(forceinline=True, **COMPILE)
def feel_block(a, at_hands, width, pushes, k, dt, push_like):
    """`feel` for LANES flights, whose table stands in `a` from `at_hands` on, with room for one push of each behind.

    A lane loop is vectorised only if no two arrays may overlap: so all that it reads and writes is in `a`.
    """
    first = k - k % SPAN
    at_push = at_hands + HALVES * width * LANES
    a[at_hands:at_push] = 0.0
    for i in range(pushes.shape[0]):
        pressed = False
        for lane in range(LANES):
            p = load_lane(pushes[i], lane, LANES, GAUSSIAN)
            pressed |= active(p, first * dt, (first + SPAN) * dt)
        if pressed:
            a[at_push : at_push + pushes.shape[1]] = pushes[i]
            for j in range(HALVES):
                t = (2 * first + j) * (0.5 * dt)
                at = at_hands + j * width * LANES
                for lane in range(LANES):
                    push = push_of(push_like, load_lane(a, at_push + lane, LANES, GAUSSIAN), t)
                    store_lane(a, at + lane, LANES, load_lane(a, at + lane, LANES, push_like) + push)


class Kernels:
    """The compiled loops for flights like `flying` under pushes like `push`; each compiles when first asked for.

    Arrays that the loops share: `pushes` (count × 8·lanes) holds the numbers of each `Gaussian`; `hands` is scratch for
    the table of pushes, HALVES rows of the numbers of a push, of which any three in a row are a `Hand`; `last` receives
    the sample at the end.
    """

    def __init__(self, flying: Flying, push: Any) -> None:
        install()
        self.like = zeroed(flying)
        self.push = zeroed(push)
        self.hand = Hand(self.push, self.push, self.push)

    @property
    def folder(self) -> Path:
        """Where these loops are kept once compiled."""
        return folder((self.like, self.push))

    def _compile(self, function: Callable[..., Any]) -> Callable[..., Any]:
        with cached_in(self.folder):
            return numba.njit(cache=True, nogil=True, **COMPILE)(function)

    @cached_property
    def single(self) -> Callable[..., Any]:
        """single(a, pushes, hands, log, last, k, stop, steps, every, dt) -> the step reached.

        Flies steps k to stop − 1 of `steps`, in `a`; log[k // every] is a logged sample. Step number `steps` only
        takes the sample `last`. Returns early when the state is no longer sound.
        """
        like, push_like, hand_like = self.like, self.push, self.hand
        width = leaves(push_like)

        def single(a, pushes, hands, log, last, k, stop, steps, every, dt):
            flying = load(a, like)
            feel(hands, pushes, k, dt, push_like)
            while k < stop and flying.moving.lost == 0.0:
                if k % SPAN == 0:
                    feel(hands, pushes, k, dt, push_like)
                moving, sample = move(flying, load_lane(hands, 2 * (k % SPAN) * width, 1, hand_like), k * dt, dt)
                if k % every == 0:
                    store(log[k // every], sample)
                if k == steps:
                    store(last, sample)
                    break
                flying = Flying(moving, flying.pilot, flying.plant)
                k += 1
            store(a, flying.moving)
            return k

        return self._compile(single)

    @property
    def block_parts(self) -> tuple[int, int, int]:
        """Where in a block's array the table of pushes and the sample begin, and its size."""
        at_hands = leaves(self.like) * LANES
        at_sample = at_hands + (HALVES * leaves(self.push) + leaves(GAUSSIAN)) * LANES
        return at_hands, at_sample, at_sample + leaves(blank_sample(len(self.like.plant.effect.thrust))) * LANES

    @cached_property
    def block(self) -> Callable[..., Any]:
        """block(a, pushes, log, k, stop, steps, every, dt): LANES flights, else as `single`.

        `a` holds, interleaved by lanes, the numbers of a `Flying`, the table of pushes, one push and a Sample. Step
        number `steps` takes the last sample and leaves the flights as they were; log[lane] receives the logged
        samples. The numbers of a lane with `lost` = 1 are void.
        """
        like, push_like, hand_like = self.like, self.push, self.hand
        at_hands, at_sample, _ = self.block_parts
        width, moving_size = leaves(push_like), leaves(like.moving) * LANES

        def block(a, pushes, log, k, stop, steps, every, dt):
            feel_block(a, at_hands, width, pushes, k, dt, push_like)
            kept = a[:moving_size]
            while k < stop:
                if k % SPAN == 0:
                    feel_block(a, at_hands, width, pushes, k, dt, push_like)
                at_hand = at_hands + 2 * (k % SPAN) * width * LANES
                if k == steps:
                    kept = a[:moving_size].copy()
                logged = k % every == 0
                if logged or k == steps:
                    for lane in range(LANES):
                        flying = load_lane(a, lane, LANES, like)
                        moving, sample = move(flying, load_lane(a, at_hand + lane, LANES, hand_like), k * dt, dt)
                        store_lane(a, lane, LANES, moving)
                        store_lane(a, at_sample + lane, LANES, sample)
                else:
                    for lane in range(LANES):
                        flying = load_lane(a, lane, LANES, like)
                        moving, _ = move(flying, load_lane(a, at_hand + lane, LANES, hand_like), k * dt, dt)
                        store_lane(a, lane, LANES, moving)
                if logged:
                    for lane in range(LANES):
                        for i in range(log.shape[2]):
                            log[lane, k // every, i] = a[at_sample + i * LANES + lane]
                if k == steps:
                    a[:moving_size] = kept
                k += 1

        return self._compile(block)

    @cached_property
    def before(self) -> Callable[..., Any]:
        """before(a, pushes, hands, x, k, dt): write to x what an interpreted controller is given at step k."""
        like, push_like, hand_like = self.like, self.push, self.hand
        width = leaves(push_like)

        def before(a, pushes, hands, x, k, dt):
            flying = load(a, like)
            if k % SPAN == 0:
                feel(hands, pushes, k, dt, push_like)
            push = load_lane(hands, 2 * (k % SPAN) * width, 1, hand_like).start.force
            guidance = guide(flying.pilot, flying.moving.memory.yielding, push, k * dt)
            store(x, Given(Measured(flying.moving.state, push), guidance.reference))

        return self._compile(before)

    @cached_property
    def after(self) -> Callable[..., Any]:
        """after(a, hands, y, row, k, dt, final): the rest of step k with the Command in y; its sample goes to row.

        If `final`, only the sample is taken.
        """
        like, hand_like, width = self.like, self.hand, leaves(self.push)

        def after(a, hands, y, row, k, dt, final):
            flying = load(a, like)
            memory = flying.moving.memory
            hand = load_lane(hands, 2 * (k % SPAN) * width, 1, hand_like)
            guidance = guide(flying.pilot, memory.yielding, hand.start.force, k * dt)
            command = load(y, COMMAND)
            decision, memory = conclude(flying.pilot, memory.yielding, guidance, command, memory.controller, dt)
            moving, sample = commit(flying, decision, memory, hand, dt)
            store(row, sample)
            if not final:
                store(a, moving)

        return self._compile(after)
