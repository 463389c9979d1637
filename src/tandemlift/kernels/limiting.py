"""Thrusts within limits inside the compiled loops: the solver of `laws.limits`, for pilots whose thrusts leave them.

Each flight is looked at alone, as the solver's branches differ from flight to flight.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numba.extending import register_jitable

from tandemlift.jit import load, load_lane, store, store_lane
from tandemlift.kernels.outside import COMPILE, LANES, inlined
from tandemlift.laws.allocation import Working, beyond, commanded, limits_at
from tandemlift.laws.detection import left_of, with_trials
from tandemlift.laws.limits import PARTS, limited
from tandemlift.loop import Thought
from tandemlift.pilot import with_allocation, with_thrusts
from tandemlift.vector import total

GAMMA = 1e-3  # of thrusts away from the pseudo-inverse's, against the weighted wrench

for _part in PARTS:
    register_jitable(forceinline=True, **COMPILE)(_part)
register_jitable(**COMPILE)(limited)


class Lost(NamedTuple):
    """How lost rotors are detected, and the memory of it."""

    detection: Any
    memory: Any


class Settled(NamedTuple):
    """Commands within limits [N], and the memory of the allocation."""

    commands: Any
    memory: Working


def scratch_size(rotors: int) -> int:
    """Numbers of scratch that `settle` needs."""
    return 9 * rotors + 8


@register_jitable(**COMPILE)
def _solve(s, n):
    """Solve in scratch: rows (4n), weights (4), wanted (4), unlimited, limits, active, thrusts, work (n each)."""
    rows, at = s[: 4 * n].reshape((4, n)), 4 * n + 8
    u, limits, active, f, work = (
        s[at : at + n],
        s[at + n : at + 2 * n],
        s[at + 2 * n : at + 3 * n],
        s[at + 3 * n : at + 4 * n],
        s[at + 4 * n : at + 5 * n],
    )
    wanted = (s[4 * n + 4], s[4 * n + 5], s[4 * n + 6], s[4 * n + 7])
    limited(rows, s[4 * n : 4 * n + 4], wanted, u, limits, GAMMA, active, f, work, 8 * n)


@inlined
def commands_for(how, lost, thrusts, t):
    """Commands that make the rotors give thrusts within limits."""
    return with_trials(lost.detection, lost.memory, commanded(how, thrusts, t), t)


@inlined
def as_wished(how, lost, wished, t):
    """Commands for thrusts that are within limits."""
    return Settled(commands_for(how, lost, wished, t), Working(wished * 0.0, wished))


@inlined
def outside(how, lost, wished, t):
    """Above 0 if a thrust is outside its limits."""
    return total(beyond(wished, limits_at(how, left_of(lost.detection, lost.memory), t)))


@inlined
def settle(s, how, lost, held, wrench, wished, t):
    """Commands within limits for thrusts that are not; `s`: scratch, `held`: the memory."""
    n = len(wished)
    at = 4 * n + 8
    store(s, how.rows)
    store(s[4 * n :], how.weights)
    store(s[4 * n + 4 :], wrench)
    store(s[at:], wished)
    store(s[at + n :], limits_at(how, left_of(lost.detection, lost.memory), t))
    store(s[at + 2 * n :], held)
    _solve(s, n)
    memory = load(s[at + 2 * n :], held)
    return Settled(commands_for(how, lost, memory.thrusts, t), memory)


@inlined
def within(s, how, lost, held, wrench, wished, t):
    """Commands within limits for any thrusts."""
    settled = as_wished(how, lost, wished, t)
    if outside(how, lost, wished, t) > 0.0:
        settled = settle(s, how, lost, held, wrench, wished, t)
    return settled


@inlined
def limit(s, pilot, held, decision, memory, t):
    """(Decision, memory) of a pilot, its commands kept within limits; `held`: its memory before."""
    lost = Lost(pilot.detection, held.detection)
    settled = within(s, pilot.allocation, lost, held.allocation, decision.command.wrench, decision.thrusts, t)
    return with_thrusts(decision, settled.commands), with_allocation(memory, settled.memory)


@inlined
def limit_thought(s, flying, thought, t):
    """What a pilot thinks, its commands kept within limits."""
    decision, memory = limit(s, flying.pilot, flying.moving.memory, thought.decision, thought.memory, t)
    return Thought(thought.known, thought.believed, decision, memory, thought.estimator)


class Excess(NamedTuple):
    """Of a lane: above 0 if its thrusts are outside limits, and the wrench and thrusts wished for then."""

    outside: Any
    wrench: Any
    wished: Any


def excess_of(thought: Any) -> Excess:
    """The layout of a lane's excess."""
    return Excess(0.0, thought.decision.command.wrench, thought.decision.thrusts)


@inlined
def limit_lanes(a, s, at_excess, at_commands, at_memory, like, excess_like, t):
    """Solve for those of LANES flights whose thrusts are outside limits: commands and memory in their thoughts."""
    for lane in range(LANES):
        if a[at_excess + lane] > 0.0:
            excess = load_lane(a, at_excess + lane, LANES, excess_like)
            flying = load_lane(a, lane, LANES, like)
            how, held = flying.pilot.allocation, flying.moving.memory
            lost = Lost(flying.pilot.detection, held.detection)
            settled = settle(s, how, lost, held.allocation, excess.wrench, excess.wished, t)
            store_lane(a, at_commands + lane, LANES, settled.commands)
            store_lane(a, at_memory + lane, LANES, settled.memory)
