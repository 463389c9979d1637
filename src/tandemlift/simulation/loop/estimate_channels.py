"""The channels of sensors and estimators."""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.law import choice, law
from tandemlift.core.types import Number
from tandemlift.core.vector import Absent, Quat, Vec3, apply_transposed, cross
from tandemlift.parts.estimation.contact_detection import ContactEstimateChannels, contact_channels
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.sensors.readings import Readings, by_name
from tandemlift.simulation.loop.perception import Estimates
from tandemlift.simulation.loop.sources import EstimatedFlight


class MeasuredChannels(NamedTuple):
    """The last readings that the pilot has; `additional`: those of additional sensors, `measured_NAME`."""

    measured_position: Vec3
    measured_velocity: Vec3
    measured_attitude: Quat
    measured_rates: Vec3
    measured_specific_force: Vec3
    measured_joint_force: Vec3
    measured_joint_torque: Vec3
    additional: tuple[Number | Vec3, ...]


class EstimatedChannels(NamedTuple):
    """The estimates from them."""

    estimated_position: Vec3
    estimated_velocity: Vec3
    estimated_attitude: Quat
    estimated_rates: Vec3
    push_measured: Vec3
    push_estimate: Vec3
    push_moment_estimate: Vec3
    push_point_estimate: Number
    payload_mass_estimate: Number
    sensor_disagreement: Number
    push_usable: Number
    push_withheld: Vec3
    contact_estimate: ContactEstimateChannels | Absent


@law(absent="readings")
def measured_channels(readings: Readings) -> MeasuredChannels:
    """The channels of readings."""
    m, u = readings.motion, readings.imu
    named = by_name(tuple([f"measured_{name}" for name in readings.additional._fields]))
    return MeasuredChannels(
        measured_position=m.position,
        measured_velocity=m.velocity,
        measured_attitude=m.attitude,
        measured_rates=u.rates,
        measured_specific_force=u.specific_force,
        measured_joint_force=u.joint_force,
        measured_joint_torque=u.joint_torque,
        additional=named(*[reading.value for reading in readings.additional]),
    )


@choice(absent="known")
def estimated_channels(known: EstimatedFlight | Absent) -> EstimatedChannels | Absent:
    """The channels of estimates."""


@estimated_channels.register(Estimates)
def _estimates(known: Estimates) -> EstimatedChannels:
    s, p = known.state, known.push
    arm = cross(known.vehicle.payload, apply_transposed(rotation_from_quaternion(s.attitude), p.force))
    return EstimatedChannels(
        estimated_position=s.position,
        estimated_velocity=s.velocity,
        estimated_attitude=s.attitude,
        estimated_rates=s.rates,
        push_measured=p.measured + p.withheld,
        push_estimate=p.force,
        push_moment_estimate=p.moment + arm,
        push_point_estimate=p.point,
        payload_mass_estimate=p.payload_mass,
        sensor_disagreement=p.disagreement,
        push_usable=p.trusted * p.armed,
        push_withheld=p.withheld,
        contact_estimate=contact_channels(known.contact),
    )
