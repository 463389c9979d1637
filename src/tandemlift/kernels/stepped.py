"""The parts of one step, for a controller in plain Python or a body in another engine."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from tandemlift.jit import Layout, leaves, load, load_lane, store
from tandemlift.kernels.likes import Likes
from tandemlift.kernels.limiting import limit_thought
from tandemlift.kernels.outside import HALVES, SPAN, approach, draw, draws, feel, guided, gusting
from tandemlift.kernels.places import Stretches, carry
from tandemlift.laws.admittance import Trajectory
from tandemlift.laws.body import State, Wrench
from tandemlift.laws.controllers import Command, Measured, Reference
from tandemlift.laws.push import moment_of
from tandemlift.loop import Inputs, Thought, act, joined, located, observe, perceive, swing, think
from tandemlift.pilot import brief, conclude
from tandemlift.vector import ZERO, Quat

COMMAND = Command(Wrench(0.0, ZERO), ZERO)
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)


class Given(NamedTuple):
    """What a controller is given at a sample."""

    measured: Measured
    reference: Reference


GIVEN = Given(Measured(State(ZERO, ZERO, LEVEL, ZERO), ZERO), Reference(Trajectory(ZERO, ZERO, ZERO), 0.0))


class Pushing(NamedTuple):
    """The push over a step: its mean force [N, world axes] and moment about the centre of mass [N·m, body axes]."""

    force: Any
    moment: Any


class Parts(NamedTuple):
    """The compiled parts of a step, in the order in which they are called."""

    outside: Callable[..., Any]
    before: Callable[..., Any]
    after: Callable[..., Any]
    whole: Callable[..., Any]
    acting: Callable[..., Any]
    moved: Callable[..., Any]
    observed: Callable[..., Any]


def parts_of(likes: Likes, lines: Stretches) -> Parts:
    """The parts of a step, to be compiled.

    They hand values on in flat arrays: `a` the flight, `g` what it is given, `m` what the pilot thinks, `c` what acts
    on the body, `w` the push as a force and a moment, `v` how it moved, `row` the sample; `x` and `y` what a controller
    is given and answers.
    """
    like, given_like, thought_like, acting_like, moved_like, _ = map(Layout, likes[:-1])
    given, nowhere, push_like = likes.given, likes.nowhere, likes.given.hand.start
    hand_like, noise_like, width = Layout(given.hand), Layout(given.noise), leaves(push_like)
    n_hands = HALVES * width
    n_work = n_hands + 4 * SPAN * draws(given.noise)
    walled, late, constrained, accompanied = likes.walled, likes.late, likes.constrained, likes.accompanied
    at = lines.numbers(1)

    def outside(a, tables, work, seeds, g, k, dt):
        hands, table = work[:n_hands], work[n_hands:n_work]
        if k % SPAN == 0:
            feel(hands, tables.pushes, k, dt, push_like)
            draw(table, k, seeds[0], seeds[1])
            flying = load(a, like)
            near, partner = flying.moving.near, flying.moving.partner
            if walled:
                near = approach(tables.walls, flying.plant, flying.moving.state, nowhere)
            if accompanied:
                partner = guided(tables.legs, partner)
            store(a, located(flying.moving, near, partner))
        hand, noise = (
            load_lane(hands, 2 * (k % SPAN) * width, 1, hand_like),
            load_lane(table, k % SPAN, SPAN, noise_like),
        )
        flying = load(a, like)
        outer = Inputs(hand, gusting(tables.gusts, k * dt), noise, flying.moving.partner)
        store(g, joined(flying, outer, k * dt, dt))

    def before(a, g, x, k, dt):
        flying, given, t = load(a, like), load(g, given_like), k * dt
        _, heard, _ = perceive(flying, given.hand.start, t, dt)
        briefed = brief(flying.pilot, flying.moving.memory, heard, t, dt)
        store(x, Given(briefed.measured, briefed.guidance.reference))

    def after(a, g, y, m, scratch, k, dt):
        flying, given, t = load(a, like), load(g, given_like), k * dt
        known, heard, estimator = perceive(flying, given.hand.start, t, dt)
        memory = flying.moving.memory
        briefed = brief(flying.pilot, memory, heard, t, dt)
        decision, memory = conclude(flying.pilot, memory, briefed, load(y, COMMAND), memory.controller)
        thought = Thought(known, heard.state.attitude, decision, memory, estimator)
        if constrained:
            thought = limit_thought(scratch, flying, thought, t)
        store(m, thought)

    def whole(a, g, m, scratch, k, dt):
        flying, given = load(a, like), load(g, given_like)
        thought = think(flying, given.hand.start, k * dt, dt)
        if constrained:
            thought = limit_thought(scratch, flying, thought, k * dt)
        store(m, thought)

    def acting(a, g, m, c, w, k, dt):
        flying, given = load(a, like), load(g, given_like)
        store(c, act(flying, load(m, thought_like).decision.thrusts, given, k * dt))
        hand = given.hand
        mean = (hand.start + hand.middle * 4.0 + hand.end) * (1.0 / 6.0)
        store(w, Pushing(mean.force, moment_of(mean, flying.moving.state.attitude)))

    def moved(a, g, c, v, k, dt):
        flying = load(a, like)
        store(v, swing(flying.plant, flying.moving, load(c, acting_like), load(g, given_like).hand, dt))

    def observed(a, ring, delays, g, m, c, v, row, k, final):
        flying, given = load(a, like), load(g, given_like)
        thought, on_body = load(m, thought_like), load(c, acting_like)
        moving, sample = observe(flying, thought, on_body, load(v, moved_like), given)
        store(row, sample)
        if not final:
            store(a, moving)
            if late:
                carry(a, ring, delays, k, at)

    return Parts(outside, before, after, whole, acting, moved, observed)
