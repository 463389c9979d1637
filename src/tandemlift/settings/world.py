"""The world that the pilot does not know: pushes, disturbances, real rotors, sensors, wind, ground and walls."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from tandemlift.settings.leaves import (
    Axes,
    Axes3,
    Exactly3,
    NonNegative,
    Positive,
    Scale,
    Size,
    Table,
    Triple,
    must,
)

FINEST = 1e-9  # resolution of a sensor, in its unit

Delay = Annotated[float, Field(ge=0.0, le=1.0)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]
Interval = Annotated[float, Field(ge=0.0, le=10.0)]  # s
Turn = Annotated[float, Field(ge=0.0, le=1.0)]  # rad
Speed = Annotated[float, Field(ge=-1e3, le=1e3)]  # m/s, along an axis
Speeds = tuple[Speed, Speed, Speed]
Turbulence = Annotated[float, Field(ge=0.0, le=1e3)]  # m/s
Airspeed = Annotated[float, Field(ge=0.01, le=1e3)]  # m/s


def _step_of_quantisation(value: float) -> float:
    if 0.0 < value < FINEST:
        raise must("size", f"be 0 (for none) or at least {FINEST}")
    return value


Resolution = Annotated[Size, AfterValidator(_step_of_quantisation)]


def _upright(euler: Triple) -> Triple:
    if abs(euler[0]) >= math.radians(85.0):
        raise must("roll", "have a roll (the first angle) within ±85° (±1.4835 rad), where the angles are regular")
    return euler


class Initial(Table):
    """`[initial]`: the state at t = 0."""

    position: Axes3 = (0.0, 0.0, 0.0)  # m, of the system's centre of mass, world axes
    velocity: Axes3 = (0.0, 0.0, 0.0)  # m/s, world axes
    euler: Annotated[Axes3, AfterValidator(_upright)] = (0.0, 0.0, 0.0)  # rad: roll, pitch, yaw (Z-X-Y)
    rates: Axes3 = (0.0, 0.0, 0.0)  # rad/s, body axes


class PushTable(Table):
    """One of `[[pushes]]`: a person's push A exp(−(t − t₀)²/2σ²)."""

    force: Exactly3  # N, peak, world axes
    time: float  # s, of the peak
    sigma: Positive  # s
    point: Exactly3 = (0.0, 0.0, 0.0)  # m, body axes, from the system's centre of mass


class Disturbance(Table):
    """`[disturbance]`: a constant force and moment that the pilot does not know of."""

    force: Axes3 = (0.0, 0.0, 0.0)  # N, world axes, at the centre of mass
    moment: Axes3 = (0.0, 0.0, 0.0)  # N m, body axes


class Plant(Table):
    """`[plant]`: how the body differs from what the pilot believes."""

    mass_scale: Scale = 1.0
    inertia_scale: Annotated[tuple[Scale, Scale, Scale], Axes(3)] = (1.0, 1.0, 1.0)


class Actuators(Table):
    """`[actuators]`: what the rotors do with a command."""

    model: Literal["ideal", "rotors"] = "ideal"
    delay: Delay = 0.0  # s, from the command to the rotor, rounded to whole steps
    start: Literal["hover", "stopped"] = "hover"  # the rotors' speed at t = 0


class Fault(Table):
    """One of `[[faults]]`: a rotor that loses thrust."""

    quadrotor: Annotated[int, Field(ge=1, le=64)]
    rotor: Annotated[int, Field(ge=1, le=4)]
    time: NonNegative  # s
    efficiency: Share = 0.0  # share of the thrust that is left
    known_after: NonNegative | None = None  # s; never, if not given


class JointSensors(Table):
    """`[sensors.joints]`: the force-torque sensor at each joint; errors per axis."""

    force_noise: Size = 0.0  # N, standard deviation of a sample
    force_bias: Size = 0.0  # N, standard deviation of the constant error, drawn from the seed
    force_drift: Size = 0.0  # N/√s, random walk
    force_resolution: Resolution = 0.0  # N, step of quantisation, 0 for none
    force_range: Positive = 1e6  # N
    torque_noise: Size = 0.0  # N m
    torque_bias: Size = 0.0  # N m
    torque_drift: Size = 0.0  # N m/√s
    torque_resolution: Resolution = 0.0  # N m
    torque_range: Positive = 1e6  # N m
    misalignment: Turn = 0.0  # rad, standard deviation of the sensor's rotation about each axis, from the seed


class InertialSensor(Table):
    """`[sensors.accelerometer]` in m/s², `[sensors.gyroscope]` in rad/s; errors per axis."""

    noise: Size = 0.0  # standard deviation of a sample
    bias: Size = 0.0  # standard deviation of the constant error, drawn from the seed
    drift: Size = 0.0  # per √s, random walk
    range: Positive = 1e6


class MotionSensor(Table):
    """`[sensors.motion]`: position and velocity of the centre of mass, and attitude, as from motion capture."""

    position_noise: Size = 0.0  # m
    velocity_noise: Size = 0.0  # m/s
    attitude_noise: Size = 0.0  # rad, about each body axis
    interval: Interval = 0.0  # s, between samples; every step if 0
    delay: Delay = 0.0  # s


class Sensors(Table):
    """`[sensors]`: the unit on board (joints, accelerometer, gyroscope: one clock) and the motion measurement."""

    model: Literal["none", "simulated"] = "none"
    interval: Interval = 0.0  # s, between samples of the unit on board; every step if 0
    delay: Delay = 0.0  # s, of the unit on board, beyond the step after which any reading is known
    joints: JointSensors = JointSensors()
    accelerometer: InertialSensor = InertialSensor()
    gyroscope: InertialSensor = InertialSensor()
    motion: MotionSensor = MotionSensor()


class GustTable(Table):
    """One of `[[wind.gusts]]`: rises as 1 − cos, holds, and falls as it rose (MIL-F-8785C, 3.7.3)."""

    velocity: Annotated[Speeds, Axes(3, single=False)]  # m/s, peak, world axes
    start: float  # s
    rise: Positive  # s
    hold: NonNegative | None = None  # s; it stays, if not given


class WindTable(Table):
    """`[wind]`: moving air and its drag on payload and quadrotors."""

    model: Literal["none", "air"] = "none"
    velocity: Annotated[Speeds, Axes(3)] = (0.0, 0.0, 0.0)  # m/s, mean, world axes
    turbulence: Turbulence = 0.0  # m/s, wind at 20 ft that makes the Dryden turbulence; 0 for none
    height: Positive = 3.048  # m, at which the standard's scales are taken; it begins at 10 ft
    airspeed: Airspeed | None = None  # m/s, at which eddies pass; the mean wind's, at least 0.5, if not given
    density: Annotated[Positive, Field(le=1e4)] = 1.225  # kg/m³
    gusts: tuple[GustTable, ...] = ()


class Ground(Table):
    """`[ground]`: a floor to stand on, and walls."""

    model: Literal["none", "floor"] = "none"
    height: float | None = None  # m, of the floor; just below the feet at the start, if not given
    sinkage: Annotated[Positive, Field(le=0.1)] = 5e-4  # m, of the feet under the vehicle's weight
    friction: Annotated[float, Field(ge=0.0, le=100.0)] = 0.8
    effect: bool = False  # more thrust near the floor
