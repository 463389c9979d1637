"""Supervision of the pilot's input and of the reference: valid numbers, the fence, and a blind descent."""

from __future__ import annotations

from tandemlift.core.algebra import chosen, clip, maximum
from tandemlift.core.law import Absent, choice, elementwise, law
from tandemlift.core.trajectories import Trajectory
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.guidance.compliance import Compliance, ComplianceState, with_speed
from tandemlift.parts.guidance.guidance import PilotInput
from tandemlift.parts.guidance.requests import VehicleStatus
from tandemlift.parts.guidance.supervision import Supervision, SupervisionState
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.health import any_component, not_finite
from tandemlift.parts.sensors.watchdog import state_not_finite

TOUCHDOWN_FACTOR = 8.0  # by which a blind descent accelerates at its end, so that the feet press on the ground


@choice
def usable_input(
    k: Supervision | Absent, m: SupervisionState | Absent, pilot_input: PilotInput, thrust: Number, rotor_failed: Number
) -> PilotInput:
    """The pilot's input with the status of the vehicle and, supervised, with finite state and push.

    `thrust` of all rotors [N]; `rotor_failed`: 1 once a rotor has failed, else 0.
    """


@usable_input.register(Absent)
def _unchecked(k: Absent, m: Absent, pilot_input: PilotInput, thrust: Number, rotor_failed: Number) -> PilotInput:
    return pilot_input._replace(status=VehicleStatus(rotor_failed, thrust, state_invalid=0.0))


@usable_input.register(Supervision)
def _with_numbers(
    k: Supervision, m: SupervisionState, pilot_input: PilotInput, thrust: Number, rotor_failed: Number
) -> PilotInput:
    invalid = state_not_finite(pilot_input.state)
    state = chosen(invalid, m.state, pilot_input.state)
    no_push = maximum(any_component(not_finite(pilot_input.push)), any_component(not_finite(pilot_input.moment)))
    push, moment = chosen(no_push, ZERO, pilot_input.push), chosen(no_push, ZERO, pilot_input.moment)
    status = VehicleStatus(rotor_failed, thrust, invalid)
    return pilot_input._replace(state=state, push=push, moment=moment, status=status)


@elementwise
def speed_limit(distance: Number, gain: Number, max_speed: Number) -> Number:
    """The largest speed [m/s] of a reference towards a side of the fence at a distance [m]."""
    return clip(gain * distance, 0.0, max_speed)


@law(absent="compliance")
def fenced(k: Supervision, compliance: Compliance, m: ComplianceState, lift: Number) -> Compliance:
    """The compliance with speed limits that keep the reference inside the fence; `lift`: height already lifted [m]."""
    f, at, most = k.fence, m.position + Vec3(0.0, 0.0, lift), compliance.limits
    speed = speed_limit(f.high - at, f.braking_gain, most.speed)
    return with_speed(compliance, speed, speed_limit(at - f.low, f.braking_gain, most.speed_back))


@law(absent="target")
def with_blind_descent(
    k: Supervision, target: Trajectory, state: State, blind: Number, landing: Number, fraction: Number
) -> Trajectory:
    """The reference; a level descent if the motion is unknown (`blind` 1) and the vehicle lands (1).

    `fraction` of the landing's time that is over: in the second half the descent accelerates, so that the feet press.
    """
    late = maximum(fraction - 0.5, 0.0)
    descent = k.blind_descent_acceleration
    return Trajectory(
        chosen(blind, state.position, target.position),
        chosen(blind, state.velocity, target.velocity),
        chosen(blind, Vec3(0.0, 0.0, -descent * landing * (1.0 + TOUCHDOWN_FACTOR * late)), target.acceleration),
    )
