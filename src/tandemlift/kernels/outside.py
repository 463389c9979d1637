"""What a flight is given from outside at each step, formed ahead of it or beside it: pushes, gusts, chance, walls.

Pushes and gusts depend on time alone. The force of the person is evaluated SPAN steps ahead at every half step, so that
a push that is over costs nothing and their number is data. Standard normals are formed for as many steps, in a loop
over them that is vectorised. For a block of flights the same is formed lane by lane in the block's own array: a lane
loop is vectorised only if all that it reads and writes is in one array.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numba.extending import register_jitable

from tandemlift.jit import leaves, load, load_lane, store_lane
from tandemlift.laws.partner import LEG, on_leg
from tandemlift.laws.push import SUPPORT, Gaussian, push_of
from tandemlift.laws.random import normals
from tandemlift.laws.rectangle import WALL
from tandemlift.laws.walls import consider
from tandemlift.laws.wind import Gust, gust_velocity
from tandemlift.vector import ZERO

LANES = 8
SPAN = 16  # steps
HALVES = 2 * SPAN + 1
GAUSSIAN = Gaussian(ZERO, 0.0, 0.0, ZERO)
GUST = Gust(ZERO, 0.0, 0.0, 0.0)

COMPILE: dict[str, Any] = {"error_model": "numpy", "fastmath": False}
inlined = register_jitable(forceinline=True, **COMPILE)


class Tables(NamedTuple):
    """Data of any number: an array each of pushes, gusts, walls and legs of a person's path, a row each."""

    pushes: Any
    gusts: Any
    walls: Any
    legs: Any


def draws(noise: Any) -> int:
    """How many draws of four standard normals fill a value like `noise`."""
    return -(-leaves(noise) // 4)


@inlined
def active(p, opens, closes):
    """Whether a push is other than zero somewhere between two times [s]."""
    around = SUPPORT / p.per_sigma
    return (p.time + around > opens) & (p.time - around < closes)


@inlined
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


@inlined
def feel_block(a, at_hands, at_row, width, pushes, k, dt, push_like):
    """`feel` for LANES flights, whose table stands in `a` from `at_hands` on, with room for one push of each."""
    first = k - k % SPAN
    a[at_hands : at_hands + HALVES * width * LANES] = 0.0
    for i in range(pushes.shape[0]):
        pressed = False
        for lane in range(LANES):
            p = load_lane(pushes[i], lane, LANES, GAUSSIAN)
            pressed |= active(p, first * dt, (first + SPAN) * dt)
        if pressed:
            a[at_row : at_row + pushes.shape[1]] = pushes[i]
            for j in range(HALVES):
                t = (2 * first + j) * (0.5 * dt)
                at = at_hands + j * width * LANES
                for lane in range(LANES):
                    push = push_of(push_like, load_lane(a, at_row + lane, LANES, GAUSSIAN), t)
                    store_lane(a, at + lane, LANES, load_lane(a, at + lane, LANES, push_like) + push)


@inlined
def gusting(gusts, t):
    """The velocity of all gusts together at time t [s]."""
    velocity = ZERO
    for i in range(gusts.shape[0]):
        velocity = velocity + gust_velocity(load(gusts[i], GUST), t)
    return velocity


@inlined
def gusting_block(a, at_gust, at_row, gusts, t):
    """`gusting` for LANES flights, into `a` from `at_gust` on."""
    a[at_gust : at_gust + 3 * LANES] = 0.0
    for i in range(gusts.shape[0]):
        a[at_row : at_row + gusts.shape[1]] = gusts[i]
        for lane in range(LANES):
            velocity = gust_velocity(load_lane(a, at_row + lane, LANES, GUST), t)
            store_lane(a, at_gust + lane, LANES, load_lane(a, at_gust + lane, LANES, ZERO) + velocity)


@inlined
def draw(table, k, key0, key1):
    """Fill a table of standard normals, four rows a draw and a column a step, for the SPAN steps that hold step k."""
    first = k - k % SPAN
    for group in range(table.size // (4 * SPAN)):
        for j in range(SPAN):
            store_lane(table, 4 * group * SPAN + j, SPAN, normals(first + j, group, key0, key1))


@inlined
def draw_block(a, at_noise, groups, at_keys, k):
    """Standard normals of step k for LANES flights, into `a` from `at_noise` on, whose keys stand at `at_keys`."""
    for group in range(groups):
        for lane in range(LANES):
            four = normals(k, group, a[at_keys + lane], a[at_keys + LANES + lane])
            store_lane(a, at_noise + 4 * group * LANES + lane, LANES, four)


@inlined
def approach(walls, plant, state, nowhere):
    """The walls nearest to the parts of the vehicle."""
    near = nowhere
    for i in range(walls.shape[0]):
        near = consider(plant.walls, load(walls[i], WALL), near, plant.frame, state)
    return near


@inlined
def approach_block(a, at_near, at_row, walls, like, nowhere):
    """`approach` for LANES flights, into `a` from `at_near` on."""
    for lane in range(LANES):
        store_lane(a, at_near + lane, LANES, nowhere)
    for i in range(walls.shape[0]):
        a[at_row : at_row + walls.shape[1]] = walls[i]
        for lane in range(LANES):
            flying, wall = load_lane(a, lane, LANES, like), load_lane(a, at_row + lane, LANES, WALL)
            moving, plant = flying.moving, flying.plant
            store_lane(a, at_near + lane, LANES, consider(plant.walls, wall, moving.near, plant.frame, moving.state))


@inlined
def guided(legs, partner):
    """A person's memory with the leg of the path that they are on."""
    return on_leg(partner, load(legs[min(max(int(partner.index), 0), legs.shape[0] - 1)], LEG))


@inlined
def guided_block(a, at_partner, legs, like):
    """`guided` for LANES flights, whose persons' memory stands in `a` from `at_partner` on."""
    for lane in range(LANES):
        partner = load_lane(a, at_partner + lane, LANES, like)
        row = legs[min(max(int(partner.index), 0), legs.shape[0] - 1)]
        store_lane(a, at_partner + lane, LANES, on_leg(partner, load_lane(row, lane, LANES, LEG)))
