"""Detectors that examine every step of a flight for findings; `simulation.findings` forms findings from their memory.

A detector is cheap while its limit is not exceeded: its memory changes only while it is, and in the step after.
`Detectors.awake` is 1 if that is so for any of them; while it is 0, compiled loops skip them.

A rotor that is known to the pilot as failed has no command, and does not count as saturated.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra import absolute, maximum, where
from tandemlift.core.law import law
from tandemlift.core.types import GRAVITY, Number, PerRotor
from tandemlift.core.vector import Absent, Vec3, dot, total
from tandemlift.parts.estimation.push_confirmation import refuted_push
from tandemlift.parts.guidance.guidance import thrust_fraction
from tandemlift.parts.mechanics.rotation import body_z_axis, wrap_angle
from tandemlift.parts.rotor_loss.detection import left_of
from tandemlift.parts.rotors.allocation import ConstrainedAllocation, Mixer, limits_at
from tandemlift.parts.rotors.rotors import Rotors
from tandemlift.simulation.loop.excess import NO_EXCESS, Excess, exceed
from tandemlift.simulation.loop.log_sample import Sample
from tandemlift.simulation.loop.oscillation import (
    NO_OSCILLATION,
    Oscillation,
    OscillationLimits,
    Swings,
    oscillation_step,
)
from tandemlift.simulation.loop.push_detectors import (
    NO_RESPONSE,
    UNMOVED,
    PushLimits,
    PushResponse,
    UnpushedMotion,
    push_step,
    push_to_answer,
    unpushed_step,
)
from tandemlift.simulation.loop.running_metrics import at_limit, counted
from tandemlift.simulation.loop.thrust_shake import ThrustShake, kept_awake, shake_step


class FindingLimits(NamedTuple):
    """The limits above which a flight has findings.

    `settled` [s]: start of the promise. Square of the promised distance [m²], the distance below the reference [m], the
    heading [rad]; the smallest cosine of the tilt. `mass` [kg]; the square of the largest `thrust` [N²]. `rate`
    [(rad/s)²]: square of the smallest oscillation of a body rate. `unpushed` [m]: largest motion of the reference
    without a push. `shake` [N²]: the largest mean square of the thrusts' deviations of an elastic vehicle.
    """

    settled: Number
    distance: Number
    sinking: Number
    heading: Number
    upright: Number
    mass: Number
    thrust: Number
    rate: Number
    push: PushLimits
    unpushed: Number
    oscillation: OscillationLimits
    shake: Number | Absent


class Detectors(NamedTuple):
    """Memory of the detectors: `awake` is 1 while one of them may have something to remember, else 0.

    `steps` in flight once settled, and the sum of the squared distances from the reference in them [m²]. Ideal rotors
    have no limits: `saturation` and `reach` are `Absent` with them; `shake` is of a rigid vehicle.
    """

    awake: Number
    steps: Number
    squares: Number
    oscillation: Oscillation
    distance: Excess
    sinking: Excess
    heading: Excess
    tilt: Excess
    saturation: Excess | Absent
    reach: Excess | Absent
    push: PushResponse
    unpushed: UnpushedMotion
    refuted: Excess
    shake: ThrustShake | Absent


class Watched(NamedTuple):
    """The inputs of the detectors in a step, each in the form of its limit, see `FindingLimits`.

    `swings`: signals that may oscillate. `limited`: rotors at a limit. `needed`: square of the thrust for the reference
    [N²]. `push` [N] that should move the vehicle. `pushed`: 1 while there is a true push, `followed`: 1 while one is
    followed, else 0. `refuted` [N]: part of a push that the motion refutes.
    """

    swings: Swings[Number]
    distance: Number
    sinking: Number
    heading: Number
    upright: Number
    limited: Number
    needed: Number
    push: Vec3
    pushed: Number
    followed: Number
    refuted: Vec3


ASLEEP = Detectors(
    awake=0.0,
    steps=0.0,
    squares=0.0,
    oscillation=NO_OSCILLATION,
    distance=NO_EXCESS,
    sinking=NO_EXCESS,
    heading=NO_EXCESS,
    tilt=NO_EXCESS,
    saturation=NO_EXCESS,
    reach=NO_EXCESS,
    push=NO_RESPONSE,
    unpushed=UNMOVED,
    refuted=NO_EXCESS,
    shake=Absent(),
)


@law(instead={Mixer: 1.0})
def usable_rotors(how: ConstrainedAllocation, left: Number, t: Number) -> PerRotor:
    """Above 0 for rotors usable at time t [s]: a number for all, or a set; `left`: of a detected loss."""
    return limits_at(how, left, t)


@law(absent=0.0)
def rotors_at_limit(rotors: Rotors, commands: PerRotor, usable: Number) -> Number:
    """The number of usable rotors that are commanded to a limit or beyond."""
    return total(counted(at_limit(commands, rotors.max_thrust), usable))


@law(absent=0.0)
def thrust_needed(reach: Excess, mass: Number, a: Vec3) -> Number:
    """The square of the thrust [N²] that an acceleration of the reference [m/s²] needs."""
    up = a.z + GRAVITY
    return (a.x * a.x + a.y * a.y + up * up) * (mass * mass)


@law
def watched(model: Any, output: Any, x: Sample, flying: Number, t: Number) -> Watched:
    """The inputs of the detectors in a step; `flying` is 1 in flight, else 0."""
    k, flight_state, decision = model.finding_limits, model.flight_state, output.decision
    left = left_of(model.pilot.detection, flight_state.memory.detection)
    error, gated, true = x.reference_position - x.position, decision.guidance.force, x.push_force
    return Watched(
        swings=Swings(x.rates.x, x.rates.y, x.rates.z, x.reference_velocity.z - x.velocity.z),
        distance=dot(error, error),
        sinking=error.z,
        heading=absolute(wrap_angle(x.reference_euler - x.euler).z),
        upright=body_z_axis(x.attitude).z,
        limited=rotors_at_limit(model.rotors, decision.thrusts, usable_rotors(model.pilot.allocation, left, t))
        * flying,
        needed=thrust_needed(flight_state.detectors.reach, k.mass, x.reference_acceleration),
        push=push_to_answer(k.push.threshold, k.push.least, gated, true),
        pushed=where(dot(true, true) <= k.push.least, 0.0, 1.0),  # also 1 if a simulator does not report the push
        followed=where(dot(gated, gated) > k.push.least, 1.0, 0.0),
        refuted=refuted_push(output.estimates),
    )


@law
def may_be_found(k: FindingLimits, w: Watched) -> Number:
    """1 if the memory of any detector may change, else 0; fast to compute, and never 0 if one changes."""
    s = w.swings
    found = where(dot(w.push, w.push) > k.push.least, 1.0, where(w.limited > 0.0, 1.0, 0.0))
    found = maximum(found, maximum(maximum(w.pushed, w.followed), where(dot(w.refuted, w.refuted) > 0.0, 1.0, 0.0)))
    found = where(w.needed > k.thrust, 1.0, where(w.upright < k.upright, 1.0, found))
    found = where(w.sinking > k.sinking, 1.0, found)
    found = where(w.heading > k.heading, 1.0, where(w.distance > k.distance, 1.0, found))
    found = where(absolute(s.vertical) < k.oscillation.levels.vertical, found, 1.0)
    return where(s.roll * s.roll + s.pitch * s.pitch + s.yaw * s.yaw < k.rate, found, 1.0)


@law
def detect(model: Any, output: Any, x: Sample, t: Number, dt: Number) -> Detectors:
    """The detectors' memory after the step from time t [s] by dt [s], whose sample is x."""
    k, m, guidance = model.finding_limits, model.flight_state.detectors, output.decision.guidance
    flying = guidance.flying * thrust_fraction(guidance.running)
    w, place = watched(model, output, x, flying, t), x.position
    settled = flying * where(t < k.settled, 0.0, 1.0)
    refuted = dot(w.refuted, w.refuted)
    return Detectors(
        awake=kept_awake(m.shake, may_be_found(k, w)),
        steps=m.steps + settled,
        squares=m.squares + w.distance * settled,
        oscillation=oscillation_step(k.oscillation, m.oscillation, w.swings, flying, t),
        distance=exceed(m.distance, where(w.distance > k.distance, settled, 0.0), w.distance, place, t, dt),
        sinking=exceed(m.sinking, where(w.sinking > k.sinking, settled, 0.0), w.sinking, place, t, dt),
        heading=exceed(m.heading, where(w.heading > k.heading, settled, 0.0), w.heading, place, t, dt),
        tilt=exceed(m.tilt, where(w.upright < k.upright, settled, 0.0), 1.0 - w.upright, place, t, dt),
        saturation=exceed(m.saturation, where(w.limited > 0.0, flying, 0.0), w.limited, place, t, dt),
        reach=exceed(m.reach, where(w.needed > k.thrust, flying, 0.0), w.needed, place, t, dt),
        push=push_step(k.push, m.push, w.push, x, settled, t, dt),
        unpushed=unpushed_step(
            k.unpushed, m.unpushed, (w.pushed, w.followed * flying), guidance.admittance.position, place, t, dt
        ),
        refuted=exceed(m.refuted, where(refuted > 0.0, flying, 0.0), refuted, place, t, dt),
        shake=shake_step(m.shake, k.shake, output.decision.thrusts, settled, place, t, dt),
    )
