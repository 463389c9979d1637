"""Faulty sensors, and perception with watchdogs: only usable readings reach the estimators and the pilot."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra import chosen, maximum, where
from tandemlift.core.law import choice, law
from tandemlift.core.types import Number, PerRotor
from tandemlift.core.vector import Absent, Quat, Vec3
from tandemlift.parts.contact.walls import NearWalls
from tandemlift.parts.estimation.contact_detection import ContactEstimate, KnownSurroundings, shaken
from tandemlift.parts.estimation.navigation import centre_of_mass
from tandemlift.parts.estimation.push_confirmation import refuted_push
from tandemlift.parts.estimation.push_estimate import PushEstimate
from tandemlift.parts.guidance.guidance import identified_payload
from tandemlift.parts.guidance.hand_guidance import HandGuidanceState
from tandemlift.parts.guidance.preflight_checks import SensorStatus, sensor_status
from tandemlift.parts.mechanics.joint_loads import PerfectReadings
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.sensors.health import WatchdogReport
from tandemlift.parts.sensors.readings import Readings, SensorNoise, Sensors, SensorState, readings_of, sense
from tandemlift.parts.sensors.sensor_faults import SensorFaults, SensorFaultState, apply_faults
from tandemlift.parts.sensors.sensors_table import SensorsTable
from tandemlift.parts.sensors.substitutes import PredictedReadings
from tandemlift.parts.sensors.watchdog import (
    Watchdog,
    WatchdogState,
    WatchTable,
    start_watchdog,
    watchdog_from,
    watchdog_step,
)
from tandemlift.simulation.loop.estimate_channels import EstimatedChannels, estimated_channels
from tandemlift.simulation.loop.perception import (
    Estimates,
    Estimators,
    EstimatorState,
    PerceptionData,
    estimate_all,
    measure,
    surroundings_of,
    tare_begun,
    tare_time,
    usable,
)
from tandemlift.simulation.loop.sources import EstimatedFlight, NominalVehicle, PilotSources


class FaultySensors(NamedTuple):
    """Sensors, and their faults."""

    sensors: Sensors
    faults: SensorFaults


class FaultySensorsState(NamedTuple):
    """Memory of both."""

    sensing: SensorState
    faults: SensorFaultState


class WatchedEstimators(NamedTuple):
    """Watchdogs, and the estimators that use the readings after them."""

    watchdog: Watchdog
    estimators: Estimators


class WatchedEstimatorsState(NamedTuple):
    """Memory of both."""

    watchdog: WatchdogState
    estimators: EstimatorState


class CheckedEstimates(NamedTuple):
    """The `Estimates`, the usable readings, and the report on the sensors."""

    push: PushEstimate
    state: State
    vehicle: NominalVehicle
    contact: ContactEstimate | Absent
    readings: Readings
    report: WatchdogReport


@measure.register(FaultySensors)
def _with_faults(
    sensors: FaultySensors,
    memory: FaultySensorsState,
    state: State,
    perfect: PerfectReadings,
    believed: Quat,
    noise: SensorNoise,
) -> tuple[Readings, FaultySensorsState]:
    readings, sensing = sense(sensors.sensors, memory.sensing, state, perfect, believed, noise)
    given, faults = apply_faults(sensors.faults, memory.faults, readings)
    return given, FaultySensorsState(sensing, faults)


@law
def predicted(k: Estimators, m: EstimatorState) -> PredictedReadings:
    """The prediction of the navigator."""
    return PredictedReadings(centre_of_mass(k.state, m.state), m.state.gyroscope_bias, m.state.accelerometer_bias)


@law
def trusted_push(p: PushEstimate, r: WatchdogReport) -> PushEstimate:
    """The push, trusted only while joints and accelerometer are sound."""
    sound = where(r.joints + r.accelerometer + r.imu > 0.0, 0.0, 1.0)
    return p._replace(trusted=p.trusted * sound, usable=p.usable * sound)


@law
def without_blow(r: WatchdogReport, blow: Number) -> WatchdogReport:
    """The report; in an impact (1) accelerometer and velocity are of different times, and differ without a fault."""
    return r._replace(speed_inconsistent=r.speed_inconsistent * (1.0 - blow))


@law
def best_state(s: State, readings: Readings, r: WatchdogReport, rates: Vec3) -> State:
    """The estimated state, or readings if the estimate's sensors are lost; `rates`: measured or substituted."""
    no_accelerometer, no_gyroscope = maximum(r.accelerometer, r.imu), maximum(r.gyroscope, r.imu)
    v = readings.motion
    return State(
        chosen(no_accelerometer, v.position, s.position),
        chosen(no_accelerometer, v.velocity, s.velocity),
        chosen(no_gyroscope, v.attitude, s.attitude),
        chosen(no_gyroscope, rates, s.rates),
    )


