"""The watchdogs of a mission, and the faults that its sensors will have."""

from __future__ import annotations

import math
from typing import Any

from tandemlift.algebra.vector import Nothing, vec3
from tandemlift.laws.sensors.health import FrozenLimits, ReadingRanges
from tandemlift.laws.sensors.readings import SensorState
from tandemlift.laws.sensors.sensor_faults import (
    NEVER,
    SOUND,
    DeviceSilence,
    SensorFault,
    SensorFaults,
    SensorFaultState,
    sensor_fault,
    together,
)
from tandemlift.laws.sensors.watchdog import Watchdog, start_watchdog
from tandemlift.loop.fault_tolerant_perception import (
    FaultySensors,
    FaultySensorsState,
    WatchedEstimators,
    WatchedEstimatorsState,
)
from tandemlift.settings import Mission, SensorFaultTable
from tandemlift.simulation.sensors import steps_of

ON = {"imu": ("joints", "accelerometer", "gyroscope"), "motion": ("position", "velocity", "attitude")}


def _steps(f: SensorFaultTable, step: float) -> tuple[float, float]:
    """The steps from which on and before which a fault is there."""

    def steps(time: float) -> float:
        return float(round(min(time / step, NEVER)))

    return steps(f.time), NEVER if f.until is None else steps(f.until)


def _fault(f: SensorFaultTable, step: float) -> SensorFault:
    return sensor_fault(f.kind, *_steps(f, step), vec3(f.size))


def with_faults(mission: Mission, devices: Any, sensing: Any) -> tuple[Any, Any]:
    """Sensors and their memory, with the faults that a mission gives them."""
    if not mission.sensor_faults or not isinstance(sensing, SensorState):
        return devices, sensing
    step, count = mission.mission.step, len(mission.vehicle.quadrotors)
    silence: dict[str, Any] = {name: DeviceSilence(NEVER, NEVER) for name in ON}
    faults: dict[str, Any] = dict.fromkeys((*ON["imu"], *ON["motion"]), SOUND)
    joints = [SOUND] * count
    for f in mission.sensor_faults:
        if f.kind == "stale":
            silence[f.sensor] = DeviceSilence(*_steps(f, step))
            continue
        for name in ON.get(f.sensor, (f.sensor,)):
            faults[name] = _fault(f, step)
            if name == "joints":
                joints = [faults[name] if f.quadrotor in (None, i) else old for i, old in enumerate(joints, 1)]
    faults["joints"] = together(joints)
    memory = FaultySensorsState(sensing, SensorFaultState(sensing.readings, 0.0))
    return FaultySensors(devices, SensorFaults(**faults, **silence)), memory


def _alike(mission: Mission) -> FrozenLimits:
    """How many samples alike make a sensor frozen: never where no noise is expected."""
    s, most = mission.sensors, float(mission.supervision.watchdog.frozen_samples)

    def after(noise: float) -> float:
        return most if noise > 0.0 else math.inf

    return FrozenLimits(
        joints=after(s.joints.force_noise),
        accelerometer=after(s.accelerometer.noise),
        gyroscope=after(s.gyroscope.noise),
        position=after(s.motion.position_noise),
        velocity=after(s.motion.velocity_noise),
        attitude=after(s.motion.attitude_noise),
    )


def with_watchdogs(mission: Mission, estimators: Any, memory: Any, readings: Any) -> tuple[Any, Any]:
    """Estimators and their memory, behind the watchdogs of a mission if it has any."""
    if mission.supervision.model == "none" or isinstance(estimators, Nothing):
        return estimators, memory
    w, step = mission.supervision.watchdog, mission.mission.step
    interval = step * steps_of(mission.sensors.motion.interval, step)
    watchdog = Watchdog(
        stale=w.stale_time,
        invalid=w.invalid_time,
        ranges=ReadingRanges(
            w.max_force, w.max_torque, w.max_specific_force, w.max_rates, w.max_position, w.max_velocity
        ),
        alike=_alike(mission),
        forgets=min(interval / w.window, 1.0),
        attitude=w.attitude_gap,
        way=w.position_gap,
        speed=w.speed_gap,
        turn_share=1.0 - math.exp(-w.rates_bandwidth * interval),
        way_share=1.0 - math.exp(-w.velocity_bandwidth * interval),
        per_interval=1.0 / interval,
    )
    return WatchedEstimators(watchdog, estimators), WatchedEstimatorsState(start_watchdog(readings), memory)
