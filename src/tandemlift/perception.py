"""What the pilot perceives: sensors' readings, what is estimated from them, and which of them it reads."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.law import choice, law
from tandemlift.laws.body import State
from tandemlift.laws.estimation import Push, PushEstimator, estimate
from tandemlift.laws.navigation import Navigator, navigate
from tandemlift.laws.push import moment_of
from tandemlift.laws.rotation import rotation_from_quaternion
from tandemlift.laws.sensing import Readings, Sensors, sense
from tandemlift.vector import Nothing, Quat, Vec3, apply_transposed, cross


class Truth(NamedTuple):
    """The pilot reads what is true."""


class Measurement(NamedTuple):
    """The pilot reads what sensors measure."""


class Estimate(NamedTuple):
    """The pilot reads what is estimated."""


class Touch(NamedTuple):
    """A push: force [N, world axes] and moment about the system's centre of mass [N·m, body axes]."""

    force: Vec3
    moment: Vec3


class Sensed(NamedTuple):
    """What sensors read and what estimators know."""

    readings: Any
    known: Any


class Reads(NamedTuple):
    """What the pilot reads of the state, and of the push."""

    state: Any
    push: Any


class Believed(NamedTuple):
    """What is believed of the vehicle.

    The payload's centre of mass from the system's [m, body axes], and linear drag, which the joints feel as they feel a
    push: of force on world velocity [N·s/m], of moment on body rates [N·m·s].
    """

    payload: Vec3
    drag_force: Vec3
    drag_moment: Vec3


class Estimators(NamedTuple):
    """Of the push, and of the state; and what is believed of the vehicle."""

    push: PushEstimator
    state: Navigator
    vehicle: Believed


class Remembered(NamedTuple):
    """Memory of the estimators."""

    push: Any
    state: Any


class Known(NamedTuple):
    """What is estimated; and what is believed of the vehicle."""

    push: Push
    state: State
    vehicle: Believed


class MeasuredChannels(NamedTuple):
    """What sensors show: the last readings that the pilot has."""

    measured_position: Vec3
    measured_velocity: Vec3
    measured_attitude: Quat
    measured_rates: Vec3
    measured_specific_force: Vec3
    measured_joint_force: Vec3
    measured_joint_torque: Vec3


class EstimatedChannels(NamedTuple):
    """What is estimated from them."""

    estimated_position: Vec3
    estimated_velocity: Vec3
    estimated_attitude: Quat
    estimated_rates: Vec3
    push_measured: Vec3
    push_estimate: Vec3
    push_moment_estimate: Vec3
    push_point_estimate: Any
    payload_mass_estimate: Any
    sensor_disagreement: Any
    push_usable: Any


@choice
def sensed(sensors: Any, memory: Any, state: State, felt: Any, believed: Quat, noise: Any) -> Any:
    """(Readings of a step, the sensors' memory)."""


@sensed.register(Nothing)
def _blind(sensors, memory, state, felt, believed, noise):
    return sensors, memory


@sensed.register(Sensors)
def _sensed(sensors, memory, state, felt, believed, noise):
    return sense(sensors, memory, state, felt, believed, noise)


@choice
def estimate_all(estimators: Any, memory: Any, readings: Any, t: Any, dt: Any) -> Any:
    """(what is known from readings, the estimators' memory) at time t [s]."""


@estimate_all.register(Nothing)
def _unknowing(estimators, memory, readings, t, dt):
    return estimators, memory


@estimate_all.register(Estimators)
def _estimated(estimators, memory, readings, t, dt):
    push, push_memory = estimate(estimators.push, memory.push, readings.unit, t)
    state, state_memory = navigate(estimators.state, memory.state, readings)
    return Known(push, state, estimators.vehicle), Remembered(push_memory, state_memory)


@choice
def read_state(reads: Any, true: State, readings: Any, known: Any) -> Any:
    """The state as the pilot reads it."""


@read_state.register(Truth)
def _true_state(reads, true, readings, known):
    return true


@read_state.register(Measurement)
def _measured_state(reads, true, readings, known):
    motion = readings.motion
    return State(motion.position, motion.velocity, motion.attitude, readings.unit.rates)


@read_state.register(Estimate)
def _estimated_state(reads, true, readings, known):
    return known.state


@choice
def read_push(reads: Any, true: Any, state: State, known: Any) -> Any:
    """The push as the pilot reads it, a `Touch`, in a state that it believes in. `true`: as it is."""


@read_push.register(Truth)
def _true_push(reads, true, state, known):
    return Touch(true.force, moment_of(true, state.attitude))


@read_push.register(Measurement)
def _measured_push(reads, true, state, known):
    p = known.push
    return felt(known.vehicle, state, p.measured, p.measured_moment, p.trusted * p.armed)


@read_push.register(Estimate)
def _estimated_push(reads, true, state, known):
    p = known.push
    return felt(known.vehicle, state, p.force, p.moment, p.trusted * p.armed)


@law
def felt(vehicle: Believed, state: State, force: Vec3, moment: Vec3, heard: Any) -> Touch:
    """A push on the payload, less what drag does, about the system's centre of mass; nothing if not `heard` (0).

    `force` [N, world axes]; `moment` [N·m, body axes] is about the payload's centre of mass.
    """
    push = force + vehicle.drag_force * state.velocity
    arm = cross(vehicle.payload, apply_transposed(rotation_from_quaternion(state.attitude), push))
    return Touch(push * heard, (moment + vehicle.drag_moment * state.rates + arm) * heard)


@choice
def all_sensed(readings: Any, known: Any) -> Any:
    """What is sensed, or `Nothing`."""


@all_sensed.register(Nothing)
def _nothing_sensed(readings, known):
    return readings


@all_sensed.register(Readings)
def _some_sensed(readings, known):
    return Sensed(readings, known)


@choice
def shown_readings(readings: Any) -> Any:
    """The channels of readings."""


@shown_readings.register(Nothing)
def _no_readings(readings):
    return readings


@shown_readings.register(Readings)
def _readings(readings):
    m, u = readings.motion, readings.unit
    return MeasuredChannels(
        m.position, m.velocity, m.attitude, u.rates, u.specific_force, u.joint_force, u.joint_torque
    )


@choice
def shown_estimate(known: Any) -> Any:
    """The channels of what is estimated."""


@shown_estimate.register(Nothing)
def _no_estimate(known):
    return known


@shown_estimate.register(Known)
def _estimate(known):
    s, p = known.state, known.push
    return EstimatedChannels(
        s.position,
        s.velocity,
        s.attitude,
        s.rates,
        p.measured,
        p.force,
        p.moment,
        p.point,
        p.payload_mass,
        p.disagreement,
        p.trusted * p.armed,
    )


READS = {"truth": Truth(), "measurement": Measurement(), "estimate": Estimate()}
