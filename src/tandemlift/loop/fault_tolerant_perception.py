"""Sensors that fail, and perception under watchdogs: only what can be used reaches estimators and pilot."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, law
from tandemlift.algebra.ops import maximum, where
from tandemlift.algebra.selection import chosen
from tandemlift.algebra.vector import Quat, Vec3
from tandemlift.laws.estimation.navigation import centre_of_mass
from tandemlift.laws.estimation.push_estimate import PushEstimate
from tandemlift.laws.guidance.preflight_checks import SensorStatus, sensor_status
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.sensors.readings import Readings, Sensors, SensorState, sense
from tandemlift.laws.sensors.sensor_faults import SensorFaults, SensorFaultState, apply_faults
from tandemlift.laws.sensors.watchdog import PredictedReadings, Watchdog, WatchdogReport, WatchdogState, watchdog_step
from tandemlift.loop.estimate_channels import estimated_channels
from tandemlift.loop.perception import (
    Estimates,
    Estimators,
    EstimatorState,
    NominalVehicle,
    PerceptionData,
    estimate_all,
    measure,
    tare_begun,
    tare_time,
    usable,
)


class FaultySensors(NamedTuple):
    """Sensors, and the faults that they will have."""

    sensors: Sensors
    faults: SensorFaults


class FaultySensorsState(NamedTuple):
    """Memory of both."""

    sensing: SensorState
    faults: SensorFaultState


class WatchedEstimators(NamedTuple):
    """Watchdogs, and the estimators behind them."""

    watchdog: Watchdog
    estimators: Estimators


class WatchedEstimatorsState(NamedTuple):
    """Memory of both."""

    watching: WatchdogState
    remembered: EstimatorState


class CheckedEstimates(NamedTuple):
    """What is estimated, as `Estimates`; the readings that can be used, and what is wrong with the sensors."""

    push: PushEstimate
    state: State
    vehicle: NominalVehicle
    readings: Readings
    report: WatchdogReport


@measure.register(FaultySensors)
def _sensed_and_spoiled(
    sensors: FaultySensors, memory: Any, state: State, felt: Any, believed: Quat, noise: Any
) -> Any:
    readings, sensing = sense(sensors.sensors, memory.sensing, state, felt, believed, noise)
    given, faults = apply_faults(sensors.faults, memory.faults, readings)
    return given, FaultySensorsState(sensing, faults)


@law
def predicted(k: Estimators, m: EstimatorState) -> PredictedReadings:
    """What the navigator expects."""
    return PredictedReadings(centre_of_mass(k.state, m.state), m.state.gyroscope_bias, m.state.accelerometer_bias)


@law
def trusted_push(p: PushEstimate, r: WatchdogReport) -> PushEstimate:
    """The push, trusted only where joints and accelerometer can be."""
    well = where(r.joints + r.accelerometer + r.imu > 0.0, 0.0, 1.0)
    return p._replace(trusted=p.trusted * well, usable=p.usable * well)


@law
def at_best(s: State, readings: Readings, r: WatchdogReport, rates: Vec3) -> State:
    """The estimate of the state, or the readings where the sensors that it rests on are lost; `rates`: as they turn."""
    no_force, no_turn = maximum(r.accelerometer, r.imu), maximum(r.gyroscope, r.imu)
    v = readings.motion
    return State(
        chosen(no_force, v.position, s.position),
        chosen(no_force, v.velocity, s.velocity),
        chosen(no_turn, v.attitude, s.attitude),
        chosen(no_turn, rates, s.rates),
    )


@tare_time.register(WatchedEstimators)
def _tare_watched(estimators: WatchedEstimators, guidance: Any, t: Any) -> Any:
    return tare_begun(estimators.estimators.tare, guidance, t)


@estimate_all.register(WatchedEstimators)
def _watched(k: WatchedEstimators, m: Any, readings: Any, t: Any, dt: Any) -> Any:
    clean, report, watching = watchdog_step(k.watchdog, m.watching, readings, predicted(k.estimators, m.remembered), dt)
    known, remembered = estimate_all(k.estimators, m.remembered, clean, t, dt)
    push, state = trusted_push(known.push, report), at_best(known.state, clean, report, watching.rates)
    return CheckedEstimates(push, state, known.vehicle, clean, report), WatchedEstimatorsState(watching, remembered)


@usable.register(CheckedEstimates)
def _checked_readings(known: CheckedEstimates, readings: Any) -> Any:
    return known.readings


@estimated_channels.register(CheckedEstimates)
def _shown_checked(known: CheckedEstimates) -> Any:
    return estimated_channels(Estimates(known.push, known.state, known.vehicle))


@choice
def reported_by(known: Any) -> Any:
    """`SensorStatus` of what is known."""


@reported_by.register(CheckedEstimates)
def _reported(known: CheckedEstimates) -> Any:
    p, r = known.push, known.report
    apart = where(r.joints + r.accelerometer + r.imu > 0.0, 0.0, 1.0 - p.trusted)
    return SensorStatus(r, apart, p.armed, p.payload_mass)


@sensor_status.register(PerceptionData)
def _senses(what: PerceptionData, payload: Any) -> Any:
    return reported_by(what.known)
