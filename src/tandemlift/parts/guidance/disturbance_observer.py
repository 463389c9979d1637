"""A disturbance observer: it estimates the loads on the vehicle besides its rotors, its weight and the person.

A model of the vehicle is integrated with the thrusts that the allocation could give, through a model of the rotors, so
nothing winds up while they are at their limits. The disturbance is what keeps the model at the measured velocity and
rates: per axis, with the error e and the disturbance's acceleration d,

    ė = d_true − d − 2 λ e,   ḋ = λ² e       while |λ² e| ≤ L,
    ė = d_true − d − 2 √(L |e|) sgn e,   ḋ = L sgn e   beyond.

Near zero this is a linear extended-state observer of bandwidth λ (Han, From PID to active disturbance rejection
control, 2009), which averages noise; beyond, it is the super-twisting observer (Levant, Robust exact differentiation
via sliding mode technique, 1998; Moreno and Osorio, 2012) whose estimate changes no faster than L, so that a lost rotor
does not upset it. The two meet continuously; an infinite L gives the linear one.

The model includes the measured push of the person, so that is no disturbance.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, Literal, NamedTuple

import numpy as np

from tandemlift.core.algebra import absolute, clip, minimum, sqrt
from tandemlift.core.arrays import array, inverse
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import BELIEVED, TRIAL, NonNegative, Positive, Positive3, Table, key
from tandemlift.core.law import elementwise, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.part import Part, channels_of
from tandemlift.core.types import GRAVITY, Number, PerRotor
from tandemlift.core.vector import ZERO, Mat3, Vec3, vec3
from tandemlift.parts.mechanics.rigid_body import (
    UP,
    InitialTable,
    PushedState,
    Wrench,
    apply_inertia,
    gyroscopic,
    inertia_value,
)
from tandemlift.parts.mechanics.rotation import body_z_axis
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import Mixer, wrench


class ObserverTable(
    Table,
    acts='observer.model = "extended-state" or "super-twisting"',
    keys_act={"force_slope moment_slope": 'observer.model = "super-twisting"'},
):
    """`[observer]`: a disturbance observer, which separates wind and model error from the person's push.

    The controller compensates its estimate. It is driven by the thrusts that the allocation could give, so it needs
    `allocation.method = "constrained"`. Axes are x, y, z for forces and roll, pitch, yaw for moments.
    """

    model: Literal["none", "extended-state", "super-twisting"] = key(
        "none",
        None,
        "model of the observer",
        choices={
            "none": "no observer",
            "extended-state": "linear",
            "super-twisting": "linear near zero, and limited to a slope beyond",
        },
    )
    force_bandwidth: Positive3 = key((6.0, 6.0, 6.0), "rad/s", "bandwidth of the estimated force", source=TRIAL)
    force_slope: Positive3 = key(
        (10.0, 10.0, 10.0), "N/s", "steepest change of the force that 'super-twisting' follows", source=TRIAL
    )
    moment_bandwidth: Positive3 = key((10.0, 10.0, 10.0), "rad/s", "bandwidth of the estimated moment", source=TRIAL)
    moment_slope: Positive3 = key(
        (5.0, 5.0, 5.0), "N m/s", "steepest change of the moment that 'super-twisting' follows", source=TRIAL
    )
    rotor_lag: Positive = key(
        0.018, "s", "time constant of the rotors in the observer's model, up and down", source=BELIEVED
    )
    rotor_delay: NonNegative = key(
        0.01, "s", "delay of the rotors in the observer's model", source="actuators.delay of mission iris"
    )


class DisturbanceFilter(NamedTuple):
    """Parameters of three axes: bandwidth λ [1/s], and the largest slope L of the disturbance [unit of e/s²]."""

    bandwidth: Vec3
    slope: Vec3


class DisturbanceObserver(NamedTuple):
    """The nominal vehicle, low-passes that model its rotors, and the filters of force and moment."""

    mass: Number
    inertia: Mat3 | Vec3
    inverse_inertia: Mat3 | Vec3
    drag_force: Vec3
    drag_moment: Vec3
    effect: Mixer
    thrust: LowPass
    moment: LowPass
    force_follower: DisturbanceFilter
    moment_follower: DisturbanceFilter


class ObserverState(NamedTuple):
    """Memory: the modelled rotors' wrench; velocity [m/s] and rates [rad/s] of the model; both disturbances.

    Disturbances are accelerations [m/s², world axes] and angular accelerations [rad/s², body axes]; the
    residuals are the corrections besides them.
    """

    thrust: LowPassState[Number]
    moment: LowPassState[Vec3]
    velocity: Vec3
    rates: Vec3
    acceleration: Vec3
    turning: Vec3
    residual: Vec3
    turning_residual: Vec3


class DisturbanceEstimate(NamedTuple):
    """The estimated disturbance: force [N, world axes], moment [N·m, body axes]; and the estimation errors.

    The residuals [m/s², rad/s²] estimate the error δ − δ̂ of the disturbance; by the paper's condition it must stay
    below λ₂.
    """

    force: Vec3
    moment: Vec3
    residual: Vec3
    turning_residual: Vec3


NONE = DisturbanceEstimate(ZERO, ZERO, ZERO, ZERO)


@elementwise
def correction(e: Number, bandwidth: Number, slope: Number) -> Number:
    """The rate of the model's correction towards the measurement: 2 λ e, or 2 √(L |e|) sgn e where that is less."""
    near = 2.0 * bandwidth * e
    far = 2.0 * sqrt(slope * absolute(e))
    return clip(near, -far, far)


