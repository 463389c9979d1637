"""The phases of a flight with a person, as a state machine.

idle on the ground → lift → hold ⇄ guided → land → idle; from any of them → stopped, for good. Each is entered for a
reason and left for a reason; `PhaseOutput` says what a phase allows. A law without branches: every condition is a
number, 1 or 0. The diagram is in docs/safety.md.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import maximum, minimum, where
from tandemlift.algebra.vector import dot
from tandemlift.common.phases import GUIDED, HOLD, IDLE, LAND, LIFT, STOPPED
from tandemlift.laws.guidance.requests import RequestCounts
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.signals.trajectories import SmoothStep, smoothstep

SETTLE = 1.0  # s, of steady hover before a tare
STEADY = 0.1  # m/s and rad/s


class PhaseSettings(NamedTuple):
    """What is asked for, and how fast.

    `height` [m] of the lift; when it is asked for, and the landing [s]; rates are 1/duration [1/s]. `touchdown_depth`
    [m]: how far below the ground the landing's reference ends, so that the feet press. `spin_up_time` [s] from when the
    rotors run to the lift. `always` is 1 if the rotors run in idle too. `max_descent_speed` [m/s]: of a landing.
    `requests` besides, or `Nothing`.
    """

    height: Any
    lift_start: Any
    lift_rate: Any
    land_start: Any
    land_rate: Any
    touchdown_depth: Any
    spin_up_time: Any
    always: Any
    max_descent_speed: Any
    requests: Any


class PhaseState(NamedTuple):
    """Memory: which phase, since when [s]; the ground's height [m], and 1/duration of the landing that is flown.

    `risen`: the share of the lift that was flown; `deep` [m]: how much farther down the landing ends. How many requests
    to lift and to land have been dealt with; how long it has hovered steadily, less `SETTLE` [s].
    """

    phase: Any
    since: Any
    ground: Any
    land_rate: Any
    risen: Any
    deep: Any
    lifts: Any
    lands: Any
    hovered: Any


class PhaseBounds(NamedTuple):
    """What supervision allows, 1 or 0: a lift, to listen; what it demands: to hold, land, stop; 1 once landed.

    `deep` [m]: how much farther down a landing that begins now ends.
    """

    ready: Any
    clear: Any
    hold: Any
    land: Any
    stop: Any
    landed: Any
    deep: Any


class PhaseOutput(NamedTuple):
    """What the phase lets happen: which it is; 1 or 0 for on the ground, listening to pushes, rotors running.

    `flying`: 1 from when the feet may have left the ground, for observers; `countering`: 1 while pushes are countered.
    Ramps of lift and landing; the landing ends at `end` [m].
    """

    phase: Any
    grounded: Any
    listening: Any
    running: Any
    flying: Any
    lift: SmoothStep
    land: SmoothStep
    end: Any
    countering: Any


@law
def is_in(m: PhaseState, phase: Any) -> Any:
    """1 in a phase, else 0."""
    return where(m.phase == phase, 1.0, 0.0)


@law
def later(t: Any, start: Any) -> Any:
    """1 from a time on, else 0."""
    return where(t >= start, 1.0, 0.0)


@law
def more(count: Any, than: Any) -> Any:
    """1 if a count is more than another, else 0."""
    return where(count > than, 1.0, 0.0)


@law
def wants_lift(k: PhaseSettings, m: PhaseState, asked: RequestCounts, wish: Any, wants_land: Any) -> Any:
    """1 on the ground while a lift is asked for: once by a request, or by a `wish` (1)."""
    again = where(m.land_rate > 0.0, 1.0 - k.always, 1.0)
    return is_in(m, IDLE) * maximum(more(asked.lifts, m.lifts), wish) * (1.0 - wants_land) * again


@law
def next_phase(
    k: PhaseSettings, m: PhaseState, asked: RequestCounts, bounds: PhaseBounds, lifts: Any, wants_land: Any, t: Any
) -> Any:
    """The phase after this sample; `lifts` is 1 if a lift begins."""
    lift = is_in(m, LIFT)
    up = lift * where((t - m.since - k.spin_up_time) * k.lift_rate >= 1.0, 1.0, 0.0) + is_in(m, GUIDED) + is_in(m, HOLD)
    listens = asked.enabled * bounds.clear * (1.0 - bounds.hold)
    demanded = maximum(maximum(wants_land, bounds.land), lift * bounds.hold)
    lands = (lift + is_in(m, GUIDED) + is_in(m, HOLD)) * demanded
    landed = is_in(m, LAND) * maximum(where((t - m.since) * m.land_rate >= 1.0, 1.0, 0.0), bounds.landed)
    phase = where(lifts > 0.0, LIFT, m.phase)
    phase = where(up > 0.0, where(listens > 0.0, GUIDED, HOLD), phase)
    phase = where(lands > 0.0, LAND, where(landed > 0.0, IDLE, phase))
    return where(maximum(asked.stop, bounds.stop) > 0.0, STOPPED, phase)


@law
def landing_rate(k: PhaseSettings, height: Any) -> Any:
    """1/duration [1/s] of a landing over a height [m], no faster than allowed."""
    steepest = 1.875  # slope of the smooth step
    return minimum(k.land_rate, k.max_descent_speed / (steepest * maximum(height, 1e-3)))


@law
def hovered(m: PhaseState, phase: Any, state: State, dt: Any) -> Any:
    """How long it has hovered steadily in the air, less `SETTLE` [s]; it goes on once it is above zero."""
    up = where(phase == GUIDED, 1.0, where(phase == HOLD, 1.0, 0.0))
    moving = maximum(dot(state.velocity, state.velocity), dot(state.rates, state.rates))
    steady = where(moving < STEADY * STEADY, up, where(m.hovered >= 0.0, up, 0.0))
    return where(steady > 0.0, m.hovered + dt, where(m.hovered >= 0.0, m.hovered, -SETTLE))


@law
def follow(
    k: PhaseSettings,
    m: PhaseState,
    state: State,
    asked: RequestCounts,
    wants: Any,
    bounds: PhaseBounds,
    t: Any,
    dt: Any,
) -> PhaseState:
    """The phase at time t [s].

    Args:
        k: what the phases are like.
        m: their memory.
        state: of the vehicle.
        asked: what has been asked until now.
        wants: (1 if a lift is asked for, 1 if a landing is, for whatever reason), else 0.
        bounds: what supervision forbids or demands.
        t: now [s].
        dt: since the last sample [s].
    """
    height, idle = state.position.z, is_in(m, IDLE)
    lifts = wants[0] * bounds.ready * (1.0 - bounds.stop)
    phase = next_phase(k, m, asked, bounds, lifts, wants[1], t)
    lands = where(phase == LAND, 1.0 - is_in(m, LAND), 0.0)
    ground = where(lifts > 0.0, height, m.ground)
    deep = where(lands > 0.0, bounds.deep, m.deep)
    rate = where(lands > 0.0, landing_rate(k, height - ground + k.touchdown_depth + deep), m.land_rate)
    up = smoothstep(t, m.since + k.spin_up_time, k.lift_rate).value
    in_vain = maximum(lifts, maximum(1.0 - idle, idle * more(asked.lands, m.lands)))
    return PhaseState(
        phase,
        where(phase == m.phase, m.since, t),
        ground,
        where(lifts > 0.0, 0.0, rate),
        where(lifts > 0.0, 0.0, where(is_in(m, LIFT) > 0.0, up, m.risen)),
        deep,
        where(in_vain > 0.0, asked.lifts, m.lifts),
        where(idle > 0.0, asked.lands, m.lands),
        hovered(m, phase, state, dt),
    )


@law
def phase_output(k: PhaseSettings, m: PhaseState, t: Any) -> PhaseOutput:
    """What a phase lets happen at time t [s]."""
    idle, lift, land, stopped = is_in(m, IDLE), is_in(m, LIFT), is_in(m, LAND), is_in(m, STOPPED)
    up = smoothstep(t, m.since + k.spin_up_time, k.lift_rate)
    down = smoothstep(t, m.since, m.land_rate)
    landed = idle * k.always * where(m.land_rate > 0.0, 1.0, 0.0)
    begun = where(t - m.since < k.spin_up_time, 0.0, 1.0)
    down_here = idle * (1.0 - k.always)
    risen = m.risen * (1.0 - stopped) * (1.0 - down_here)
    return PhaseOutput(
        phase=m.phase,
        grounded=down_here + stopped,
        listening=is_in(m, GUIDED),
        running=(1.0 - down_here) * (1.0 - stopped),
        flying=(1.0 - down_here) * (1.0 - stopped) * (1.0 - lift * (1.0 - begun) * (1.0 - k.always)),
        lift=SmoothStep(where(lift > 0.0, up.value, risen), lift * up.rate, lift * up.curvature),
        land=SmoothStep(land * down.value + landed, land * down.rate, land * down.curvature),
        end=m.ground - k.touchdown_depth - m.deep,
        countering=(1.0 - idle) * (1.0 - stopped),
    )
