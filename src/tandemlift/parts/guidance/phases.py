"""The phases of a flight with a person, as a state machine.

idle on the ground → lift → hold ⇄ guided ⇄ contact, limited → land → idle; from each of them → stopped, which is final.
`next_phase` has the transitions, `PhaseOutput` the permissions of a phase. The laws have no branches: every condition
is a number, 1 or 0. The diagram is in docs/explanation/safety.md; `core.phases` has names and numbers.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra import absolute, maximum, minimum, where
from tandemlift.core.law import Absent, law
from tandemlift.core.phases import CONTACT, GUIDED, HOLD, IDLE, LAND, LIFT, LIMITED, STOPPED
from tandemlift.core.trajectories import SmoothStep, smoothstep
from tandemlift.core.types import Number
from tandemlift.core.vector import dot
from tandemlift.parts.guidance.requests import RequestCounts, RequestSchedule
from tandemlift.parts.mechanics.rigid_body import State

SETTLING_TIME = 1.0  # s, of steady hover before a tare
STEADY_SPEED = 0.1  # m/s and rad/s
SPIN, SPIN_HEIGHT = 2.0, 0.03  # rad/s, m: a landing with at least this rate ends at this height above the ground


class PhaseSettings(NamedTuple):
    """Parameters of the phases.

    `height` [m] of the lift; the times of the requests to lift and to land [s]; rates are 1/duration [1/s].
    `touchdown_depth` [m]: depth at which a landing's reference ends, so that the feet press. `spin_up_time`
    [s]: from the start of the rotors to the lift. `always_running` is 1 if the rotors run on the ground too, else 0.
    `max_descent_speed` [m/s]: of a landing. `tare_duration` [s]: of a tare in hover. `requests`: a `RequestSchedule`,
    or `Absent`.
    """

    height: Number
    lift_start: Number
    lift_rate: Number
    land_start: Number
    land_rate: Number
    touchdown_depth: Number
    spin_up_time: Number
    always_running: Number
    max_descent_speed: Number
    tare_duration: Number
    requests: RequestSchedule | Absent


class PhaseState(NamedTuple):
    """Memory: the phase and its start [s]; height of the ground [m], and 1/duration of the present landing [1/s].

    `lift_fraction`: of the lift that is done; `extra_depth` [m]: additional depth of the landing; the numbers of
    handled requests to lift and to land; the time of steady hover, less `SETTLING_TIME`.
    """

    phase: Number
    since: Number
    ground: Number
    land_rate: Number
    lift_fraction: Number
    extra_depth: Number
    handled_lifts: Number
    handled_lands: Number
    hover_time: Number


class PhaseBounds(NamedTuple):
    """Bounds, 1 or 0: whether supervision allows a lift and guidance; whether it demands to hold, land, stop.

    `touched_down`: whether a landing has ended early on something. `extra_depth` [m]: additional depth of a landing
    that begins now. `contact`: whether the reference is kept outside a wall. `limited`: above 0 while the vehicle
    cannot follow its reference.
    """

    lift_allowed: Number
    guidance_allowed: Number
    hold: Number
    land: Number
    stop: Number
    touched_down: Number
    extra_depth: Number
    contact: Number = 0.0
    limited: Number = 0.0


class PhaseOutput(NamedTuple):
    """The permissions of a phase: its number; 1 or 0 for on the ground, following pushes, rotors running.

    `flying`: 1 once the feet may have left the ground, for observers. The ramps of lift and landing; the landing ends
    at height `end` [m]. `compensating`: 1 while the controller compensates pushes.
    """

    phase: Number
    grounded: Number
    responding: Number
    running: Number
    flying: Number
    lift: SmoothStep
    land: SmoothStep
    end: Number
    compensating: Number


@law
def is_in(m: PhaseState, phase: Number) -> Number:
    """1 in a phase, else 0."""
    return where(m.phase == phase, 1.0, 0.0)


@law
def in_the_air(m: PhaseState) -> Number:
    """1 in flight, except in lift and landing, where feet may touch the ground; else 0."""
    return is_in(m, GUIDED) + is_in(m, HOLD) + is_in(m, CONTACT) + is_in(m, LIMITED)


@law
def reached(t: Number, start: Number) -> Number:
    """1 from a time on, before 0."""
    return where(t >= start, 1.0, 0.0)


@law
def exceeds(count: Number, other: Number) -> Number:
    """1 if a count is above another, else 0."""
    return where(count > other, 1.0, 0.0)


@law
def lift_request(k: PhaseSettings, m: PhaseState, requests: RequestCounts, operator: Number, land: Number) -> Number:
    """1 on the ground while a lift is requested, by requests or the `operator` (1), and no landing (`land`); else 0."""
    again = where(m.land_rate > 0.0, 1.0 - k.always_running, 1.0)
    return is_in(m, IDLE) * maximum(exceeds(requests.lifts, m.handled_lifts), operator) * (1.0 - land) * again


@law
def next_phase(
    k: PhaseSettings,
    m: PhaseState,
    requests: RequestCounts,
    bounds: PhaseBounds,
    lifts: Number,
    land: Number,
    t: Number,
) -> Number:
    """The phase after this sample; `lifts` is 1 if a lift begins, `land` 1 if a landing is requested."""
    lift, aloft = is_in(m, LIFT), in_the_air(m)
    up = lift * where((t - m.since - k.spin_up_time) * k.lift_rate >= 1.0, 1.0, 0.0) + aloft
    guided = requests.enabled * bounds.guidance_allowed * (1.0 - bounds.hold)
    demanded = maximum(maximum(land, bounds.land), lift * bounds.hold)
    lands = (lift + aloft) * demanded
    followed = where(bounds.contact > 0.0, CONTACT, GUIDED)
    landed = is_in(m, LAND) * maximum(where((t - m.since) * m.land_rate >= 1.0, 1.0, 0.0), bounds.touched_down)
    able = where(guided > 0.0, followed, HOLD)
    # from the weakest to the strongest: each line overrules those before it
    phase = where(lifts > 0.0, LIFT, m.phase)
    phase = where(up > 0.0, where(bounds.limited > 0.0, LIMITED, able), phase)
    phase = where(lands > 0.0, LAND, where(landed > 0.0, IDLE, phase))
    return where(maximum(requests.stop, bounds.stop) > 0.0, STOPPED, phase)


@law
def turning_at_ground(m: PhaseState, state: State) -> Number:
    """1 if a vehicle that rotates about the vertical is about to touch the ground, else 0.

    Feet that are dragged over the ground while the rotors run would overturn it.
    """
    return where(state.position.z < m.ground + SPIN_HEIGHT, where(absolute(state.rates.z) > SPIN, 1.0, 0.0), 0.0)


@law
def landing_rate(k: PhaseSettings, height: Number) -> Number:
    """1/duration [1/s] of a landing over a height [m], no faster than allowed."""
    steepest = 1.875  # slope of the smooth step
    return minimum(k.land_rate, k.max_descent_speed / (steepest * maximum(height, 1e-3)))


@law
def hover_time(k: PhaseSettings, m: PhaseState, phase: Number, state: State, dt: Number) -> Number:
    """The time of steady hover, less `SETTLING_TIME` [s]; above zero, being in the air is sufficient.

    A landing stops it; a tare that the landing interrupts begins again in the next hover.
    """
    up = in_the_air(m._replace(phase=phase))
    moving = maximum(dot(state.velocity, state.velocity), dot(state.rates, state.rates))
    steady = where(moving < STEADY_SPEED * STEADY_SPEED, up, where(m.hover_time >= 0.0, up, 0.0))
    stopped = where(m.hover_time < k.tare_duration, -SETTLING_TIME, m.hover_time)
    return where(steady > 0.0, m.hover_time + dt, stopped)


@law
def update_phase(
    k: PhaseSettings,
    m: PhaseState,
    state: State,
    requests: RequestCounts,
    wanted: tuple[Any, Any],
    bounds: PhaseBounds,
    t: Number,
    dt: Number,
) -> PhaseState:
    """The phase at time t [s].

    Args:
        k: parameters of the phases.
        m: their memory.
        state: of the vehicle.
        requests: all until now.
        wanted: (1 if a lift is requested, 1 if a landing is, for whatever reason), else 0.
        bounds: by supervision.
        t: now [s].
        dt: since the last sample [s].
    """
    height, idle = state.position.z, is_in(m, IDLE)
    lifts = wanted[0] * bounds.lift_allowed * (1.0 - bounds.stop)
    touched_down = maximum(bounds.touched_down, turning_at_ground(m, state))
    phase = next_phase(k, m, requests, bounds._replace(touched_down=touched_down), lifts, wanted[1], t)
    lands = where(phase == LAND, 1.0 - is_in(m, LAND), 0.0)
    ground = where(lifts > 0.0, height, m.ground)
    extra_depth = where(lands > 0.0, bounds.extra_depth, m.extra_depth)
    rate = where(lands > 0.0, landing_rate(k, height - ground + k.touchdown_depth + extra_depth), m.land_rate)
    up = smoothstep(t, m.since + k.spin_up_time, k.lift_rate).value
    settled = maximum(lifts, maximum(1.0 - idle, wanted[1]))
    return PhaseState(
        phase=phase,
        since=where(phase == m.phase, m.since, t),
        ground=ground,
        land_rate=where(lifts > 0.0, 0.0, rate),
        lift_fraction=where(lifts > 0.0, 0.0, where(is_in(m, LIFT) > 0.0, up, m.lift_fraction)),
        extra_depth=extra_depth,
        handled_lifts=where(settled > 0.0, requests.lifts, minimum(m.handled_lifts, requests.lifts)),
        handled_lands=where(idle > 0.0, requests.lands, m.handled_lands),
        hover_time=hover_time(k, m, phase, state, dt),
    )


@law
def phase_output(k: PhaseSettings, m: PhaseState, t: Number) -> PhaseOutput:
    """The permissions of a phase at time t [s]."""
    idle, lift, land, stopped = is_in(m, IDLE), is_in(m, LIFT), is_in(m, LAND), is_in(m, STOPPED)
    up = smoothstep(t, m.since + k.spin_up_time, k.lift_rate)
    down = smoothstep(t, m.since, m.land_rate)
    landed = idle * k.always_running * where(m.land_rate > 0.0, 1.0, 0.0)
    begun = where(t - m.since < k.spin_up_time, 0.0, 1.0)
    parked = idle * (1.0 - k.always_running)
    lift_fraction = m.lift_fraction * (1.0 - stopped) * (1.0 - parked)
    return PhaseOutput(
        phase=m.phase,
        grounded=parked + stopped,
        responding=is_in(m, GUIDED) + is_in(m, CONTACT),
        running=(1.0 - parked) * (1.0 - stopped),
        flying=(1.0 - parked) * (1.0 - stopped) * (1.0 - lift * (1.0 - begun) * (1.0 - k.always_running)),
        lift=SmoothStep(where(lift > 0.0, up.value, lift_fraction), lift * up.rate, lift * up.curvature),
        land=SmoothStep(land * down.value + landed, land * down.rate, land * down.curvature),
        end=m.ground - k.touchdown_depth - m.extra_depth,
        compensating=(1.0 - idle) * (1.0 - stopped),
    )


def start_phases(ground: Number) -> PhaseState:
    """The memory before the first sample, on the ground at a height [m]."""
    return PhaseState(
        phase=IDLE,
        since=0.0,
        ground=ground,
        land_rate=0.0,
        lift_fraction=0.0,
        extra_depth=0.0,
        handled_lifts=0.0,
        handled_lands=0.0,
        hover_time=-SETTLING_TIME,
    )