@elementwise
def growth(e: Number, bandwidth: Number, slope: Number) -> Number:
    """The rate of the disturbance's estimate: λ² e, or L sgn e where that is less."""
    return clip(bandwidth * bandwidth * e, -slope, slope)


@law
def rates_of_change(k: DisturbanceObserver, pilot_input: PushedState, u: Wrench) -> tuple[Vec3, Vec3]:
    """(acceleration [m/s², world axes], angular acceleration [rad/s², body axes]) without any disturbance."""
    s = pilot_input.state
    force = body_z_axis(s.attitude) * u.thrust + pilot_input.push - k.drag_force * s.velocity
    moment = u.moment + pilot_input.moment + gyroscopic(k.inertia, s.rates) - k.drag_moment * s.rates
    return force * (1.0 / k.mass) - UP * GRAVITY, apply_inertia(k.inverse_inertia, moment)


@law(absent=(NONE, "memory"))
def observer_step(
    k: DisturbanceObserver,
    memory: ObserverState,
    pilot_input: PushedState,
    thrusts: PerRotor,
    active: Number,
    learning: Number,
    dt: Number,
) -> tuple[DisturbanceEstimate, ObserverState]:
    """(`DisturbanceEstimate`, the new memory) at a sample.

    Args:
        k: the observer, or `Absent`.
        memory: its memory.
        pilot_input: the pilot's input, a `PilotInput`.
        thrusts: of all rotors [N], as allocated at the last sample.
        active: 1 in flight; 0 on the ground, where nothing is estimated.
        learning: 1; 0 holds the estimate while feet may touch the floor, whose force is no disturbance.
        dt: since the last sample [s].
    """
    u = wrench(k.effect, thrusts)
    thrust, moment = low_pass_step(k.thrust, memory.thrust, u.thrust), low_pass_step(k.moment, memory.moment, u.moment)
    linear, angular = rates_of_change(k, pilot_input, Wrench(thrust.value, moment.value))
    f, m = k.force_follower, k.moment_follower
    # on the ground both errors are 0, so that the model stays at the measured motion
    e, w = (pilot_input.state.velocity - memory.velocity) * active, (pilot_input.state.rates - memory.rates) * active
    acceleration = (memory.acceleration + growth(e, f.bandwidth, f.slope) * (learning * dt)) * active
    turning = (memory.turning + growth(w, m.bandwidth, m.slope) * (learning * dt)) * active
    residual, turning_residual = correction(e, f.bandwidth, f.slope), correction(w, m.bandwidth, m.slope)
    velocity = pilot_input.state.velocity - e + (linear + acceleration + residual) * dt
    rates = pilot_input.state.rates - w + (angular + turning + turning_residual) * dt
    after = ObserverState(thrust, moment, velocity, rates, acceleration, turning, residual, turning_residual)
    return unmodelled(k, after), after


