"""The stamps of readings: the times at which the sensors took what a row of a flight holds.

The pilot knows a sample one step after it was taken, or later by the delay of its device, and has it until the next
one. So `measured_rates` at time t is the truth, with errors, at `imu_stamp`, which is earlier. A device that is stale
sends nothing new: its last stamp stays. A sample of the IMU holds the last one of joints that have their own clock.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.types import Array
from tandemlift.flight.channels import STAMP

Steps = NDArray[np.int64]


def reading_stamps(mission: Mapping[str, Any], time: Array, channels: Container[str]) -> dict[str, Array]:
    """The channels `imu_stamp`, `joints_stamp`, `motion_stamp` and those of additional sensors.

    Before its first sample, a device has a reading of the start; its stamp is one interval before that sample.

    Args:
        mission: its resolved tables.
        time: of the rows (T,) [s].
        channels: names of a flight's channels; only devices with readings among them have stamps.

    Returns:
        The times [s] (T,) by channel; none without sensors.
    """
    step, sensors, found = mission["mission"]["step"], mission["sensors"], dict[str, Array]()
    rows = np.round(time / step).astype(np.int64)
    tables = {"imu": ("sensors", sensors), "motion": ("sensors.motion", sensors["motion"])}
    tables |= {s["name"]: (f"sensors.additional.{i}", s) for i, s in enumerate(sensors["additional"])}
    for device, (key, clock) in tables.items():
        passed_on = _before_stale(mission, device, rows - 1 - round(clock["delay"] / step))
        taken = _last_samples(mission, key, clock, passed_on)
        found[f"{device}_stamp"] = taken * step
        if device == "imu":
            joints = sensors["joints"]
            own = joints.get("interval") is not None
            found["joints_stamp"] = step * (_last_samples(mission, "sensors.joints", joints, taken) if own else taken)
    return {name: stamps for name, stamps in found.items() if any(of in channels for of in stamped_by(name))}


def stamped_by(stamp: str) -> tuple[str, ...]:
    """The channels of the readings with these stamps."""
    return STAMP.get(stamp, (f"measured_{stamp.removesuffix('_stamp')}",))


def _before_stale(mission: Mapping[str, Any], device: str, steps: Steps) -> Steps:
    """Steps, but within those in which a device is stale the last one before."""
    step = mission["mission"]["step"]
    for fault in mission.get("sensor_faults", []):
        if fault["sensor"] == device and fault["kind"] == "stale":
            start, until = round(fault["time"] / step), fault.get("until")
            end = math.inf if until is None else round(until / step)
            steps = np.where((start <= steps) & (steps < end), start - 1, steps)
    return steps


def _last_samples(mission: Mapping[str, Any], key: str, clock: Mapping[str, Any], steps: Steps) -> Steps:
    """The last step, until each of some, in which a device sampled; `key`: of its table, the clock."""
    step, last = mission["mission"]["step"], int(steps.max(initial=0))
    changes = [c for c in mission.get("changes", []) if c["key"] == f"{key}.interval"]
    periods = [(0, max(1, round(clock["interval"] / step)))]
    for change in sorted(changes, key=lambda c: c["time"]):  # ramps, as `simulation.parameter_changes` has them
        begin = round(change["time"] / step) - 1
        periods.append((begin, periods[-1][1]))
        periods.append((begin + max(1, round(change["duration"] / step)), max(1, round(change["value"] / step))))
    at, sizes = np.array(periods).T
    first, size = round(clock["first_sample"] / step), int(sizes[0])
    if not changes:
        return first + np.maximum((steps - first) // size, -1) * size
    samples = [first - size, first]
    while samples[-1] <= last:
        samples.append(samples[-1] + math.ceil(np.interp(samples[-1], at, sizes)))
    taken = np.array(samples, np.int64)
    return taken[np.maximum(np.searchsorted(taken, steps, side="right") - 1, 0)]
