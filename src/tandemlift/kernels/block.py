"""The loop over the steps of a block of flights, interleaved so that each instruction serves all of them.

A lane loop is vectorised only if all that it reads and writes is in one array, at places that do not depend on data. So
everything of a block is in the array `a`: the flights, and regions for what they are given and what they show.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from tandemlift.jit import Layout, leaves, load_lane, store_lane
from tandemlift.kernels.likes import Likes
from tandemlift.kernels.limiting import Excess, Lost, as_wished, excess_of, limit_lanes, outside, scratch_size
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
    guided_block,
    gusting_block,
    inlined,
)
from tandemlift.kernels.places import Stretches, carry, place
from tandemlift.law import choice
from tandemlift.laws.contact import may_touch
from tandemlift.loop import Flying, Inputs, Thought, finish, joined, lifted_off, think
from tandemlift.vector import ZERO, Nothing


class Regions(NamedTuple):
    """Where the parts of a block's array begin, behind the flights, and its size.

    The table of pushes, one row of any table, the gusts' velocity, standard normals, the keys of chance, what the
    pilots think, what leaves their limits, the samples; scratch for one flight.
    """

    hands: int
    row: int
    gust: int
    noise: int
    keys: int
    thought: int
    excess: int
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
            leaves(likes.thought) if likes.constrained else 0,
            leaves(excess_of(likes.thought)) if likes.constrained else 0,
            leaves(likes.sample),
        ]
        starts = [sum(widths[: i + 1]) * LANES for i in range(len(widths))]
        rotors = leaves(likes.thought.decision.thrusts) if likes.constrained else 0
        return cls._make([*starts, starts[-1] + scratch_size(rotors)])


class Layouts(NamedTuple):
    """Layouts of the values in a block's array."""

    flying: Any
    hand: Any
    noise: Any
    thought: Any
    excess: Any


@inlined
def given_to(a, lane, flying, at_hand, r, x, t, dt):
    """What a lane is given; `x`: layouts."""
    hand, noise = load_lane(a, at_hand + lane, LANES, x.hand), load_lane(a, r.noise + lane, LANES, x.noise)
    outer = Inputs(hand, load_lane(a, r.gust + lane, LANES, ZERO), noise, flying.moving.partner)
    return joined(flying, outer, t, dt)


class Low(NamedTuple):
    """Marks steps in which feet may touch the floor, or without one."""


class High(NamedTuple):
    """Marks steps in which no lane's feet can."""


@choice
def stepping(where: Any, flying: Flying, thought: Any, given: Inputs, t: Any, dt: Any) -> Any:
    """A lane's step, once its pilot has thought if it does so apart: (Moving, Sample)."""


@stepping.register(Low)
def _near_the_floor(where, flying, thought, given, t, dt):
    return finish(flying, thinking(thought, flying, given.hand.start, t, dt), given, t, dt)


@stepping.register(High)
def _in_the_air(where, flying, thought, given, t, dt):
    return finish(lifted_off(flying), thinking(thought, flying, given.hand.start, t, dt), given, t, dt)


@choice
def thinking(thought: Any, flying: Flying, push: Any, t: Any, dt: Any) -> Any:
    """What a pilot has thought, or thinks now if it has not."""


@thinking.register(Thought)
def _has_thought(thought, flying, push, t, dt):
    return thought


@thinking.register(Nothing)
def _thinks_now(thought, flying, push, t, dt):
    return think(flying, push, t, dt)


LOW, HIGH = Low(), High()


@inlined
def fly_lanes(a, where, at_hand, r, x, t, dt, shown):
    """A step of all lanes; their samples too, if shown. `x`: layouts."""
    if shown:
        for lane in range(LANES):
            flying = load_lane(a, lane, LANES, x.flying)
            given = given_to(a, lane, flying, at_hand, r, x, t, dt)
            thought = load_lane(a, r.thought + lane, LANES, x.thought)
            moving, sample = stepping(where, flying, thought, given, t, dt)
            store_lane(a, lane, LANES, moving)
            store_lane(a, r.sample + lane, LANES, sample)
    else:
        for lane in range(LANES):
            flying = load_lane(a, lane, LANES, x.flying)
            given = given_to(a, lane, flying, at_hand, r, x, t, dt)
            thought = load_lane(a, r.thought + lane, LANES, x.thought)
            moving, _ = stepping(where, flying, thought, given, t, dt)
            store_lane(a, lane, LANES, moving)


