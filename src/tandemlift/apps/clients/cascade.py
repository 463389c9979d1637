"""The cascade of a quadrotor's firmware: position → velocity → attitude → rates → moment, with its integrators.

Structure, rates of the loops, integrators and limits are those of the Crazyflie's PID controllers (crazyflie-firmware,
position_controller_pid.c, attitude_pid_controller.c); its gains, from units of its motors and degrees to SI units, are
the largest ones here. Rotors that respond slowly need slower loops, each `APART` times slower than the one inside.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tandemlift.apps.clients import setpoints as sp

GRAVITY = 9.81
RATIO = 2.0  # between the bandwidths of a loop and of the one inside, so that each is damped by about 0.7
LARGEST_RATE_GAIN = 40.0  # 1/s; chosen: the firmware's is above it, with rotors faster than those modelled here
# platform_defaults_cf21bl.h: gains there, and their size in SI units
ATTITUDE_GAIN = 6.0  # 1/s; PID_ROLL_KP
VELOCITY_GAIN = 25.0 * math.pi / 180.0 * GRAVITY  # 1/s; PID_VEL_X_KP, degrees of tilt for 1 m/s
POSITION_GAIN = 2.0  # 1/s; PID_POS_X_KP
CLIMB_GAIN = 25.0 * 1000.0 / 65535.0 * 4.0 * 0.2 / 0.0393  # 1/s; PID_VEL_Z_KP, in 1/1000 of the thrust of four rotors
RATE_INTEGRAL, ATTITUDE_INTEGRAL, VELOCITY_INTEGRAL, CLIMB_INTEGRAL = 2.0, 0.5, 0.04, 0.6  # 1/s; each K_i over its K_p
MAX_TILT = math.radians(20.0)  # PID_VEL_ROLL_MAX
MAX_ATTITUDE_INTEGRAL = math.radians(20.0)  # rad s; PID_ROLL_INTEGRATION_LIMIT
MAX_SPEED = 1.0  # m/s; PID_POS_VEL_X_MAX
MAX_RATE_SHARE = 0.2  # of the largest moment, by the integrator; PID_ROLL_RATE_INTEGRATION_LIMIT times its K_i
# chosen: setpoints beyond are clipped
MAX_COMMANDED_TILT, MAX_COMMANDED_RATE, MAX_COMMANDED_SPEED = math.radians(60.0), 20.0, 10.0  # rad, rad/s, m/s
MOMENT_SHARES = (0.35, 0.35, 0.3)  # of the largest moments, which are left to each axis beside the lift; chosen
SATURATES = 0.3  # rad/s, an error of rates that asks for the largest moment; chosen
BRAKING, RATE_AT_GOAL = 0.5, 0.02  # of the angular acceleration, to stop at an angle; rad/s; chosen
MAX_LEAD = 3.0  # rad, of the commanded yaw before the actual one: it must not change sides
MAX_INTEGRAL = 3.0  # m/s², by the integrators of velocity


class LoopGains(NamedTuple):
    """Bandwidths of the loops from inside out [1/s]."""

    rate: float
    attitude: float
    velocity: float
    position: float
    climb: float
    height: float


def gains_for(lag: float) -> LoopGains:
    """The gains with rotors that respond after a time [s]: lag and delay.

    A rate loop K/(s (τ s + 1)) with K = 1/(2 τ) is damped by 0.7.
    """
    rate = min(1.0 / (2.0 * max(lag, 1e-3)), LARGEST_RATE_GAIN)
    attitude = min(rate / RATIO, ATTITUDE_GAIN)
    velocity = min(attitude / RATIO, VELOCITY_GAIN)
    climb = min(rate / RATIO, CLIMB_GAIN)
    return LoopGains(
        rate, attitude, velocity, min(velocity / RATIO, POSITION_GAIN), climb, min(climb / RATIO, POSITION_GAIN)
    )


class Demand(NamedTuple):
    """The demand on the inner loops: thrust [N], and roll, pitch, yaw [rad] or, if given, rates [rad/s].

    `target` is the position that is asked for [m], if there is one.
    """

    thrust: float
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    rates: sp.Vector | None = None
    target: sp.Vector | None = None


class OuterLoops:
    """Position and velocity of one quadrotor.

    Args:
        gains: of the loops.
        mass: that it carries [kg].
        max_thrust: of its rotors together [N].

    Attributes:
        integral: of the velocity's error [m/s², world].
    """

    def __init__(self, gains: LoopGains, mass: float, max_thrust: float) -> None:
        self._gains, self._mass, self._max_thrust = gains, mass, max_thrust
        self.reset()

    def reset(self) -> None:
        """Forget the integrals, and the yaw that was commanded."""
        self.integral: sp.Vector = sp.ZERO
        self._yaw: float | None = None

    def demand(self, s: sp.QuadrotorState, setpoint: sp.Setpoint, dt: float) -> Demand:
        """The demand of a setpoint, `dt` [s] after the last one."""
        if isinstance(setpoint, sp.RateSetpoint):
            self._yaw, self.integral = None, sp.ZERO
            x, y, z = setpoint.rates
            rates = tuple(clip(r, MAX_COMMANDED_RATE) for r in (x, y, z))
            return Demand(self._within(setpoint.thrust), rates=(rates[0], rates[1], rates[2]))
        if isinstance(setpoint, sp.AttitudeSetpoint):
            yaw = self._turned(s, setpoint.yaw, setpoint.yaw_rate, dt)
            roll, pitch = (clip(angle, MAX_COMMANDED_TILT) for angle in (setpoint.roll, setpoint.pitch))
            if setpoint.height is None:
                self.integral = sp.ZERO
                return Demand(self._within(setpoint.thrust), roll, pitch, yaw)
            climb = self._acceleration(s, (s.velocity[0], s.velocity[1], self._climb(s, setpoint.height)), dt)[2]
            return Demand(self._lift(s, climb), roll, pitch, yaw)
        if isinstance(setpoint, sp.VelocitySetpoint | sp.PositionSetpoint | sp.FullStateSetpoint):
            return self._towards(s, setpoint, dt)
        raise TypeError(setpoint)

    def _towards(
        self,
        s: sp.QuadrotorState,
        setpoint: sp.VelocitySetpoint | sp.PositionSetpoint | sp.FullStateSetpoint,
        dt: float,
    ) -> Demand:
        """The demand of a setpoint of position or velocity."""
        ahead, target = sp.ZERO, None
        if isinstance(setpoint, sp.VelocitySetpoint):
            vx, vy, vz = (clip(v, MAX_COMMANDED_SPEED) for v in setpoint.velocity)
            if setpoint.heading:
                vx, vy = turned(vx, vy, s.euler[2])
            if setpoint.height is not None:
                vz = self._climb(s, setpoint.height)
            yaw = self._turned(s, setpoint.yaw, setpoint.yaw_rate, dt)
        else:
            target, k = setpoint.position, self._gains.position
            dx, dy = (k * (wanted - at) for wanted, at in zip(target[:2], s.position[:2], strict=True))
            slower = max(math.hypot(dx, dy) / MAX_SPEED, 1.0)
            vx, vy, vz = dx / slower, dy / slower, self._climb(s, target[2])
            yaw = self._turned(s, setpoint.yaw, 0.0, dt)
            if isinstance(setpoint, sp.FullStateSetpoint):
                v, a = setpoint.velocity, setpoint.acceleration
                vx, vy, vz = (x + clip(y, MAX_COMMANDED_SPEED) for x, y in zip((vx, vy, vz), v, strict=True))
                ahead = (clip(a[0], GRAVITY), clip(a[1], GRAVITY), clip(a[2], GRAVITY))
        ax, ay, az = self._acceleration(s, (vx, vy, vz), dt)
        forward, left = turned(ax + ahead[0], ay + ahead[1], -s.euler[2])
        pitch, roll = math.atan(forward / GRAVITY), -math.atan(left / GRAVITY)
        return Demand(self._lift(s, az + ahead[2]), clip(roll, MAX_TILT), clip(pitch, MAX_TILT), yaw, target=target)

    def _acceleration(self, s: sp.QuadrotorState, velocity: sp.Vector, dt: float) -> sp.Vector:
        """The acceleration that brings a velocity about [m/s²], without the feedforward."""
        g = self._gains
        along = (g.velocity, g.velocity, g.climb)
        per_second = (VELOCITY_INTEGRAL, VELOCITY_INTEGRAL, CLIMB_INTEGRAL)
        errors = [k * (wanted - v) for k, wanted, v in zip(along, velocity, s.velocity, strict=True)]
        x, y, z = (
            clip(i + share * clip(e, GRAVITY) * dt, MAX_INTEGRAL)
            for i, share, e in zip(self.integral, per_second, errors, strict=True)
        )
        self.integral = (x, y, z)
        return errors[0] + x, errors[1] + y, errors[2] + z

    def _climb(self, s: sp.QuadrotorState, height: float) -> float:
        return clip(self._gains.height * (height - s.position[2]), MAX_SPEED)

    def _lift(self, s: sp.QuadrotorState, climb: float) -> float:
        """The thrust for a vertical acceleration [N]."""
        roll, pitch, _ = s.euler
        upright = max(math.cos(roll) * math.cos(pitch), 0.5)
        return self._within(self._mass * (GRAVITY + climb) / upright)

    def _within(self, thrust: float) -> float:
        return min(max(thrust, 0.0), self._max_thrust)

    def _turned(self, s: sp.QuadrotorState, yaw: float | None, rate: float, dt: float) -> float:
        """The yaw that is commanded now: the given one, or the last one turned at a rate."""
        now = s.euler[2]
        before = now if self._yaw is None else self._yaw
        wanted = before + clip(rate, MAX_COMMANDED_RATE) * dt if yaw is None else yaw
        self._yaw = (
            wrapped(wanted) if yaw is not None else now + clip(wrapped(before - now) + wanted - before, MAX_LEAD)
        )
        return self._yaw


class InnerLoops:
    """Attitude and rates of one rigid body, or of one quadrotor's share of it.

    Args:
        gains: of the loops; those about an axis with little moment are smaller.
        inertia: about x, y and z [kg m²].
        max_moment: of the rotors about x, y and z [N m].

    Attributes:
        rate_gains, attitude_gains: about x, y and z [1/s].
        rate_integral: the moment of the integrators of the rate loops [N m].
    """

    def __init__(self, gains: LoopGains, inertia: sp.Vector, max_moment: sp.Vector) -> None:
        self._inertia = inertia
        self._max = [share * most for share, most in zip(MOMENT_SHARES, max_moment, strict=True)]
        accelerations = [most / J for most, J in zip(self._max, inertia, strict=True)]
        self.rate_gains = [min(gains.rate, a / SATURATES) for a in accelerations]
        self.attitude_gains = [min(gains.attitude, k / RATIO) for k in self.rate_gains]
        self._brakes = [BRAKING * a for a in accelerations]
        self.reset()

    def reset(self) -> None:
        """Forget the integrals."""
        self._tilt: sp.Vector = sp.ZERO
        self.rate_integral: sp.Vector = sp.ZERO

    def moment(self, s: sp.QuadrotorState, demand: Demand, dt: float) -> sp.Vector:
        """The moment about x, y and z [N m], `dt` [s] after the last one."""
        rates = self._rates(s, demand, dt) if demand.rates is None else demand.rates
        along = zip(self.rate_gains, self._inertia, rates, s.rates, strict=True)
        errors = [k * J * (wanted - rate) for k, J, wanted, rate in along]
        x, y, z = (
            clip(integral + RATE_INTEGRAL * error * dt, MAX_RATE_SHARE * most)
            for integral, error, most in zip(self.rate_integral, errors, self._max, strict=True)
        )
        self.rate_integral = (x, y, z)
        return clip(errors[0] + x, self._max[0]), clip(errors[1] + y, self._max[1]), clip(errors[2] + z, self._max[2])

    def _rates(self, s: sp.QuadrotorState, demand: Demand, dt: float) -> sp.Vector:
        """The rates that bring an attitude about [rad/s, body]."""
        roll, pitch, yaw = s.euler
        error = (demand.roll - roll, demand.pitch - pitch, wrapped(demand.yaw - yaw))
        x, y, z = (clip(i + e * dt, MAX_ATTITUDE_INTEGRAL) for i, e in zip(self._tilt, error, strict=True))
        self._tilt = (x, y, z)
        a, b, c = (
            k * (e + ATTITUDE_INTEGRAL * i) for k, e, i in zip(self.attitude_gains, error, self._tilt, strict=True)
        )
        a, b, c = (
            clip(rate, math.sqrt(2.0 * brake * abs(e)) + RATE_AT_GOAL)
            for rate, brake, e in zip((a, b, c), self._brakes, error, strict=True)
        )
        # body rates from the rates of the angles of Rz(yaw) Ry(pitch) Rx(roll)
        sin_roll, cos_roll, cos_pitch = math.sin(roll), math.cos(roll), math.cos(pitch)
        return (
            clip(a - math.sin(pitch) * c, MAX_COMMANDED_RATE),
            clip(cos_roll * b + sin_roll * cos_pitch * c, MAX_COMMANDED_RATE),
            clip(cos_roll * cos_pitch * c - sin_roll * b, MAX_COMMANDED_RATE),
        )


def clip(value: float, limit: float) -> float:
    """A value within ± a limit."""
    return min(max(value, -limit), limit)


def turned(x: float, y: float, yaw: float) -> tuple[float, float]:
    """A vector of the plane, turned by an angle [rad]."""
    return x * math.cos(yaw) - y * math.sin(yaw), x * math.sin(yaw) + y * math.cos(yaw)


def wrapped(angle: float) -> float:
    """An angle within ± π [rad]."""
    return math.remainder(angle, 2.0 * math.pi)
