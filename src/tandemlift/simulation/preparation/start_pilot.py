"""A pilot made from a mission, for its nominal vehicle: controller, guidance, observer, allocation, estimators."""

from __future__ import annotations

from collections.abc import Sequence

from tandemlift.core.algebra import minimum
from tandemlift.core.types import NEVER
from tandemlift.core.vector import ZERO, Absent, Vec3, each, vec3
from tandemlift.missions import Mission
from tandemlift.missions.facts import Facts
from tandemlift.parts.controllers import controller
from tandemlift.parts.estimation.contact_table import start_contact_detection
from tandemlift.parts.estimation.disturbance_observer import start_observer
from tandemlift.parts.estimation.fused_push import start_push_estimator
from tandemlift.parts.estimation.navigation import navigator_from, start_navigation
from tandemlift.parts.estimation.push_confirmation import start_confirmation
from tandemlift.parts.estimation.wrench_push import PushInputs, push_and_state
from tandemlift.parts.guidance.available import start_available
from tandemlift.parts.guidance.compliance_table import ComplianceTable, compliance_from, push_filters
from tandemlift.parts.guidance.contact_hold import start_contact_hold
from tandemlift.parts.guidance.guidance import flight_spans
from tandemlift.parts.guidance.hand_guidance import HandGuidance, HandGuidanceState
from tandemlift.parts.guidance.phases import PhaseSettings, start_phases
from tandemlift.parts.guidance.scheduled_guidance import ScheduledGuidance
from tandemlift.parts.guidance.supervision_table import start_supervision
from tandemlift.parts.guidance.yaw_compliance import start_heading
from tandemlift.parts.interaction.above_ground import GroundClearance
from tandemlift.parts.interaction.admittance import AdmittanceState, admittance_from, gate_from
from tandemlift.parts.interaction.alternation import start_alternation
from tandemlift.parts.interaction.compliance import start_compliance
from tandemlift.parts.interaction.energy_tank import start_tank
from tandemlift.parts.interaction.following import AT_REST, start_following
from tandemlift.parts.interaction.requests import RequestTable, start_requests
from tandemlift.parts.mechanics.low_pass import LowPassState
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.trajectories import PhasesTable, scheduled_phases
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.pilot.pilot import PilotMemory, PilotParameters
from tandemlift.parts.pilot.rotor_lead import start_lead
from tandemlift.parts.rotors.allocation import hover_moments, mixer_of, start_allocation
from tandemlift.parts.rotors.detection_table import start_detection
from tandemlift.parts.rotors.rotor_faults import RotorFaults, known_faults
from tandemlift.parts.sensors.readings import Readings
from tandemlift.parts.sensors.sensors_table import steps_of
from tandemlift.simulation.loop import perception
from tandemlift.simulation.loop.sources import NominalVehicle


def start_pilot(mission: Mission, vehicle: Vehicle) -> tuple[PilotParameters, PilotMemory]:
    """The pilot of a mission before its first sample, for its nominal vehicle.

    Raises:
        InputError: the controller is not registered, or the allocation weights do not fit the vehicle.
    """
    step, initial, hovers = mission.mission.step, mission.initial, mission.actuators.start == "hover"
    known, effect = known_faults(mission.faults, vehicle), mixer_of(vehicle)
    gains, memory = controller(mission.controller.name).start(mission.controller, vehicle, step)
    guidance, guidance_memory = (
        start_hand_guidance(mission, vehicle, known)
        if mission.pilot.guidance == "interactive"
        else start_scheduled_guidance(mission)
    )
    observer, observer_memory = start_observer(mission.observer, vehicle, effect, step, initial, hovers=hovers)
    allocation, allocation_memory = start_allocation(mission.allocation, vehicle, known)
    observed = mission.estimator.wrench not in ("joints", "fused")
    detection, detection_memory = start_detection(
        mission.detection, vehicle, effect, step, initial, hovers=hovers, observed=observed
    )
    lead, led = start_lead(mission.allocation, vehicle.weight, step, hovers=hovers)
    parts, _ = Facts(mission).started("pilot")
    parameters = PilotParameters(guidance, observer, gains, lead, allocation, detection, **parts)
    return parameters, PilotMemory(guidance_memory, observer_memory, memory, led, allocation_memory, detection_memory)


def start_scheduled_guidance(mission: Mission) -> tuple[ScheduledGuidance, AdmittanceState]:
    """Scheduled guidance before its first sample, and its memory."""
    table, p = mission.admittance, mission.phases
    flight, _ = flight_spans(p, mission.ground.model)
    rotors = Absent() if p.rotors == "always" else flight
    guidance = ScheduledGuidance(gate_from(table), admittance_from(table), scheduled_phases(p), 0.0, rotors, flight)
    return guidance, AdmittanceState(ZERO, ZERO, ZERO)