@inlined
def any_low(a, like, time):
    """Whether any lane's feet may touch the floor within a time [s]."""
    low = False
    for lane in range(LANES):
        flying = load_lane(a, lane, LANES, like)
        low |= may_touch(flying.plant.floor, flying.moving.state, time)
    return low


@inlined
def think_within_limits(a, at_hand, r, at_limits, x, t, dt):
    """The pilots of all lanes think; a lane whose thrusts leave the limits is solved for alone."""
    for lane in range(LANES):
        flying = load_lane(a, lane, LANES, x.flying)
        given = given_to(a, lane, flying, at_hand, r, x, t, dt)
        thought = think(flying, given.hand.start, t, dt)
        how, decision = flying.pilot.allocation, thought.decision
        lost = Lost(flying.pilot.detection, flying.moving.memory.detection)
        settled = as_wished(how, lost, decision.thrusts, t)
        store_lane(a, r.thought + lane, LANES, thought)
        store_lane(a, r.thought + at_limits[0] + lane, LANES, settled.commands)
        store_lane(a, r.thought + at_limits[1] + lane, LANES, settled.memory)
        excess = Excess(outside(how, lost, decision.thrusts, t), decision.command.wrench, decision.thrusts)
        store_lane(a, r.excess + lane, LANES, excess)
    commands, memory = r.thought + at_limits[0], r.thought + at_limits[1]
    limit_lanes(a, a[r.scratch :], r.excess, commands, memory, x.flying, x.excess, t)


def block_loop(likes: Likes, lines: Stretches, regions: Regions) -> Callable[..., Any]:
    """block(a, tables, ring, delays, log, k, stop, steps, every, dt): LANES flights, else as `single_loop`.

    Step number `steps` takes the last sample and leaves the flights as they were; log[lane] receives the logged
    samples. The numbers of a lane with `lost` = 1 are void. `delays` are the same for all lanes.
    """
    push_like, nowhere, thought = likes.given.hand.start, likes.nowhere, likes.thought
    like = Layout(likes.flying)
    x = Layouts(
        flying=like,
        hand=Layout(likes.given.hand),
        noise=Layout(likes.given.noise),
        thought=Layout(thought if likes.constrained else Nothing()),
        excess=Layout(excess_of(thought)),
    )
    at_near = place(likes.flying, "moving", "near").at * LANES
    width, moving_size, groups = leaves(push_like), leaves(likes.flying.moving) * LANES, draws(likes.given.noise)
    walled, late, constrained = likes.walled, likes.late, likes.constrained
    at_limits = (
        place(likes.thought, "decision", "thrusts").at * LANES,
        place(likes.thought, "memory", "allocation").at * LANES,
    )
    grounded, accompanied = likes.grounded, likes.accompanied
    at_partner = place(likes.flying, "moving", "partner").at * LANES
    partner_like = Layout(likes.flying.moving.partner)
    r, at = regions, lines.numbers(LANES)

    def block(a, tables, ring, delays, log, k, stop, steps, every, dt):
        feel_block(a, r.hands, r.row, width, tables.pushes, k, dt, push_like)
        kept, low = a[:moving_size], True
        while k < stop:
            t = k * dt
            if k % SPAN == 0:
                feel_block(a, r.hands, r.row, width, tables.pushes, k, dt, push_like)
                if grounded:
                    low = any_low(a, like, SPAN * dt)
                if walled:
                    approach_block(a, at_near, r.row, tables.walls, like, nowhere)
                if accompanied:
                    guided_block(a, at_partner, tables.legs, partner_like)
            draw_block(a, r.noise, groups, r.keys, k)
            gusting_block(a, r.gust, r.row, tables.gusts, t)
            at_hand = r.hands + 2 * (k % SPAN) * width * LANES
            if k == steps:
                kept = a[:moving_size].copy()
            if constrained:
                think_within_limits(a, at_hand, r, at_limits, x, t, dt)
            logged = k % every == 0
            if grounded and not low:
                fly_lanes(a, HIGH, at_hand, r, x, t, dt, logged or k == steps)
            else:
                fly_lanes(a, LOW, at_hand, r, x, t, dt, logged or k == steps)
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
