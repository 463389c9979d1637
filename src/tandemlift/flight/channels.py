"""The channels of a flight: their meanings, units, frames and widths, and the missions that have them.

This is the only list of channels. Data frames, bags, CSV files and docs/reference/channels.md are made from it. The
laws in `simulation.loop.log_sample` give the values, in the same order. CONTRIBUTING.md says how to add a channel.

Frames: `world` is inertial with z up; `body` is fixed to the vehicle; `zxy` are Euler angles roll, pitch, yaw.

A stamp is the time at which a sensor took what a row holds. The pilot knows a sample one step after it was taken, or
later by the delay of its device, and has it until the next one. So `measured_rates` at time t is the truth, with
errors, at `imu_stamp`, which is earlier. A device that is stale sends nothing new: its last stamp stays. A sample of
the IMU holds the last one of joints that have their own clock.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Container, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.phases import PHASE_NUMBERS, REASON_NUMBERS
from tandemlift.core.types import Array

Steps = NDArray[np.int64]


class Channel(NamedTuple):
    """The description of a channel.

    Attributes:
        unit: of its numbers, "1" for none.
        frame: in which they are, "" if they have no direction.
        meaning: a short description.
        width: how many numbers a sample has, for each `per`.
        per: `rotor` or `quadrotor` if a sample has `width` numbers for each of them, one after another; else "".
    """

    unit: str
    frame: str
    meaning: str
    width: int = 3
    per: str = ""

    @property
    def described(self) -> dict[str, str]:
        """Unit, frame and meaning, for a file whose readers do not have this list."""
        return {"unit": self.unit, "frame": self.frame, "meaning": self.meaning}

    def columns(self, quadrotors: int, rotors: int) -> int:
        """The length of a sample, for a vehicle with that many quadrotors and that many rotors in all."""
        return self.width * {"": 1, "quadrotor": quadrotors, "rotor": rotors}[self.per]


class ChannelGroup(NamedTuple):
    """A group of channels with `when`, the condition on the mission in Markdown, and a note."""

    when: str
    channels: dict[str, Channel]
    note: str = ""


GROUPS: tuple[ChannelGroup, ...] = (
    ChannelGroup(
        "In every flight",
        {
            "position": Channel("m", "world", "position of the vehicle's centre of mass"),
            "velocity": Channel("m/s", "world", "velocity of the centre of mass"),
            "attitude": Channel("1", "body to world", "unit quaternion w, x, y, z", 4),
            "euler": Channel("rad", "zxy", "roll, pitch, yaw"),
            "rates": Channel("rad/s", "body", "angular velocity p, q, r"),
            "reference_position": Channel("m", "world", "reference that the position law tracks"),
            "reference_velocity": Channel("m/s", "world", "derivative of reference_position"),
            "reference_acceleration": Channel("m/s^2", "world", "derivative of reference_velocity"),
            "reference_euler": Channel(
                "rad", "zxy", "reference that the attitude law tracks, filtered if it has a filter"
            ),
            "admittance_position": Channel("m", "world", "T_r, response of the admittance to the push"),
            "admittance_velocity": Channel("m/s", "world", "derivative of admittance_position"),
            "admittance_acceleration": Channel(
                "m/s^2", "world", "derivative of admittance_velocity, constant over a step"
            ),
            "admittance_force": Channel("N", "world", "push after the gate; 0 while the gate is closed"),
            "push_force": Channel("N", "world", "force of the person on the vehicle"),
            "push_moment": Channel("N m", "body", "moment of the person about the centre of mass"),
            "thrust": Channel("N", "body z", "commanded total thrust U1", 1),
            "moment": Channel("N m", "body", "commanded moments U2, U3, U4"),
            "rotor_thrusts": Channel("N", "body z", "thrust of each rotor, quadrotor by quadrotor", 1, "rotor"),
            "joint_force": Channel("N", "body", "force of each quadrotor on the payload at its joint", 3, "quadrotor"),
            "joint_torque": Channel(
                "N m", "body", "torque of each quadrotor on the payload at its joint", 3, "quadrotor"
            ),
        },
    ),
    ChannelGroup(
        "With a beam that bends or mounts that give (`vehicle.payload.material`, `joint_stiffness`)",
        {
            "deflection": Channel(
                "m",
                "body",
                "place of each quadrotor from that on a rigid payload",
                3,
                "quadrotor",
            ),
            "slope": Channel("rad", "body", "rotation of each quadrotor from the payload's origin", 3, "quadrotor"),
        },
    ),
    ChannelGroup(
        'With real rotors (`actuators.model = "rotors"`)',
        {
            "rotor_commands": Channel("N", "body z", "commanded thrust of each rotor", 1, "rotor"),
            "allocated_thrust": Channel("N", "body z", "U1 that the rotor commands give within the rotors' limits", 1),
            "allocated_moment": Channel("N m", "body", "U2, U3, U4 that the rotor commands give within the limits"),
            "allocation_fraction": Channel("1", "", "fraction of the commanded wrench that is given, 0 to 1", 1),
        },
    ),
    ChannelGroup(
        'With wind (`wind.model = "air"`)',
        {
            "wind_velocity": Channel("m/s", "world", "velocity of the air"),
            "wind_force": Channel("N", "world", "force of the air on all parts together"),
        },
    ),
    ChannelGroup(
        'With a floor (`ground.model = "floor"`)',
        {"contact_force": Channel("N", "world", "force of floor and walls on the vehicle")},
    ),
    ChannelGroup(
        'With sensors (`sensors.model = "simulated"`)',
        {
            "measured_position": Channel(
                "m", "world", "motion capture reading of position of an earlier time, motion_stamp"
            ),
            "measured_velocity": Channel(
                "m/s", "world", "motion capture reading of velocity of an earlier time, motion_stamp"
            ),
            "measured_attitude": Channel(
                "1",
                "body to world",
                "motion capture reading of attitude, quaternion w, x, y, z, of an earlier time, motion_stamp",
                4,
            ),
            "measured_rates": Channel("rad/s", "body", "gyroscope reading of an earlier time, imu_stamp"),
            "measured_specific_force": Channel(
                "m/s^2", "body", "accelerometer reading, at the payload's origin, of an earlier time, imu_stamp"
            ),
            "measured_joint_force": Channel(
                "N",
                "body",
                "force reading at each joint, as joint_force, of an earlier time, joints_stamp",
                3,
                "quadrotor",
            ),
            "measured_joint_torque": Channel(
                "N m", "body", "torque reading at each joint of an earlier time, joints_stamp", 3, "quadrotor"
            ),
            "estimated_position": Channel("m", "world", "estimated position of the vehicle's centre of mass"),
            "estimated_velocity": Channel("m/s", "world", "estimated velocity of the centre of mass"),
            "estimated_attitude": Channel("1", "body to world", "estimated attitude, quaternion w, x, y, z", 4),
            "estimated_rates": Channel("rad/s", "body", "gyroscope reading less its estimated bias"),
            "push_measured": Channel("N", "world", "push from the latest joint readings, before the low-pass filter"),
            "push_estimate": Channel(
                "N", "world", "estimated push, after the low-pass filter; 0 until the tare is over"
            ),
            "push_moment_estimate": Channel("N m", "body", "moment of the estimated push about the centre of mass"),
            "push_point_estimate": Channel(
                "m", "body y", "where on the beam the push acts; 0 while it is too small to tell", 1
            ),
            "payload_mass_estimate": Channel(
                "kg", "", "payload mass; the tare identifies it if `estimator.identify_mass` is true", 1
            ),
            "sensor_disagreement": Channel("N", "body", "error of one joint sensor that would explain the readings", 1),
            "push_usable": Channel("1", "", "1 while the push is estimated and the joint sensors agree, else 0", 1),
            "push_withheld": Channel(
                "N",
                "world",
                "part of the measured push that is not followed, because the motion refutes it or wind explains it",
            ),
        },
        "A measured value is the one that the pilot has at the time of the row. Its sensor took it a step before or "
        "earlier, at the time that `imu_stamp`, `joints_stamp` or `motion_stamp` has in the same row; for a comparison "
        "with the truth, or a log, it belongs to that time. Estimates come from such values, and have the time of the "
        "row, in which the pilot uses them.",
    ),
    ChannelGroup(
        'With detection of contacts (`contact.model = "on"`)',
        {
            "contact_part": Channel(
                "1", "", "part that touches: number of the quadrotor of a guard, −1 for the beam, 0 for none", 1
            ),
            "contact_force_estimate": Channel("N", "world", "estimated horizontal force of the wall on that part"),
            "contact_point_estimate": Channel("m", "world", "where it began to act; zero for none"),
            "contact_along_beam": Channel("m", "body y", "that point along the beam, from the payload's centre", 1),
            "contact_normal": Channel("1", "world", "unit vector out of the wall, towards the vehicle; zero for none"),
            "contact_rise_time": Channel("s", "", "time in which the force rose, when the contact was found", 1),
            "contact_on_map": Channel("1", "", "1 if the pilot's map (`pilot.map`) has a wall there, else 0", 1),
        },
    ),
    ChannelGroup(
        "With a disturbance observer (`observer.model`)",
        {
            "disturbance_force": Channel("N", "world", "estimated force besides rotors, weight and person"),
            "disturbance_moment": Channel("N m", "body", "estimated moment besides these, about the centre of mass"),
            "disturbance_residual": Channel(
                "m/s^2", "world", "estimation error δ − δ̂ of translation; must stay below λ₂"
            ),
            "disturbance_angular_residual": Channel(
                "rad/s^2", "body", "estimation error δ − δ̂ of rotation; must stay below λ₂"
            ),
        },
    ),
    ChannelGroup(
        'Guided by hand (`pilot.guidance = "interactive"`)',
        {
            "phase": Channel("1", "", PHASE_NUMBERS, 1),
            "push_filtered": Channel("N", "world", "push after the pilot's low-pass filter, less its bias"),
            "push_active": Channel("1", "world", "1 while the pilot follows the push along an axis, else 0"),
            "added_damping": Channel("N s/m", "", "damping that is added to keep the compliance passive", 1),
            "reference_yaw_rate": Channel("rad/s", "world", "derivative of the yaw reference", 1),
            "limited_reason": Channel("1", "", f"reason why the vehicle cannot follow: 0 none, {REASON_NUMBERS}", 1),
        },
    ),
    ChannelGroup(
        'Guided by hand under supervision (`supervision.model = "on"`)',
        {
            "alarm": Channel("1", "", "number of the fault reacted to, 0 for none; see docs/reference/faults.md", 1),
            "failed_check": Channel("1", "", "number of the failed check, 0 for none; see docs/reference/faults.md", 1),
        },
    ),
    ChannelGroup(
        'With a policy (`compliance.policy.model = "network"`)',
        {
            "damping_factor_along": Channel("1", "", "factor of the virtual damping along the push", 1),
            "damping_factor_across": Channel("1", "", "factor of the virtual damping across the push", 1),
        },
    ),
    ChannelGroup(
        'With detection of a lost rotor (`detection.model = "residual"`)',
        {"failed_rotor": Channel("1", "", "number of the rotor that is classified as failed; 0 for none", 1)},
    ),
    ChannelGroup(
        'Stamps of readings (`sensors.model = "simulated"`)',
        {
            "imu_stamp": Channel("s", "", "time at which the imu took its readings in this row", 1),
            "joints_stamp": Channel("s", "", "time at which the joints' sensors took theirs", 1),
            "motion_stamp": Channel("s", "", "time at which the motion measurement took its readings", 1),
        },
        "An additional sensor NAME has `NAME_stamp`. Before the first sample, a stamp is one interval before it. A "
        "sensor that is stale keeps its last stamp. Stamps follow from the mission: code that is exported, and "
        "`tl.Simulation`, have none.",
    ),
)

FLOWN = "flown_rotor_commands"
STAMP = {
    "imu_stamp": ("measured_rates", "measured_specific_force"),
    "joints_stamp": ("measured_joint_force", "measured_joint_torque"),
    "motion_stamp": ("measured_position", "measured_velocity", "measured_attitude"),
}
"""The readings with each stamp. That of an additional sensor NAME, `NAME_stamp`, is of `measured_NAME`."""

LOGGED = {
    "rotor_speed_commands": Channel("rad/s", "body z", "commanded speed of each rotor", 1, "rotor"),
    FLOWN: Channel("N", "body z", "commanded thrust of each rotor in a log that is shadowed", 1, "rotor"),
    "push_moment_at_origin": Channel("N m", "body", "moment of the person about the payload's origin"),
}
"""Channels of logs and of their shadows (`analysis.identification`), which no flight has."""

CHANNELS: dict[str, Channel] = {name: channel for group in GROUPS for name, channel in group.channels.items()}
TIME = Channel("s", "", "time", 1)
OTHER = Channel("", "", "not one of tandemlift's own")

DERIVED: dict[str, tuple[str, str, Channel]] = {
    "position_error": ("reference_position", "position", Channel("m", "world", "desired minus actual")),
    "velocity_error": ("reference_velocity", "velocity", Channel("m/s", "world", "desired minus actual")),
    "attitude_error": ("reference_euler", "euler", Channel("rad", "zxy", "desired minus actual")),
}
"""Channels that are computed on access: the first minus the second."""


def channel_of(name: str) -> Channel:
    """The description of the channel of that name; for an additional sensor, that of the sensor."""
    known = CHANNELS.get(name) or LOGGED.get(name, TIME if name == "time" else OTHER)
    if known is not OTHER or not (name.startswith("measured_") or name.endswith("_stamp")):
        return known
    from tandemlift.parts.sensors.vehicle_sensors import ADDITIONAL  # with all sensors, which load the laws

    sensor = ADDITIONAL.get(name.removeprefix("measured_").removesuffix("_stamp"))
    if sensor is None:
        return OTHER
    if name.endswith("_stamp"):
        return Channel("s", "", f"time at which the sensor {sensor.name!r} took its reading", 1)
    return Channel(sensor.unit, sensor.frame, f"reading of the sensor {sensor.name!r}: {sensor.meaning}", sensor.width)


def stamp_of(name: str) -> str:
    """The channel with the stamps of the readings in a channel `measured_…`."""
    return next((stamp for stamp, names in STAMP.items() if name in names), f"{name.removeprefix('measured_')}_stamp")


# ---- Columns

NUMBERED = ("rotor", "quadrotor")  # dimensions whose labels are bare numbers


class Dimension(NamedTuple):
    """A dimension of a channel's columns and its labels: axes, angles, or numbers from 1."""

    name: str
    labels: tuple[Any, ...]


