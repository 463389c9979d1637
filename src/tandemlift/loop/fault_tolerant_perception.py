"""Sensors that fail, and perception under watchdogs: only what can be used reaches estimators and pilot."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, law
from tandemlift.algebra.ops import maximum, where
from tandemlift.algebra.vector import Vec3
from tandemlift.laws.estimation.navigation import centre_of_mass
from tandemlift.laws.estimation.push_estimate import Push
from tandemlift.laws.guidance.supervision import Senses, senses_of
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.sensors.readings import Readings, Sensing, Sensors, sense
from tandemlift.laws.sensors.sensor_faults import SensorFaults, Spoiling, chosen, chosen_attitude, spoil
from tandemlift.laws.sensors.watchdog import Predicted, Report, Watchdog, Watching, watch
from tandemlift.loop.estimate_channels import shown_estimate
from tandemlift.loop.perception import (
    Believed,
    Estimators,
    Known,
    Remembered,
    Sensed,
    estimate_all,
    sensed,
    tare_begun,
    tare_time,
    usable,
)


class Failing(NamedTuple):
    """Sensors, and the faults that they will have."""

    sensors: Sensors
    faults: SensorFaults


class FailingMemory(NamedTuple):
    """Memory of both."""

    sensing: Sensing
    spoiling: Spoiling


class Watched(NamedTuple):
    """Watchdogs, and the estimators behind them."""

    watchdog: Watchdog
    estimators: Estimators


class WatchedMemory(NamedTuple):
    """Memory of both."""

    watching: Watching
    remembered: Remembered


class Checked(NamedTuple):
    """What is estimated, as `Known`; the readings that can be used, and what is wrong with the sensors."""

    push: Push
    state: State
    vehicle: Believed
    readings: Readings
    report: Report


@sensed.register(Failing)
def _sensed_and_spoiled(sensors, memory, state, felt, believed, noise):
    readings, sensing = sense(sensors.sensors, memory.sensing, state, felt, believed, noise)
    given, spoiling = spoil(sensors.faults, memory.spoiling, readings)
    return given, FailingMemory(sensing, spoiling)


@law
def predicted(k: Estimators, m: Remembered) -> Predicted:
    """What the navigator expects."""
    return Predicted(centre_of_mass(k.state, m.state), m.state.gyroscope_bias, m.state.accelerometer_bias)


@law
def if_felt(p: Push, r: Report) -> Push:
    """The push, trusted only where joints and accelerometer can be."""
    well = where(r.joints + r.accelerometer + r.imu > 0.0, 0.0, 1.0)
    return Push(
        p.measured,
        p.measured_moment,
        p.force,
        p.moment,
        p.point,
        p.payload_mass,
        p.disagreement,
        p.trusted * well,
        p.armed,
        p.usable * well,
    )


@law
def at_best(s: State, readings: Readings, r: Report, rates: Vec3) -> State:
    """The estimate of the state, or the readings where the sensors that it rests on are lost; `rates`: as they turn."""
    no_force, no_turn = maximum(r.accelerometer, r.imu), maximum(r.gyroscope, r.imu)
    v = readings.motion
    return State(
        chosen(no_force, v.position, s.position),
        chosen(no_force, v.velocity, s.velocity),
        chosen_attitude(no_turn, v.attitude, s.attitude),
        chosen(no_turn, rates, s.rates),
    )


@tare_time.register(Watched)
def _tare_watched(estimators, guidance, t):
    return tare_begun(estimators.estimators.tare, guidance, t)


@estimate_all.register(Watched)
def _watched(k, m, readings, t, dt):
    clean, report, watching = watch(k.watchdog, m.watching, readings, predicted(k.estimators, m.remembered), dt)
    known, remembered = estimate_all(k.estimators, m.remembered, clean, t, dt)
    push, state = if_felt(known.push, report), at_best(known.state, clean, report, watching.rates)
    return Checked(push, state, known.vehicle, clean, report), WatchedMemory(watching, remembered)


@usable.register(Checked)
def _checked_readings(known, readings):
    return known.readings


@shown_estimate.register(Checked)
def _shown_checked(known):
    return shown_estimate(Known(known.push, known.state, known.vehicle))


@choice
def reported_by(known: Any) -> Any:
    """`Senses` of what is known."""


@reported_by.register(Checked)
def _reported(known):
    p, r = known.push, known.report
    apart = where(r.joints + r.accelerometer + r.imu > 0.0, 0.0, 1.0 - p.trusted)
    return Senses(r, apart, p.armed, p.payload_mass)


@senses_of.register(Sensed)
def _senses(what, payload):
    return reported_by(what.known)
