"""What acts on the vehicle besides its rotors, its weight and the person: a disturbance observer.

A copy of the vehicle's equations of motion runs beside it, driven by the thrusts that the allocation could give,
through a model of the rotors, so nothing winds up where they are at their limits. What the copy lacks to keep up with
the measured velocity and rates is the disturbance: per axis, with the error e and the disturbance's acceleration d,

    ė = d_true − d − 2 λ e,   ḋ = λ² e       while |λ² e| ≤ L,
    ė = d_true − d − 2 √(L |e|) sgn e,   ḋ = L sgn e   beyond.

Near zero this is a linear extended-state observer of bandwidth λ (Han, From PID to active disturbance rejection
control, 2009), which averages noise; beyond, it is the super-twisting observer (Levant, Robust exact differentiation
via sliding mode technique, 1998; Moreno and Osorio, 2012) whose estimate follows no faster than L, so that a lost rotor
does not throw it. The two meet continuously. L without bound leaves the linear one.

The person's push goes into the copy as it is measured, so it is no disturbance.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import absolute, clip, sqrt
from tandemlift.algebra.vector import ZERO, Vec3
from tandemlift.laws.mechanics.body import UP, Wrench
from tandemlift.laws.mechanics.inertia import apply_inertia, gyroscopic
from tandemlift.laws.mechanics.rotation import body_z_axis
from tandemlift.laws.rotors.allocation import Mixer, wrench
from tandemlift.laws.signals.low_pass import LowPass, LowPassState, low_pass_step


class DisturbanceFilter(NamedTuple):
    """How three axes follow: bandwidth λ [1/s], and the steepest slope L of the disturbance [unit of e/s²]."""

    bandwidth: Vec3
    slope: Vec3


class DisturbanceObserver(NamedTuple):
    """The vehicle as it is believed to be, a low-pass that stands for its rotors, and how the observer follows."""

    mass: Any
    inertia: Any
    inverse_inertia: Any
    drag_force: Vec3
    drag_moment: Vec3
    effect: Mixer
    thrust: LowPass
    moment: LowPass
    force_follower: DisturbanceFilter
    moment_follower: DisturbanceFilter


class ObserverState(NamedTuple):
    """Memory: the modelled rotors' wrench; velocity [m/s] and rates [rad/s] of the copy; both disturbances.

    Disturbances are accelerations [m/s², world axes] and angular accelerations [rad/s², body axes]; what is left of
    them besides is the residual.
    """

    thrust: LowPassState
    moment: LowPassState
    velocity: Vec3
    rates: Vec3
    acceleration: Vec3
    turning: Vec3
    residual: Vec3
    turning_residual: Vec3


class DisturbanceEstimate(NamedTuple):
    """The disturbance: force [N, world axes], moment [N·m, body axes]; and how far the copy lags behind the vehicle.

    The residuals [m/s², rad/s²] are what the disturbance would have to change by, as far as the copy can tell: the
    ‖δ − δ̂‖ of the paper's condition on λ₂.
    """

    force: Vec3
    moment: Vec3
    residual: Vec3
    turning_residual: Vec3


NONE = DisturbanceEstimate(ZERO, ZERO, ZERO, ZERO)


@elementwise
def correction(e: Any, bandwidth: Any, slope: Any) -> Any:
    """How fast the copy is drawn to the vehicle: 2 λ e, or 2 √(L |e|) sgn e where that is less."""
    near = 2.0 * bandwidth * e
    far = 2.0 * sqrt(slope * absolute(e))
    return clip(near, -far, far)


@elementwise
def growth(e: Any, bandwidth: Any, slope: Any) -> Any:
    """How fast the estimate of the disturbance changes: λ² e, or L sgn e where that is less."""
    return clip(bandwidth * bandwidth * e, -slope, slope)


@choice(absent=(NONE, "memory"))
def observer_step(k: Any, memory: Any, heard: Any, thrusts: Any, active: Any, learning: Any, dt: Any) -> Any:
    """(what is `DisturbanceEstimate`, the new memory) at a sample.

    Args:
        k: the observer, or `Nothing`.
        memory: its memory.
        heard: what the pilot is told.
        thrusts: of all rotors [N], as allocated at the last sample.
        active: 1 in flight; 0 on the ground, where nothing is estimated.
        learning: 1; 0 to keep what was found, where feet may press on the floor, which is no disturbance.
        dt: since the last sample [s].
    """


@law
def expected(k: DisturbanceObserver, memory: ObserverState, thrusts: Any) -> Any:
    """(the modelled rotors' thrust, moment) after a step under these commands, each with its rate."""
    u = wrench(k.effect, thrusts)
    return low_pass_step(k.thrust, memory.thrust, u.thrust), low_pass_step(k.moment, memory.moment, u.moment)


@law
def rates_of_change(k: DisturbanceObserver, heard: Any, u: Wrench) -> Any:
    """(acceleration [m/s², world axes], angular acceleration [rad/s², body axes]) without any disturbance."""
    s = heard.state
    force = body_z_axis(s.attitude) * u.thrust + heard.push - k.drag_force * s.velocity
    moment = u.moment + heard.moment + gyroscopic(k.inertia, s.rates) - k.drag_moment * s.rates
    return force * (1.0 / k.mass) - UP * GRAVITY, apply_inertia(k.inverse_inertia, moment)


@observer_step.register(DisturbanceObserver)
def _observed(
    k: DisturbanceObserver, memory: Any, heard: Any, thrusts: Any, active: Any, learning: Any, dt: Any
) -> Any:
    thrust, moment = expected(k, memory, thrusts)
    linear, angular = rates_of_change(k, heard, Wrench(thrust.value, moment.value))
    f, m = k.force_follower, k.moment_follower
    e, w = (heard.state.velocity - memory.velocity) * active, (heard.state.rates - memory.rates) * active
    acceleration = (memory.acceleration + growth(e, f.bandwidth, f.slope) * (learning * dt)) * active
    turning = (memory.turning + growth(w, m.bandwidth, m.slope) * (learning * dt)) * active
    residual, turning_residual = correction(e, f.bandwidth, f.slope), correction(w, m.bandwidth, m.slope)
    velocity = heard.state.velocity - e + (linear + acceleration + residual) * dt
    rates = heard.state.rates - w + (angular + turning + turning_residual) * dt
    after = ObserverState(thrust, moment, velocity, rates, acceleration, turning, residual, turning_residual)
    return unmodelled(k, after), after


@law
def unmodelled(k: DisturbanceObserver, m: ObserverState) -> DisturbanceEstimate:
    """What is known from the memory."""
    return DisturbanceEstimate(
        m.acceleration * k.mass, apply_inertia(k.inertia, m.turning), m.residual, m.turning_residual
    )


@choice(absent=NONE)
def last_known(k: Any, memory: Any) -> Any:
    """What was `DisturbanceEstimate` at the last sample."""


@last_known.register(DisturbanceObserver)
def _known(k: DisturbanceObserver, memory: Any) -> Any:
    return unmodelled(k, memory)
