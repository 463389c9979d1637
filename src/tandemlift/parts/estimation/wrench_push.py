"""The push of a person without force sensors: an observed external wrench, less its tare.

An observer (`parts.estimation.wrench`) sees the inertial sensors, motion capture, and the thrusts that the pilot's
model of the rotors makes of its commands: with their lag, delay and ground effect. What the observer finds in hover,
over the window of the tare, is its bias in body axes: wind, errors of the thrust and of the accelerometer. If the
payload's mass is identified, the part that gravity explains is mass, and F̂ + (m̂ − m) s the force, with s the specific
force.

Nothing is estimated while a floor may carry the vehicle. Wind that changes, and every error of the model that does, is
a push.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from tandemlift.core.algebra import where
from tandemlift.core.arrays import inverse
from tandemlift.core.law import choice, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.types import GRAVITY, Number, PerRotor, number
from tandemlift.core.vector import ZERO, Absent, Mat3, Vec3, apply, apply_transposed, cross, each, vec3
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.navigation import NavigationState, Navigator, navigate
from tandemlift.parts.estimation.push_confirmation import RotorModel, rotor_model, speed_at
from tandemlift.parts.estimation.push_estimate import (
    PushEstimator,
    PushEstimatorState,
    estimate,
    point_of_application,
)
from tandemlift.parts.estimation.tare import SideForces, TareSums, is_tared, summed, tare_fields, tare_of
from tandemlift.parts.estimation.wrench.delay import RotorDelay, RotorDelayState, late_wrench, rotor_delay
from tandemlift.parts.estimation.wrench.observation import NominalBody, Observation, PushEstimate, observe
from tandemlift.parts.estimation.wrench.start_observer import OBSERVERS, SampleNoise
from tandemlift.parts.mechanics.rigid_body import UP, State, Wrench, inertia_value
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import wrench
from tandemlift.parts.rotors.ground_effect import GroundEffect, ground_effect_from, ground_effect_ratio
from tandemlift.parts.rotors.rotor_lag import lag_step
from tandemlift.parts.sensors.off_center import OffCenter, at_center, off_center_at
from tandemlift.parts.sensors.readings import Readings
from tandemlift.parts.sensors.sensors_table import SensorsTable, noise_scale


class ThrustModel(NamedTuple):
    """The pilot's model of the rotors; the delay of commands and IMU; ground effect."""

    rotors: RotorModel
    late: RotorDelay
    surface: GroundEffect | Absent


class ThrustState(NamedTuple):
    """Memory: speeds of the rotors as modelled [rad/s], a set; of the delay."""

    speeds: PerRotor
    late: RotorDelayState


class WrenchPush(NamedTuple):
    """An observer, the model of the thrusts, and the nominal vehicle, body axes.

    `payload`: its centre of mass from the system's [m]; `imu`: the system's centre of mass from the accelerometer [m].
    `mass` of the payload [kg]; `low_pass` of the specific force that accelerates an excess of it. The others are those
    of a `PushEstimator`.
    """

    observer: Any
    thrust: ThrustModel
    payload: Vec3
    imu: OffCenter
    mass: Number
    low_pass: LowPass
    reach: Number
    per_interval: Number
    least: Number
    tare_start: Number
    tare_end: Number
    identify: Number
    off_center: OffCenter | Absent


class WrenchPushState(NamedTuple):
    """Memory: of the observer and the thrusts; rates [rad/s], angular acceleration [rad/s²], specific force; tare."""

    observer: Any
    thrust: ThrustState
    rates: Vec3
    angular: Vec3
    specific_force: LowPassState[Vec3]
    sums: TareSums


class PushInputs(NamedTuple):
    """Readings, the last thrusts of the rotors [N], 1 while no floor carries the vehicle, the clock of the tare, dt.

    `airborne` is also 0 in a contact where wind is subtracted from the push (`wind_compensation`), and always 1 for
    joints alone. Only then are samples taken for the tare.
    """

    readings: Readings
    commands: PerRotor | Absent
    airborne: Number
    t: Number
    dt: Number


class PushAndState(NamedTuple):
    """The push and the state of the vehicle, each with the new memory of its estimator."""

    push: PushEstimate
    push_memory: Any
    state: State
    navigation: NavigationState


@choice
def push_and_state(
    k: PushEstimator | WrenchPush, memory: Any, navigator: Navigator, navigation: NavigationState, x: PushInputs
) -> PushAndState:
    """The push by joints or by an observer, which uses the navigator's state, and that state."""


@push_and_state.register(PushEstimator)
def _by_joints(
    k: PushEstimator, memory: PushEstimatorState, navigator: Navigator, navigation: NavigationState, x: PushInputs
) -> PushAndState:
    push, after = estimate(k, memory, x.readings.imu, x.t, x.airborne)
    return PushAndState(push, after, *navigate(navigator, navigation, x.readings))


@law
def modelled_rotors(
    k: ThrustModel, m: ThrustState, x: PushInputs, state: State, vertical: Number
) -> tuple[Wrench, ThrustState]:
    """(the wrench of the rotors at the IMU's last sample, the new memory); `vertical`: see `late_wrench`."""
    r = k.rotors
    squares, speeds = lag_step(r.up, r.down, m.speeds, speed_at(x.commands, r.per_constant))
    made = wrench(r.effect, squares * r.constant * ground_effect_ratio(k.surface, state))
    later, late = late_wrench(k.late, m.late, made, vertical, x.airborne, x.dt)
    return later, ThrustState(speeds, late)


