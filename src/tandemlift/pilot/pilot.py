"""The pilot: from a measurement to rotor thrusts, the same for every body that it flies.

measured push → guidance (gate, admittance, phases) → reference → controller → wrench → allocation → thrusts, and beside
it the observer of what else acts on the vehicle. It is sampled every `mission.step`; everything that it computes is
held until the next sample. `pilot.assemble` makes one from a mission.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, law
from tandemlift.algebra.vector import total
from tandemlift.controllers import Command, Disturbance, Measured, control
from tandemlift.laws.estimation.disturbance_observer import DisturbanceEstimate, last_known, observer_step
from tandemlift.laws.estimation.rotor_loss_detection import detection_step, failed_rotors
from tandemlift.laws.guidance.guidance import Guidance, PilotInput, checked_input, guide, running
from tandemlift.laws.rotors.allocation import AllocationState, allocate

__all__ = [
    "ControlInput",
    "Decision",
    "PilotInput",
    "PilotMemory",
    "PilotParameters",
    "control_input",
    "decide",
    "with_command",
]


class PilotParameters(NamedTuple):
    """Numbers of the pilot; the types of its members pick the laws."""

    guidance: Any
    observer: Any
    controller: Any
    allocation: Any
    detection: Any


class PilotMemory(NamedTuple):
    """What the pilot carries from sample to sample."""

    guidance: Any
    observer: Any
    controller: Any
    allocation: Any
    detection: Any


class ControlInput(NamedTuple):
    """What the pilot knows before it controls: what it measured, where to, what disturbs; and its parts' memories."""

    measured: Measured
    guidance: Guidance
    unknown: DisturbanceEstimate
    guidance_memory: Any
    observer_memory: Any
    detection_memory: Any


class Decision(NamedTuple):
    """One sample of the pilot: guidance, what disturbs, command, and the thrust of every rotor [N]."""

    guidance: Guidance
    unknown: DisturbanceEstimate
    command: Command
    thrusts: Any


@choice(absent="allocation")
def given_thrusts(allocation: Any) -> Any:
    """The thrusts [N] that the allocation gave at the last sample, from its memory."""


@given_thrusts.register(AllocationState)
def _within_limits(allocation):
    return allocation.thrusts


@choice(absent=0.0)
def given_thrust(allocation: Any) -> Any:
    """The thrust of all rotors [N] that the allocation gave at the last sample; 0 if it does not keep it."""


@given_thrust.register(AllocationState)
def _all_together(allocation):
    return total(allocation.thrusts)


@law
def control_input(p: PilotParameters, m: PilotMemory, heard: PilotInput, t: Any, dt: Any) -> ControlInput:
    """What there is to know at time t [s] before the controller is asked."""
    before, lost = last_known(p.observer, m.observer), failed_rotors(p.detection, m.detection, t)
    heard = checked_input(p.guidance, m.guidance, heard, given_thrust(m.allocation), lost)
    guidance, guided = guide(p.guidance, m.guidance, heard, before, lost, t, dt)
    given = given_thrusts(m.allocation)
    flying, learning = guidance.flying, guidance.learning
    unknown, observing = observer_step(p.observer, m.observer, heard, given, flying, learning, dt)
    watching = detection_step(p.detection, m.detection, heard, given, flying * learning, t, dt)
    disturbance = Disturbance(unknown.force, unknown.moment + guidance.moment)
    return ControlInput(
        Measured(heard.state, guidance.push, disturbance), guidance, unknown, guided, observing, watching
    )


@law
def with_command(p: PilotParameters, m: PilotMemory, briefed: ControlInput, command: Command, memory: Any) -> Any:
    """(Decision, the new memory) once the controller has commanded; `memory` is the controller's."""
    thrusts = running(briefed.guidance.running, allocate(p.allocation, command.wrench))
    decision = Decision(briefed.guidance, briefed.unknown, command, thrusts)
    after = PilotMemory(
        briefed.guidance_memory, briefed.observer_memory, memory, m.allocation, briefed.detection_memory
    )
    return decision, after


@law
def decide(p: PilotParameters, m: PilotMemory, heard: PilotInput, t: Any, dt: Any) -> Any:
    """One sample of the pilot at time t [s], held for dt [s]: (Decision, the new memory).

    Thrusts are not limited yet where the allocation is `Constrained`.
    """
    briefed = control_input(p, m, heard, t, dt)
    command, memory = control(p.controller, m.controller, briefed.measured, briefed.guidance.reference)
    return with_command(p, m, briefed, command, memory)


@law
def with_allocation(m: PilotMemory, allocation: Any) -> PilotMemory:
    """A pilot's memory with that of an allocation within limits."""
    return PilotMemory(m.guidance, m.observer, m.controller, allocation, m.detection)


@law
def with_thrusts(d: Decision, thrusts: Any) -> Decision:
    """A decision with other thrusts [N]."""
    return Decision(d.guidance, d.unknown, d.command, thrusts)
