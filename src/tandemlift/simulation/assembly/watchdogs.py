"""Sensors with the faults of a mission, and estimators with its watchdogs before them."""

from __future__ import annotations

from typing import Any

from tandemlift.core.vector import Absent
from tandemlift.parts.sensors.readings import SensorState, readings_of
from tandemlift.parts.sensors.sensor_faults import SensorFaults, SensorFaultState
from tandemlift.parts.sensors.sensors_table import SensorsTable
from tandemlift.parts.sensors.watchdog import WatchTable, start_watchdog, watchdog_from
from tandemlift.simulation.loop.fault_tolerant_perception import (
    FaultySensors,
    FaultySensorsState,
    WatchedEstimators,
    WatchedEstimatorsState,
)


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
