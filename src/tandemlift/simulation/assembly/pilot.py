"""A pilot made from a mission, for its nominal vehicle."""

from __future__ import annotations

from tandemlift.core.vector import ZERO
from tandemlift.missions import Mission
from tandemlift.parts.compliance.admittance import (
    AdmittanceState,
    admittance_from,
)
from tandemlift.parts.controllers import controller
from tandemlift.parts.estimation.disturbance_observer import start_observer
from tandemlift.parts.guidance.guidance import running_from
from tandemlift.parts.guidance.hand_guidance import HandGuidance, HandGuidanceState
from tandemlift.parts.guidance.scheduled_guidance import ScheduledGuidance
from tandemlift.parts.mechanics.trajectories import scheduled_phases
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.pilot.pilot import PilotMemory, PilotParameters
from tandemlift.parts.rotors.allocation import (
    mixer_of,
    start_allocation,
)
from tandemlift.parts.rotors.detection_table import start_detection
from tandemlift.parts.rotors.rotor_faults import NoFaults, RotorFaults, known_faults
from tandemlift.simulation.assembly.hand_guidance import start_hand_guidance


def _guidance(
    mission: Mission, vehicle: Vehicle, known: NoFaults | RotorFaults
) -> tuple[HandGuidance | ScheduledGuidance, AdmittanceState | HandGuidanceState]:
    """The guidance of a mission and its memory; `known`: the known rotor faults."""
    admittance = admittance_from(mission.admittance)
    if mission.pilot.guidance == "interactive":
        return start_hand_guidance(mission, vehicle, admittance, known)
    guidance = ScheduledGuidance(admittance, scheduled_phases(mission.phases), 0.0, running_from(mission.phases))
    return guidance, AdmittanceState(ZERO, ZERO, ZERO)


def start_pilot(mission: Mission, vehicle: Vehicle) -> tuple[PilotParameters, PilotMemory]:
    """The pilot of a mission before its first sample, for its nominal vehicle.

    Raises:
        InputError: the controller is not registered, or the allocation weights do not fit the vehicle.
    """
    step, initial, hovers = mission.mission.step, mission.initial, mission.actuators.start == "hover"
    known, effect = known_faults(mission.faults, vehicle), mixer_of(vehicle)
    gains, memory = controller(mission.controller.name).start(mission.controller, vehicle, step)
    guidance, guidance_memory = _guidance(mission, vehicle, known)
    observer, observer_memory = start_observer(mission.observer, vehicle, effect, step, initial, hovers=hovers)
    allocation, allocation_memory = start_allocation(mission.allocation, vehicle, known)
    detection, detection_memory = start_detection(mission.detection, vehicle, effect, step, initial, hovers=hovers)
    parameters = PilotParameters(guidance, observer, gains, allocation, detection)
    return parameters, PilotMemory(guidance_memory, observer_memory, memory, allocation_memory, detection_memory)
