"""The controller of my_pd.py in plain Python and NumPy."""

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import GRAVITY, Vec3
from tandemlift.core.keys import NonNegative3, Positive3, key
from tandemlift.parts.controllers import Command, ControllerTable, control, register
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.mechanics.rotation import (
    TiltZXY,
    desired_orientation,
    euler_from_quaternion,
    euler_rates_from_rates,
    total_thrust,
)


class Settings(ControllerTable):
    """The keys of `[controller]`."""

    stiffness: Positive3 = key(4.0, "1/s²", "stiffness of the position, world axes")
    damping: Positive3 = key(4.0, "1/s", "damping of the position")
    integral: NonNegative3 = key(0.5, "1/s³", "integral gain of the position")
    integral_limit: Positive3 = key(0.5, "m s", "largest magnitude of the integral")
    attitude_stiffness: Positive3 = key(100.0, "1/s²", "stiffness of roll, pitch, yaw")
    attitude_damping: Positive3 = key(20.0, "1/s", "damping of roll, pitch, yaw")


class Gains(NamedTuple):
    """Settings, vehicle and step."""

    settings: Settings
    vehicle: object
    step: float


@control.register(Gains, compiled=False)
def my_pd(k, integral, measured, reference):
    """One sample."""
    s, state, target = k.settings, measured.state, reference.trajectory
    e, de = np.array(target.position - state.position), np.array(target.velocity - state.velocity)
    integral = np.clip(integral + e * k.step, -np.array(s.integral_limit), s.integral_limit)
    acceleration = np.array(target.acceleration) + s.stiffness * e + s.damping * de + s.integral * integral
    force = Vec3(*k.vehicle.mass * (acceleration + np.array([0.0, 0.0, GRAVITY])))

    attitude, rates = euler_from_quaternion(state.attitude), np.array(state.rates)
    tilt = desired_orientation(TiltZXY(), force, attitude, reference.yaw)
    euler_rates = np.array(euler_rates_from_rates(attitude, state.rates))
    turn = s.attitude_stiffness * np.array(tilt - attitude.angles) - s.attitude_damping * euler_rates
    J = k.vehicle.inertia
    moment = J @ turn + np.cross(rates, J @ rates)
    return Command(Wrench(total_thrust(attitude, force), Vec3(*moment)), tilt), integral


@register("my-pd-plain", Settings)
def start(s, vehicle, step):
    """PD with an integral on position, PD on attitude, in plain Python."""
    return Gains(s, vehicle, step), np.zeros(3)