@tare_time.register(WatchedEstimators)
def _tare_watched(estimators: WatchedEstimators, guidance: HandGuidanceState, t: Number) -> Number:
    return tare_begun(estimators.estimators.tare, guidance, t)


@estimate_all.register(WatchedEstimators)
def _watched(
    k: WatchedEstimators,
    m: WatchedEstimatorsState,
    readings: Readings,
    surroundings: KnownSurroundings,
    commands: PerRotor,
    t: Number,
    dt: Number,
) -> tuple[CheckedEstimates, WatchedEstimatorsState]:
    usable_readings, report, watchdog = watchdog_step(
        k.watchdog, m.watchdog, readings, predicted(k.estimators, m.estimators), dt
    )
    known, estimators = estimate_all(k.estimators, m.estimators, usable_readings, surroundings, commands, t, dt)
    report = without_blow(report, shaken(estimators.contact))
    push, state = trusted_push(known.push, report), best_state(known.state, usable_readings, report, watchdog.rates)
    checked = CheckedEstimates(push, state, known.vehicle, known.contact, usable_readings, report)
    return checked, WatchedEstimatorsState(watchdog, estimators)


@surroundings_of.register(WatchedEstimators)
def _surroundings(
    k: WatchedEstimators, sources: PilotSources, near: NearWalls | Absent, guidance: HandGuidanceState
) -> KnownSurroundings:
    return surroundings_of(k.estimators, sources, near, guidance)


@usable.register(CheckedEstimates)
def _checked_readings(known: CheckedEstimates, readings: Readings) -> Readings:
    return known.readings


@estimated_channels.register(CheckedEstimates)
def _shown_checked(known: CheckedEstimates) -> EstimatedChannels:
    return estimated_channels(Estimates(known.push, known.state, known.vehicle, known.contact))


@choice
def reported_by(known: EstimatedFlight) -> SensorStatus:
    """The `SensorStatus` of estimates."""


@reported_by.register(CheckedEstimates)
def _reported(known: CheckedEstimates) -> SensorStatus:
    p, r = known.push, known.report
    inconsistent = where(r.joints + r.accelerometer + r.imu > 0.0, 0.0, 1.0 - p.trusted)
    return SensorStatus(r, inconsistent, p.armed, p.payload_mass)


@refuted_push.register(CheckedEstimates)
def _refuted(known: CheckedEstimates) -> Vec3:
    return known.push.withheld * known.push.refuted


@sensor_status.register(PerceptionData)
def _senses(what: PerceptionData, payload: Number) -> SensorStatus:
    return reported_by(what.known)


@identified_payload.register(PerceptionData)
def _identified(what: PerceptionData, nominal: Number) -> Number:
    return what.known.push.payload_mass


def with_faults(faults: SensorFaults, devices: Any, sensing: Any) -> tuple[Any, Any]:
    """Sensors and their memory, with these faults."""
    if not isinstance(sensing, SensorState):
        return devices, sensing
    return FaultySensors(devices, faults), FaultySensorsState(sensing, SensorFaultState(readings_of(sensing), 0.0))


def with_watchdogs(
    table: WatchTable, sensors: SensorsTable, step: float, estimators: Any, memory: Any, readings: Any
) -> tuple[Any, Any]:
    """Estimators and their memory, with watchdogs before them."""
    if isinstance(estimators, Absent):
        return estimators, memory
    watchdog = watchdog_from(table, sensors, step)
    return WatchedEstimators(watchdog, estimators), WatchedEstimatorsState(start_watchdog(readings), memory)