@law
def observation(k: WrenchPush, m: WrenchPushState, x: PushInputs, state: State) -> tuple[Observation, WrenchPushState]:
    """(what an observer sees, the memory with the model of the thrusts and the rates)."""
    imu, motion = x.readings.imu, x.readings.motion
    angular = where(imu.fresh > 0.0, (imu.rates - m.rates) * k.per_interval, m.angular)
    at = at_center(k.imu, imu.specific_force, imu.rates, angular)
    rotors, thrust = modelled_rotors(k.thrust, m.thrust, x, state, at.z)
    seen = Observation(at, state, rotors, motion.position, motion.velocity, motion.attitude, motion.fresh, x.dt)
    return seen, m._replace(thrust=thrust, rates=imu.rates, angular=angular)


@push_and_state.register(WrenchPush)
def _by_motion(
    k: WrenchPush, memory: WrenchPushState, navigator: Navigator, navigation: NavigationState, x: PushInputs
) -> PushAndState:
    (state, navigated), imu = navigate(navigator, navigation, x.readings), x.readings.imu
    seen, m = observation(k, memory, x, state)
    smooth = low_pass_step(k.low_pass, m.specific_force, imu.specific_force)
    a = smooth.value  # of the excess mass, about as late as the observed force
    found, observer = observe(k.observer, m.observer, seen)
    R = rotation_from_quaternion(state.attitude)
    force = apply_transposed(R, found.force)
    begun = where(x.t < k.tare_start, 0.0, 1.0)
    taken = begun * where(x.t < k.tare_end, imu.fresh, 0.0) * x.airborne
    sums = summed(m.sums, begun, taken, a * k.mass - force, a, found.moment, m.sums.sides)
    armed = is_tared(k.tare_start, k.tare_end, sums.count, x.t)
    tare = tare_of(k.mass, k.identify, sums, armed)
    push = (force + a * (tare.mass - k.mass) - tare.force) * x.airborne
    moment = (found.moment - tare.moment) * x.airborne - cross(k.payload, push)
    after = m._replace(observer=observer, specific_force=smooth, sums=sums)
    return PushAndState(concluded(k, R, push, moment, tare.mass, armed), after, state, navigated)


@law
def concluded(k: WrenchPush, R: Mat3, push: Vec3, moment: Vec3, mass: Number, armed: Number) -> PushEstimate:
    """The push from its force [N] and moment about the payload's centre of mass [N·m], body axes."""
    measured = apply(R, push)
    force, turning = measured * armed, moment * armed
    return PushEstimate(
        measured=measured,
        measured_moment=moment,
        force=force,
        moment=turning,
        point=point_of_application(k.off_center, k.reach, k.least, push * armed, turning),
        payload_mass=mass,
        disagreement=0.0,
        trusted=1.0,
        armed=armed,
        usable=force,
    )


def start_wrench_push(
    e: EstimatorTable, s: SensorsTable, vehicle: Vehicle, interval: float, late: float, floor: Number | None
) -> tuple[WrenchPush, WrenchPushState]:
    """The estimator of pushes by `estimator.wrench`, and its memory.

    `late`: delay of the rotors, as the pilot believes, and of the IMU [s]; `floor`: height z of one with ground effect
    [m], or None.
    """
    scale, motion = noise_scale(s, interval), s.motion
    noise = SampleNoise(
        s.accelerometer.noise * scale,
        s.gyroscope.noise * scale,
        motion.position_noise,
        motion.velocity_noise,
        motion.attitude_noise,
    )
    body = NominalBody(vehicle.mass, inertia_value(vehicle.inertia), inertia_value(inverse(vehicle.inertia)))
    observer, memory = OBSERVERS[e.wrench].start(e.wrench_observer, body, noise, interval)
    rotors, speeds = rotor_model(vehicle, interval)
    surface = ground_effect_from(vehicle, floor)
    delay, undelayed = rotor_delay(late + 0.5 * interval, vehicle.mass, noise.accelerometer, interval)
    payload = vehicle.payload
    push = WrenchPush(
        observer=observer,
        thrust=ThrustModel(rotors, delay, surface),
        payload=vec3(vehicle.payload_center),
        imu=OffCenter(vec3(vehicle.center_of_mass)),
        mass=number(payload.mass),
        low_pass=low_pass(e.push_bandwidth, interval),
        reach=math.inf if payload.span is None else 0.5 * payload.span,
        per_interval=1.0 / interval,
        least=e.min_force**2,
        **tare_fields(0.0 if e.tare == "hover" else e.tare_start, e.tare_duration, e.identify_mass),
        off_center=off_center_at(payload.center_of_mass),
    )
    still = ThrustState(speeds, undelayed)
    sums = TareSums(0.0, ZERO, ZERO, ZERO, 0.0, 0.0, SideForces(each(1)(0.0), each(1)(0.0)))
    return push, WrenchPushState(memory, still, ZERO, ZERO, LowPassState(UP * GRAVITY, ZERO), sums)
