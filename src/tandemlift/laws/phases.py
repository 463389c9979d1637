"""The phases of a flight with a person: idle on the ground → lift → guided → land → idle.

Each is entered for a reason and left for a reason; what a phase lets happen are its `Orders`. A law without branches:
every condition is a number, 1 or 0.
"""

from typing import Any, NamedTuple

from tandemlift.law import law
from tandemlift.laws.reference import Ramp, smoothstep
from tandemlift.ops import maximum, minimum, where

IDLE, LIFT, GUIDED, LAND = 0.0, 1.0, 2.0, 3.0
NAMES = ("idle", "lift", "guided", "land")


class Phasing(NamedTuple):
    """What is asked for, and how fast.

    `height` [m] of the lift; when it is asked for, and the landing [s]; rates are 1/duration [1/s]. `press` [m]: how
    far below the ground the landing's reference ends, so that the feet press. `spool` [s] from when the rotors run to
    the lift. `always` is 1 if the rotors run in idle too. `descent` [m/s]: the greatest speed of a landing.
    """

    height: Any
    lift_start: Any
    lift_rate: Any
    land_start: Any
    land_rate: Any
    press: Any
    spool: Any
    always: Any
    descent: Any


class Phase(NamedTuple):
    """Memory: which phase, since when [s]; the ground's height [m], and 1/duration of the landing that is flown."""

    phase: Any
    since: Any
    ground: Any
    land_rate: Any


class Orders(NamedTuple):
    """What the phase lets happen: which it is; 1 or 0 for on the ground, listening to pushes, rotors running.

    `flying`: 1 from when the feet may have left the ground, for observers. Ramps of lift and landing; the landing ends
    at `ground` less the press [m].
    """

    phase: Any
    grounded: Any
    listening: Any
    running: Any
    flying: Any
    lift: Ramp
    land: Ramp
    end: Any


@law
def is_in(m: Phase, phase: Any) -> Any:
    """1 in a phase, else 0."""
    return where(m.phase == phase, 1.0, 0.0)


@law
def later(t: Any, start: Any) -> Any:
    """1 from a time on, else 0."""
    return where(t >= start, 1.0, 0.0)


@law
def follow(k: Phasing, m: Phase, height: Any, wants_land: Any, ready: Any, t: Any) -> Phase:
    """The phase at time t [s], with the vehicle at a height [m].

    `wants_land` is 1 to land for whatever reason; `ready` is 1 if nothing forbids a lift.
    """
    wants = maximum(wants_land, later(t, k.land_start))
    lifts = is_in(m, IDLE) * later(t, k.lift_start) * ready * (1.0 - wants) * where(m.land_rate > 0.0, 0.0, 1.0)
    lifted = is_in(m, LIFT) * where((t - m.since - k.spool) * k.lift_rate >= 1.0, 1.0, 0.0)
    lands = (is_in(m, LIFT) + is_in(m, GUIDED)) * wants
    landed = is_in(m, LAND) * where((t - m.since) * m.land_rate >= 1.0, 1.0, 0.0)
    ground = where(lifts > 0.0, height, m.ground)
    slow = k.descent / (1.875 * maximum(height - ground + k.press, 1e-3))  # 1.875: the smooth step's greatest slope
    phase = where(lifts > 0.0, LIFT, where(lifted > 0.0, GUIDED, m.phase))
    phase = where(lands > 0.0, LAND, where(landed > 0.0, IDLE, phase))
    return Phase(
        phase,
        where(phase == m.phase, m.since, t),
        ground,
        where(lands > 0.0, minimum(k.land_rate, slow), m.land_rate),
    )


@law
def orders_of(k: Phasing, m: Phase, t: Any) -> Orders:
    """What a phase lets happen at time t [s]."""
    idle, lift, land = is_in(m, IDLE), is_in(m, LIFT), is_in(m, LAND)
    up = smoothstep(t, m.since + k.spool, k.lift_rate)
    down = smoothstep(t, m.since, m.land_rate)
    landed = idle * where(m.land_rate > 0.0, 1.0, 0.0)
    begun = where(t - m.since < k.spool, 0.0, 1.0)
    return Orders(
        phase=m.phase,
        grounded=idle * (1.0 - k.always),
        listening=is_in(m, GUIDED),
        running=maximum(1.0 - idle, k.always),
        flying=maximum(1.0 - idle - lift * (1.0 - begun), k.always),
        lift=Ramp(lift * up.value + (1.0 - idle - lift) + landed, lift * up.rate, lift * up.curvature),
        land=Ramp(land * down.value + landed, land * down.rate, land * down.curvature),
        end=m.ground - k.press,
    )
