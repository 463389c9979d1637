"""Supervision of the pilot's input and of the reference: valid numbers, the fence, and a blind descent."""

from __future__ import annotations

from tandemlift.core.algebra import chosen, clip, maximum, where
from tandemlift.core.law import Absent, choice, elementwise, law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.guidance.guidance import PilotInput
from tandemlift.parts.guidance.supervision import Supervision, SupervisionState
from tandemlift.parts.interaction.compliance import Compliance, ComplianceState, with_speed
from tandemlift.parts.interaction.requests import VehicleStatus
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.trajectories import Trajectory
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
def speed_limit(
    position: Number, velocity: Number, pull: Number, low: Number, high: Number, gain: Number, max_speed: Number
) -> Number:
    """The largest speed [m/s] of a reference towards the side of the fence to which it moves or is pulled."""
    toward = where(pull == 0.0, velocity, pull)
    return clip(gain * where(toward > 0.0, high - position, position - low), 0.0, max_speed)


@law(absent="compliance")
def fenced(k: Supervision, compliance: Compliance, m: ComplianceState, lift: Number) -> Compliance:
    """The compliance with speed limits that keep the reference inside the fence; `lift`: height already lifted [m]."""
    f, at, max_speed = k.fence, m.position + Vec3(0.0, 0.0, lift), compliance.limits.speed
    limit = speed_limit(at, m.velocity, m.output.value, f.low, f.high, f.braking_gain, max_speed)
    return with_speed(compliance, limit)


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
