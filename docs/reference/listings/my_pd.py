"""PD with an integral on position, PD on attitude."""

from typing import NamedTuple

from tandemlift.core.algebra import GRAVITY, ZERO, Mat3, Number, Vec3, clip, law, vec3
from tandemlift.core.keys import NonNegative3, Positive3, key
from tandemlift.parts.controllers import Command, ControllerTable, control, register
from tandemlift.parts.mechanics.rigid_body import UP, Wrench, apply_inertia, gyroscopic, inertia_value
from tandemlift.parts.mechanics.rotation import (
    TiltZXY,
    desired_orientation,
    euler_from_quaternion,
    euler_rates_from_rates,
    total_thrust,
)


class Settings(ControllerTable):
    """The keys of `[controller]`: one number for all axes, or one each."""

    stiffness: Positive3 = key(4.0, "1/s²", "stiffness of the position, world axes")
    damping: Positive3 = key(4.0, "1/s", "damping of the position")
    integral: NonNegative3 = key(0.5, "1/s³", "integral gain of the position")
    integral_limit: Positive3 = key(0.5, "m s", "largest magnitude of the integral")
    attitude_stiffness: Positive3 = key(100.0, "1/s²", "stiffness of roll, pitch, yaw")
    attitude_damping: Positive3 = key(20.0, "1/s", "damping of roll, pitch, yaw")


class Gains(NamedTuple):
    """The parameters of the law. The law is chosen by this type."""

    mass: Number  # kg
    inertia: Vec3 | Mat3  # kg m², a Vec3 if it is diagonal
    step: Number  # s
    stiffness: Vec3
    damping: Vec3
    integral: Vec3
    integral_limit: Vec3
    attitude_stiffness: Vec3
    attitude_damping: Vec3


class Memory(NamedTuple):
    """The memory of the law from one sample to the next."""

    integral: Vec3  # m s


@law
def wanted_moment(k, attitude, rates, tilt):
    """Moments [N m, body axes] that turn the vehicle to `tilt` [rad]."""
    euler_rates = euler_rates_from_rates(attitude, rates)
    acceleration = (tilt - attitude.angles) * k.attitude_stiffness - euler_rates * k.attitude_damping
    return apply_inertia(k.inertia, acceleration) - gyroscopic(k.inertia, rates)


@control.register(Gains)
def my_pd(k, memory, measured, reference):
    """One sample."""
    state, target = measured.state, reference.trajectory
    e, de = target.position - state.position, target.velocity - state.velocity
    integral = clip(memory.integral + e * k.step, -k.integral_limit, k.integral_limit)
    acceleration = target.acceleration + e * k.stiffness + de * k.damping + integral * k.integral
    force = (acceleration + UP * GRAVITY) * k.mass
    attitude = euler_from_quaternion(state.attitude)
    tilt = desired_orientation(TiltZXY(), force, attitude, reference.yaw)
    moment = wanted_moment(k, attitude, state.rates, tilt)
    return Command(Wrench(total_thrust(attitude, force), moment), tilt), Memory(integral)


@register("my-pd", Settings)
def start(s, vehicle, step):
    """PD with an integral on position, PD on attitude."""
    gains = Gains(
        mass=vehicle.mass,
        inertia=inertia_value(vehicle.inertia),
        step=step,
        stiffness=vec3(s.stiffness),
        damping=vec3(s.damping),
        integral=vec3(s.integral),
        integral_limit=vec3(s.integral_limit),
        attitude_stiffness=vec3(s.attitude_stiffness),
        attitude_damping=vec3(s.attitude_damping),
    )
    return gains, Memory(ZERO)
