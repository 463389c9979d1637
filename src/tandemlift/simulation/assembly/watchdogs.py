"""Sensors with the faults of a mission, and estimators with its watchdogs before them."""

from __future__ import annotations

from typing import Any

from tandemlift.core.vector import Absent
from tandemlift.missions import Mission
from tandemlift.parts.sensors.readings import SensorState, readings_of
from tandemlift.parts.sensors.sensor_faults import SensorFaultState, sensor_faults_from
from tandemlift.parts.sensors.watchdog import start_watchdog, watchdog_from
from tandemlift.simulation.loop.fault_tolerant_perception import (
    FaultySensors,
    FaultySensorsState,
    WatchedEstimators,
    WatchedEstimatorsState,
)


def with_faults(mission: Mission, devices: Any, sensing: Any) -> tuple[Any, Any]:
    """Sensors and their memory, with the faults that a mission gives them."""
    if not mission.sensor_faults or not isinstance(sensing, SensorState):
        return devices, sensing
    names = [s.name for s in mission.sensors.additional]
    faults = sensor_faults_from(mission.sensor_faults, len(mission.vehicle.quadrotors), names, mission.mission.step)
    return FaultySensors(devices, faults), FaultySensorsState(sensing, SensorFaultState(readings_of(sensing), 0.0))


def with_watchdogs(mission: Mission, estimators: Any, memory: Any, readings: Any) -> tuple[Any, Any]:
    """Estimators and their memory, with the watchdogs of a mission before them if it has any."""
    if mission.supervision.model == "none" or isinstance(estimators, Absent):
        return estimators, memory
    watchdog = watchdog_from(mission.supervision.watchdog, mission.sensors, mission.mission.step)
    return WatchedEstimators(watchdog, estimators), WatchedEstimatorsState(start_watchdog(readings), memory)
