"""The loop over the steps of a block of flights, interleaved so that each instruction serves all of them.

A lane loop is vectorised only if all that it reads and writes is in one array, at places that do not depend on data. So
everything of a block is in the array `a`: the flights, and regions for what they are given and what they show.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from tandemlift.jit import leaves, load_lane, store_lane
from tandemlift.kernels.likes import Likes
from tandemlift.kernels.limiting import limit_lanes, scratch_size
from tandemlift.kernels.outside import (
    GAUSSIAN,
    GUST,
    HALVES,
    LANES,
    SPAN,
    WALL,
    approach_block,
    draw_block,
    draws,
    feel_block,
    gusting_block,
    inlined,
)
from tandemlift.kernels.places import Lines, carry, place
from tandemlift.loop import Inputs, finish, move, think
from tandemlift.vector import ZERO


class Regions(NamedTuple):
    """Where the parts of a block's array begin, behind the flights, and its size.

    The table of pushes, one row of any table, the gusts' velocity, standard normals, the keys of chance, the nearest
    walls, what the pilots think, the samples; scratch for one flight.
    """

    hands: int
    row: int
    gust: int
    noise: int
    keys: int
    near: int
    thought: int
    sample: int
    scratch: int
    size: int

    @classmethod
    def of(cls, likes: Likes) -> Regions:
        """The regions of a block of flights."""
        given = likes.given
        widths = [
            leaves(likes.flying),
            HALVES * leaves(given.hand.start),
            max(map(leaves, (GAUSSIAN, GUST, WALL))),
            leaves(ZERO),
            4 * draws(given.noise),
            2,
            leaves(given.near),
            leaves(likes.thought) if likes.constrained else 0,
            leaves(likes.sample),
        ]
        starts = [sum(widths[: i + 1]) * LANES for i in range(len(widths))]
        rotors = leaves(likes.thought.decision.thrusts) if likes.constrained else 0
        return cls(*starts, starts[-1] + scratch_size(rotors))


@inlined
def given_to(a, lane, at_hand, r, given_like):
    """What a lane is given."""
    return Inputs(
        load_lane(a, at_hand + lane, LANES, given_like.hand),
        load_lane(a, r.gust + lane, LANES, ZERO),
        load_lane(a, r.noise + lane, LANES, given_like.noise),
        load_lane(a, r.near + lane, LANES, given_like.near),
    )


@inlined
def whole_step(a, lane, at_hand, r, like, given_like, thought_like, t, dt):
    """A lane's step."""
    return move(load_lane(a, lane, LANES, like), given_to(a, lane, at_hand, r, given_like), t, dt)


@inlined
def rest_of_step(a, lane, at_hand, r, like, given_like, thought_like, t, dt):
    """A lane's step once its pilot has thought."""
    thought = load_lane(a, r.thought + lane, LANES, thought_like)
    return finish(load_lane(a, lane, LANES, like), thought, given_to(a, lane, at_hand, r, given_like), t, dt)


@inlined
def think_within_limits(a, at_hand, r, at_limits, like, given_like, thought_like, t, dt):
    """The pilots of all lanes think; a lane whose thrusts leave the limits is solved for alone."""
    for lane in range(LANES):
        push = load_lane(a, at_hand + lane, LANES, given_like.hand).start.force
        store_lane(a, r.thought + lane, LANES, think(load_lane(a, lane, LANES, like), push, t, dt))
    limit_lanes(a, a[r.scratch :], r.thought, at_limits[0], at_limits[1], like, thought_like, t)


def block_loop(likes: Likes, lines: Lines, regions: Regions) -> Callable[..., Any]:
    """block(a, tables, ring, delays, log, k, stop, steps, every, dt): LANES flights, else as `single_loop`.

    Step number `steps` takes the last sample and leaves the flights as they were; log[lane] receives the logged
    samples. The numbers of a lane with `lost` = 1 are void. `delays` are the same for all lanes.
    """
    like, given_like, thought_like, push_like = likes.flying, likes.given, likes.thought, likes.given.hand.start
    width, moving_size, groups = leaves(push_like), leaves(like.moving) * LANES, draws(given_like.noise)
    walled, late, constrained = likes.walled, likes.late, likes.constrained
    at_limits = (
        place(likes.thought, "decision", "thrusts").at * LANES,
        place(likes.thought, "memory", "allocation").at * LANES,
    )
    step = rest_of_step if constrained else whole_step
    r, at = regions, lines.numbers(LANES)

    def block(a, tables, ring, delays, log, k, stop, steps, every, dt):
        feel_block(a, r.hands, r.row, width, tables.pushes, k, dt, push_like)
        kept = a[:moving_size]
        while k < stop:
            t = k * dt
            if k % SPAN == 0:
                feel_block(a, r.hands, r.row, width, tables.pushes, k, dt, push_like)
            draw_block(a, r.noise, groups, r.keys, k)
            gusting_block(a, r.gust, r.row, tables.gusts, t)
            if walled:
                approach_block(a, r.near, r.row, tables.walls, like, given_like.near)
            at_hand = r.hands + 2 * (k % SPAN) * width * LANES
            if k == steps:
                kept = a[:moving_size].copy()
            if constrained:
                think_within_limits(a, at_hand, r, at_limits, like, given_like, thought_like, t, dt)
            logged = k % every == 0
            if logged or k == steps:
                for lane in range(LANES):
                    moving, sample = step(a, lane, at_hand, r, like, given_like, thought_like, t, dt)
                    store_lane(a, lane, LANES, moving)
                    store_lane(a, r.sample + lane, LANES, sample)
            else:
                for lane in range(LANES):
                    moving, _ = step(a, lane, at_hand, r, like, given_like, thought_like, t, dt)
                    store_lane(a, lane, LANES, moving)
            if logged:
                for lane in range(LANES):
                    for i in range(log.shape[2]):
                        log[lane, k // every, i] = a[r.sample + i * LANES + lane]
            if k == steps:
                a[:moving_size] = kept
            elif late:
                carry(a, ring, delays, k, at)
            k += 1

    return block
