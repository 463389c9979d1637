"""The loop over the steps of one flight."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tandemlift.delays import Ends, arrived, departing
from tandemlift.engines.compiled import aloft
from tandemlift.jit import Layout, leaves, load, load_lane, store
from tandemlift.kernels.likes import Likes
from tandemlift.kernels.limiting import limit_thought
from tandemlift.kernels.outside import HALVES, SPAN, approach, draw, draws, feel, guided, gusting
from tandemlift.kernels.places import Stretches, carry
from tandemlift.laws.contact import may_touch
from tandemlift.loop import Inputs, act, continued, delayed, joined, located, observe, swing, think


def single_loop(likes: Likes, lines: Stretches) -> Callable[..., Any]:
    """single(a, tables, work, ring, delays, seeds, log, last, k, stop, steps, every, dt) -> the step reached.

    Flies steps k to stop − 1 of `steps`, in `a`; log[k // every] is a logged sample. Step number `steps` only takes the
    sample `last`. Returns early when the state is no longer sound. `tables`: `Tables`; `work`: scratch; `ring`: the
    delay line (rows × numbers delayed); `delays`: of unit, motion and command, in steps; `seeds`: the key of chance.
    """
    given, nowhere, push_like = likes.given, likes.nowhere, likes.given.hand.start
    like, hand_like, noise_like = Layout(likes.flying), Layout(given.hand), Layout(given.noise)
    width = leaves(push_like)
    n_hands = HALVES * width
    n_work = n_hands + 4 * SPAN * draws(given.noise)
    walled, late, constrained, grounded = likes.walled, likes.late, likes.constrained, likes.grounded
    line_like, accompanied = Layout(likes.line), likes.accompanied
    at, n_line = lines.packed(), lines.size

    def single(a, tables, work, ring, delays, seeds, log, last, k, stop, steps, every, dt):
        flying = load(a, like)
        hands, table, scratch = work[:n_hands], work[n_hands:n_work], work[n_work:]
        line = np.empty(n_line)
        feel(hands, tables.pushes, k, dt, push_like)
        draw(table, k, seeds[0], seeds[1])
        low = True
        while k < stop and flying.moving.lost == 0.0:
            if k % SPAN == 0:
                feel(hands, tables.pushes, k, dt, push_like)
                draw(table, k, seeds[0], seeds[1])
                if grounded:
                    low = may_touch(flying.plant.floor, flying.moving.state, SPAN * dt)
                near, partner = flying.moving.near, flying.moving.partner
                if walled:
                    near = approach(tables.walls, flying.plant, flying.moving.state, nowhere)
                if accompanied:
                    partner = guided(tables.legs, partner)
                flying = continued(flying, located(flying.moving, near, partner))
            hand = load_lane(hands, 2 * (k % SPAN) * width, 1, hand_like)
            noise, partner = load_lane(table, k % SPAN, SPAN, noise_like), flying.moving.partner
            given = joined(flying, Inputs(hand, gusting(tables.gusts, k * dt), noise, partner), k * dt, dt)
            thought = think(flying, given.hand.start, k * dt, dt)
            if constrained:
                thought = limit_thought(scratch, flying, thought, k * dt)
            acting = act(flying, thought.decision.thrusts, given, k * dt)
            if grounded and not low:
                moved = swing(aloft(flying.plant), flying.moving, acting, given.hand, dt)
            else:
                moved = swing(flying.plant, flying.moving, acting, given.hand, dt)
            moving, sample = observe(flying, thought, acting, moved, given)
            if k % every == 0:
                store(log[k // every], sample)
            if k == steps:
                store(last, sample)
                break
            if late:
                ends = Ends(moving.rotors, moving.readings, moving.partner)
                store(line, departing(flying.delays, ends))
                carry(line, ring, delays, k, at)
                moving = delayed(moving, arrived(flying.delays, load(line, line_like), ends))
            flying = continued(flying, moving)
            k += 1
        store(a, flying.moving)
        return k

    return single