@law(absent=NONE)
def unmodelled(k: DisturbanceObserver, m: ObserverState) -> DisturbanceEstimate:
    """The estimate in a memory, that of the last sample."""
    return DisturbanceEstimate(
        m.acceleration * k.mass, apply_inertia(k.inertia, m.turning), m.residual, m.turning_residual
    )


UNBOUNDED_SLOPE = 1e18  # a slope that nothing reaches


def _follower(bandwidth: Iterable[float], slope: Iterable[float], linear: bool, size: np.ndarray) -> DisturbanceFilter:
    """A filter with a slope in N/s or N·m/s, for axes of a mass [kg] or inertia [kg·m²]."""
    most = (
        [UNBOUNDED_SLOPE] * 3
        if linear
        else [minimum(s / m, UNBOUNDED_SLOPE) for s, m in zip(slope, size.tolist(), strict=True)]
    )
    return DisturbanceFilter(vec3(bandwidth), vec3(most))


def start_observer(
    table: ObserverTable, vehicle: Vehicle, effect: Mixer, step: float, initial: InitialTable, *, hovers: bool
) -> tuple[DisturbanceObserver, ObserverState]:
    """The observer before its first sample, and its memory; `effect` of the rotors, and whether they hover first."""
    o, linear, inertia = table, table.model == "extended-state", vehicle.inertia
    rotors = low_pass(2.0 / (o.rotor_lag + o.rotor_delay + step), step)
    observer = DisturbanceObserver(
        mass=vehicle.mass,
        inertia=inertia_value(inertia),
        inverse_inertia=inertia_value(inverse(inertia)),
        drag_force=vec3(vehicle.drag.force),
        drag_moment=vec3(vehicle.drag.moment),
        effect=effect,
        thrust=rotors,
        moment=rotors,
        force_follower=_follower(o.force_bandwidth, o.force_slope, linear, array([vehicle.mass] * 3)),
        moment_follower=_follower(o.moment_bandwidth, o.moment_slope, linear, np.diag(inertia)),
    )
    thrust = LowPassState(vehicle.weight if hovers else 0.0, 0.0)
    velocity, rates = vec3(initial.velocity), vec3(initial.rates)
    at_start = ObserverState(thrust, LowPassState(ZERO, ZERO), velocity, rates, ZERO, ZERO, ZERO, ZERO)
    return observer, at_start


def observer_checks(table: ObserverTable, method: str) -> Iterator[CheckResult]:
    """Check for an observer without known thrusts of the rotors; `method`: `allocation.method`."""
    if table.model != "none" and method != "constrained":
        yield refused(
            f'observer.model = "{table.model}": must be "none" unless allocation.method is "constrained", '
            "which gives it the possible thrusts of the rotors"
        )


class DisturbanceChannels(NamedTuple):
    """The estimate of a disturbance observer, and its error."""

    disturbance_force: Vec3
    disturbance_moment: Vec3
    disturbance_residual: Vec3
    disturbance_angular_residual: Vec3


@channels_of.register(DisturbanceObserver)
def _channels(k: DisturbanceObserver, memory: Any, decision: Any) -> DisturbanceChannels:
    return DisturbanceChannels(*decision.disturbance)


OBSERVER = Part(
    *("observer", "pilot", "observer", 'observer.model = "super-twisting" or "extended-state"', start_observer),
    refusals=observer_checks,
    channels=DisturbanceChannels,
    logged="disturbance",
)
