"""The sensors of a mission, and the estimators of its pilot."""

from __future__ import annotations

import math

from tandemlift.core.vector import Absent, vec3
from tandemlift.missions import Mission
from tandemlift.parts.estimation.contact_table import start_contact_detection
from tandemlift.parts.estimation.navigation import navigator_from, start_navigation
from tandemlift.parts.estimation.push_confirmation import (
    start_confirmation,
)
from tandemlift.parts.estimation.push_estimate import push_estimator, start_push
from tandemlift.parts.estimation.wind_compensation import payload_drag_from
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.sensors.readings import Readings
from tandemlift.parts.sensors.sensors_table import steps_of
from tandemlift.simulation.loop.perception import Estimators, EstimatorState, TareAtTime, TareInHover
from tandemlift.simulation.loop.sources import NominalVehicle


def start_estimators(
    mission: Mission, vehicle: Vehicle, state: State, readings: Readings | Absent
) -> tuple[Estimators | Absent, EstimatorState | Absent]:
    """The estimators of a mission and their memory at t = 0, for the nominal vehicle; or `Absent`."""
    if isinstance(readings, Absent):
        return Absent(), Absent()
    e, s, step = mission.estimator, mission.sensors, mission.mission.step
    payload, quadrotors = vehicle.payload, vehicle.quadrotors
    push = push_estimator(
        mass=payload.mass,
        inertia=payload.moments,
        joints=[q.joint_position for q in quadrotors],
        quadrotors=[q.position for q in quadrotors],
        quadrotor_masses=[q.mass for q in quadrotors],
        step=step,
        imu_period=steps_of(s.interval, step),
        length=math.inf if payload.length is None else payload.length,
        bandwidth=e.push_bandwidth,
        min_force=e.min_force,
        tare_start=0.0 if e.tare == "hover" else e.tare_start,
        tare_duration=e.tare_duration,
        identify_mass=e.identify_mass,
        disagreement_limit=e.disagreement_limit,
        windage=Absent() if e.wind_compensation == "none" else payload_drag_from(vehicle, e.wind_bandwidth, step),
        system=vehicle.center_of_mass,
    )
    observer = navigator_from(e, s, vehicle, step)
    drag = vehicle.drag
    believed = NominalVehicle(vec3(-vehicle.center_of_mass), vec3(drag.force), vec3(drag.moment))
    tare = TareInHover() if e.tare == "hover" else TareAtTime()
    contact, no_contact = start_contact_detection(mission.contact, vehicle, step)
    confirmation, unconfirmed = start_confirmation(
        e,
        vehicle,
        step,
        threshold=mission.admittance.threshold,
        moment_threshold=mission.compliance.yaw.threshold,
        limited=mission.allocation.method == "constrained",
    )
    known = Estimators(push, observer, believed, tare, contact, confirmation)
    return known, EstimatorState(
        start_push(push, readings.imu), start_navigation(observer, state), no_contact, unconfirmed
    )