AXES = Dimension("axis", ("x", "y", "z"))
ANGLES = Dimension("angle", ("roll", "pitch", "yaw"))
QUATERNION = Dimension("quaternion", ("w", "x", "y", "z"))


def dimensions(channel: Channel, count: int) -> tuple[Dimension, ...]:
    """The dimensions of a channel's columns, the last varying fastest.

    Args:
        channel: its description.
        count: its number of columns.
    """
    if not channel.per:
        return _components(channel.frame, count)
    if channel.width == 1:
        return (Dimension(channel.per, tuple(range(1, count + 1))),)
    each = Dimension(channel.per, tuple(range(1, count // channel.width + 1)))
    return each, *_components(channel.frame, channel.width)


def _components(frame: str, width: int) -> tuple[Dimension, ...]:
    """The dimension of the numbers of a vector, of angles or of a quaternion; by default numbers from 1."""
    if frame == "body to world" and width == 4:
        return (QUATERNION,)
    if width == 3 and frame:
        return (ANGLES if frame == "zxy" else AXES,)
    return (Dimension("component", tuple(range(1, width + 1))),)


def column_names(name: str, channel: Channel, shape: tuple[int, ...]) -> list[str]:
    """The name of each number of a channel's sample, whose shape is () for a single number."""
    if not shape:
        return [name]
    parts = itertools.product(*[[_part(d.name, label) for label in d.labels] for d in dimensions(channel, shape[0])])
    return ["_".join((name, *part)) for part in parts]


def _part(dimension: str, label: object) -> str:
    return f"{dimension}_{label}" if dimension in NUMBERED else str(label)


# ---- Stamps


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
