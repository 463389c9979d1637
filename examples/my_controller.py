"""PD on position, PD on attitude."""

from typing import NamedTuple

import tandemlift.parts.controllers as tc
from tandemlift.core.algebra import Vec3, vec3
from tandemlift.core.keys import Positive3, key


class Settings(tc.CascadeTable):
    """The keys of `[controller]`: one number for all axes, or three."""

    bandwidth: Positive3 = key(2.0, "rad/s", "bandwidth of the position loop, along x, y, z")


class Gains(NamedTuple):
    """The parameters of the law, which is selected by this type."""

    vehicle: tc.ControllerModel
    bandwidth: Vec3


@tc.control.register(Gains)
def my_pd(k, memory, measured, reference):
    """A thrust and three moments from the measured state and the reference."""
    state, desired, w = measured.state, reference.trajectory, k.bandwidth
    e, de = desired.position - state.position, desired.velocity - state.velocity
    force = tc.wanted_force(k.vehicle, e * w * w + de * w * 2.0, measured, reference)
    force, angles = tc.limit_tilt(k.vehicle.tilt, force), tc.euler_from_quaternion(state.attitude)
    tilt, memory = tc.tracked_attitude(k.vehicle, memory, angles, force, reference)
    rates = tc.euler_rates_from_rates(angles, state.rates)
    error, rate_error = tilt.angles - angles.angles, tilt.rates - rates
    alpha = tilt.accelerations + error * 36.0 + rate_error * 12.0
    return tc.command_from(k.vehicle, angles, force, alpha, tilt.angles, measured), memory


@tc.register("my-pd", Settings)
def start(s, vehicle, step):
    """PD on position, PD on attitude."""
    return Gains(tc.controller_model(s, vehicle, step), vec3(s.bandwidth)), tc.LEVEL
