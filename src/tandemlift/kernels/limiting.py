"""Thrusts within limits inside the compiled loops: the solver of `laws.limits`, for pilots whose thrusts leave them.

Each flight is looked at alone, as the solver's branches differ from flight to flight.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numba.extending import register_jitable

from tandemlift.jit import load, load_lane, store, store_lane
from tandemlift.kernels.outside import COMPILE, LANES, inlined
from tandemlift.laws.allocation import Working, beyond, commanded, limits_at
from tandemlift.laws.limits import COMPILED, limited
from tandemlift.loop import Thought
from tandemlift.pilot import Decision, PilotMemory
from tandemlift.vector import total

GAMMA = 1e-3  # of thrusts away from the pseudo-inverse's, against the weighted wrench

for _function in COMPILED:
    register_jitable(**COMPILE)(_function)


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
    limited(rows, s[4 * n : 4 * n + 4], wanted, u, limits, GAMMA, active, f, work, 4 * n)


@inlined
def settle(s, flying, thought, t):
    """The pilot's commands within limits; `s`: scratch."""
    how, wished = flying.pilot.allocation, thought.decision.thrusts
    n, limits = len(wished), limits_at(how, t)
    if total(beyond(wished, limits)) > 0.0:
        at, held = 4 * n + 8, flying.moving.memory.allocation
        store(s, how.rows)
        store(s[4 * n :], how.weights)
        store(s[4 * n + 4 :], thought.decision.command.wrench)
        store(s[at:], wished)
        store(s[at + n :], limits)
        store(s[at + 2 * n :], held)
        _solve(s, n)
        memory = load(s[at + 2 * n :], held)
    else:
        memory = Working(wished * 0.0, wished)
    return Settled(commanded(how, memory.thrusts, t), memory)


@inlined
def limit(s, flying, thought, t):
    """What a pilot thinks, its commands kept within limits."""
    settled = settle(s, flying, thought, t)
    decision, m = thought.decision, thought.memory
    return Thought(
        thought.known,
        thought.measured,
        Decision(decision.guidance, decision.command, settled.commands),
        PilotMemory(m.yielding, m.controller, settled.memory),
        thought.estimator,
    )


@inlined
def limit_lanes(a, s, at_thought, at_commands, at_memory, like, thought_like, t):
    """`limit` for LANES flights, whose thoughts stand in `a` from `at_thought` on."""
    for lane in range(LANES):
        flying = load_lane(a, lane, LANES, like)
        settled = settle(s, flying, load_lane(a, at_thought + lane, LANES, thought_like), t)
        store_lane(a, at_thought + at_commands + lane, LANES, settled.commands)
        store_lane(a, at_thought + at_memory + lane, LANES, settled.memory)
