"""The watchdogs of a mission, and the faults of its sensors."""

from __future__ import annotations

import math
from typing import Any

from tandemlift.core.algebra.ops import exp, minimum, where
from tandemlift.core.algebra.types import Number
from tandemlift.core.algebra.vector import Nothing, vec3
from tandemlift.core.sensors import sensors_named
from tandemlift.core.settings import Mission, SensorFaultTable
from tandemlift.parts.sensors.health import AttitudeLimits, JointLimits, PerSensor, VectorLimits
from tandemlift.parts.sensors.readings import SensorState, readings_of
from tandemlift.parts.sensors.sensor_faults import (
    NEVER,
    SOUND,
    SensorFault,
    SensorFaultState,
    all_faults,
    sensor_fault,
)
from tandemlift.parts.sensors.watchdog import Watchdog, start_watchdog
from tandemlift.simulation.assembly.sensors import steps_of
from tandemlift.simulation.loop.fault_tolerant_perception import (
    FaultySensors,
    FaultySensorsState,
    WatchedEstimators,
    WatchedEstimatorsState,
)


def _steps(f: SensorFaultTable, step: float) -> tuple[float, float]:
    """The first step with a fault, and the first one without it again."""

    def steps(time: float) -> float:
        return float(round(min(time / step, NEVER)))

    return steps(f.time), NEVER if f.until is None else steps(f.until)


def with_faults(mission: Mission, devices: Any, sensing: Any) -> tuple[Any, Any]:
    """Sensors and their memory, with the faults that a mission gives them."""
    if not mission.sensor_faults or not isinstance(sensing, SensorState):
        return devices, sensing
    step, stale, faults = mission.mission.step, dict[str, tuple[float, float]](), dict[str, SensorFault]()
    joints = [SOUND] * len(mission.vehicle.quadrotors)
    for f in mission.sensor_faults:
        if f.kind == "stale":
            stale[f.sensor] = _steps(f, step)
            continue
        fault = sensor_fault(f.kind, *_steps(f, step), vec3(f.size))
        names = sensors_named(f.sensor)
        faults |= dict.fromkeys(names, fault)
        if "joints" in names:
            joints = [fault if f.quadrotor in (None, i) else old for i, old in enumerate(joints, 1)]
    known = all_faults(joints, faults, stale, [s.name for s in mission.sensors.additional])
    memory = FaultySensorsState(sensing, SensorFaultState(readings_of(sensing), 0.0))
    return FaultySensors(devices, known), memory


def _limits(mission: Mission) -> PerSensor:
    """The limits of every sensor; one without noise is never frozen."""
    s, w = mission.sensors, mission.supervision.watchdog

    def frozen(noise: Number) -> Number:
        return where(noise > 0.0, float(w.frozen_samples), math.inf)

    return PerSensor(
        joints=JointLimits(w.max_force, w.max_torque, frozen(s.joints.force_noise)),
        accelerometer=VectorLimits(w.max_specific_force, frozen(s.accelerometer.noise)),
        gyroscope=VectorLimits(w.max_rates, frozen(s.gyroscope.noise)),
        position=VectorLimits(w.max_position, frozen(s.motion.position_noise)),
        velocity=VectorLimits(w.max_velocity, frozen(s.motion.velocity_noise)),
        attitude=AttitudeLimits(frozen(s.motion.attitude_noise)),
    )


def with_watchdogs(mission: Mission, estimators: Any, memory: Any, readings: Any) -> tuple[Any, Any]:
    """Estimators and their memory, with the watchdogs of a mission before them if it has any."""
    if mission.supervision.model == "none" or isinstance(estimators, Nothing):
        return estimators, memory
    w, step = mission.supervision.watchdog, mission.mission.step
    interval = step * steps_of(mission.sensors.motion.interval, step)
    watchdog = Watchdog(
        stale_time=w.stale_time,
        invalid_time=w.invalid_time,
        sensors=_limits(mission),
        forgetting=minimum(interval / w.window, 1.0),
        attitude_gap=w.attitude_gap,
        position_gap=w.position_gap,
        velocity_gap=w.speed_gap,
        rates_gain=1.0 - exp(-w.rates_bandwidth * interval),
        velocity_gain=1.0 - exp(-w.velocity_bandwidth * interval),
        motion_rate=1.0 / interval,
    )
    return WatchedEstimators(watchdog, estimators), WatchedEstimatorsState(start_watchdog(readings), memory)