def phase_settings(
    p: PhasesTable, c: ComplianceTable, requests: Sequence[RequestTable], tare_duration: float
) -> PhaseSettings:
    """The parameters of lift and landing; `tare_duration` [s]: `estimator.tare_duration`."""
    return PhaseSettings(
        height=p.height,
        lift_start=p.lift_start,
        lift_rate=1.0 / p.lift_duration,
        land_start=NEVER if p.land_start is None else p.land_start,
        land_rate=1.0 / p.land_duration,
        touchdown_depth=c.touchdown_depth,
        spin_up_time=c.spin_up_time,
        always_running=1.0 if p.rotors == "always" else 0.0,
        max_descent_speed=c.max_descent_speed,
        tare_duration=tare_duration,
        requests=start_requests(requests),
    )


def start_hand_guidance(
    mission: Mission, vehicle: Vehicle, known: RotorFaults | Absent
) -> tuple[HandGuidance, HandGuidanceState]:
    """Interactive guidance before its first sample, and its memory; `known`: the known rotor faults."""
    c, of_controller = mission.compliance, getattr(mission.controller, "max_tilt", None)
    push, at_rest = push_filters(c, mission.mission.step), mission.phases.rotors == "always"
    at = ZERO if at_rest else Vec3(*mission.initial.position)
    supervision, supervising = start_supervision(mission.supervision, vehicle, mission.initial, known)
    tank, filled = start_tank(c.tank)
    heading, turned = start_heading(c.yaw, push, vehicle, 0.0 if at_rest else mission.initial.euler[2])
    contact, touching = start_contact_hold(mission.contact, mission.estimator.wrench)
    a = mission.admittance
    most = vec3(M * limit + F for M, limit, F in zip(a.mass, c.max_acceleration, a.threshold, strict=True))
    alternation, calm = start_alternation(
        c.alternation_share, most, vehicle, hover_moments(mission.allocation, vehicle), mission.mission.step
    )
    max_tilt = c.max_tilt if of_controller is None else minimum(c.max_tilt, of_controller)
    guided = HandGuidance(
        phasing=phase_settings(mission.phases, c, mission.requests, mission.estimator.tare_duration),
        compliance=compliance_from(
            *(c, push, admittance_from(mission.admittance), vec3(mission.admittance.threshold)),
            vehicle.payload.mass,
            alternation,
        ),
        tank=tank,
        heading=heading,
        moment=push.input,
        moment_lead=c.moment_lead,
        available=start_available(vehicle, c.thrust_fraction, c.max_tilt, known),
        clearance=GroundClearance(c.min_height) if mission.ground.model == "floor" else Absent(),
        following=start_following(c.following, vehicle, max_tilt, c.yaw.max_lead_angle),
        supervision=supervision,
        contact=contact,
    )
    no_push = LowPassState(ZERO, ZERO)
    memory = HandGuidanceState(
        start_phases(at.z), start_compliance(at, calm), filled, turned, no_push, AT_REST, supervising, touching
    )
    return guided, memory


def start_estimators(
    mission: Mission, vehicle: Vehicle, state: State, readings: Readings | Absent, floor: float | None
) -> tuple[perception.Estimators | Absent, perception.EstimatorState | Absent]:
    """The estimators of a mission and their memory at t = 0, for the nominal vehicle; or `Absent`.

    `floor`: height z [m] of a floor with ground effect, or None.
    """
    if isinstance(readings, Absent):
        return Absent(), Absent()
    e, s, period = mission.estimator, mission.sensors, steps_of(mission.sensors.interval, mission.mission.step)
    step = mission.mission.step
    interval, sampling = step * period, perception.Sampling(step * period) if period > 1 else Absent()
    late = mission.observer.rotor_delay + s.delay
    push, pushed = start_push_estimator(e, s, vehicle, readings.imu, interval, late, floor)
    stopped = each(vehicle.rotor_count)(*[0.0] * vehicle.rotor_count)
    observer = navigator_from(e, s, vehicle.center_of_mass, step)
    navigation, inputs = start_navigation(observer, state), PushInputs(readings, stopped, 0.0, 0.0, interval)
    first = push_and_state(push, pushed, observer, navigation, inputs).push
    drag = vehicle.drag
    believed = NominalVehicle(vec3(vehicle.payload_center), vec3(drag.force), vec3(drag.moment))
    tare = perception.TareInHover() if e.tare == "hover" else perception.TareAtTime()
    contact, no_contact = start_contact_detection(
        mission.contact, vehicle, interval, joints=e.wrench in ("joints", "fused")
    )
    confirmation, unconfirmed = start_confirmation(
        e,
        vehicle,
        interval,
        threshold=mission.admittance.threshold,
        moment_threshold=mission.compliance.yaw.threshold,
        limited=mission.allocation.method == "constrained",
    )
    by_hand = mission.pilot.guidance == "interactive"
    hover = Absent() if by_hand else flight_spans(mission.phases, mission.ground.model)[1]
    known = perception.Estimators(push, observer, believed, tare, contact, confirmation, sampling, hover)
    touching = Absent() if isinstance(no_contact, Absent) else no_contact.contact
    held = Absent() if isinstance(sampling, Absent) else perception.HeldEstimates(first, state, touching, 0.0)
    return known, perception.EstimatorState(pushed, navigation, no_contact, unconfirmed, held)
