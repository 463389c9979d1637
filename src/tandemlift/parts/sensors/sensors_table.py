"""The tables of simulated sensors and of their faults."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import AfterValidator, Field, model_validator

from tandemlift.core.algebra import sqrt
from tandemlift.core.keys import Delay, Exactly3, NonNegative, Positive, Size, Table, is_number, key, must
from tandemlift.parts.sensors.vehicle_sensors import ADDITIONAL, DEVICES, SENSORS, sensors_on

FINEST_RESOLUTION = 1e-9  # resolution of a sensor, in its unit
BOUNDLESS = "without a bound"

Interval = Annotated[float, Field(ge=0.0, le=10.0)]  # s
Turn = Annotated[float, Field(ge=0.0, le=1.0)]  # rad


def _step_of_quantisation(value: float) -> float:
    if 0.0 < value < FINEST_RESOLUTION:
        raise must("size", f"be 0 (for none) or at least {FINEST_RESOLUTION}")
    return value


Resolution = Annotated[Size, AfterValidator(_step_of_quantisation)]

NOISE = "standard deviation of a sample"
BIAS = "standard deviation of the constant error, which is drawn from the seed"
DRIFT = "growth of the error, a random walk"
STEP = "step of quantisation"
RANGE = "largest reading, either way"
FINE = f"0 for none, or at least {FINEST_RESOLUTION:g}"
THE_SENSORS = "the sensor's unit"
STEPS = "at most 10,000 steps"
OFTEN = "time between samples, rounded to whole steps; 0 samples at every step"
FIRST = "time of the first sample, rounded to whole steps: offsets stagger the sensors"
WITHIN = "below the time between samples"
LATE = "delay of a sample beyond the one step after which any sample is known, rounded to whole steps"


class JointSensors(Table, acts='sensors.joints.model = "simulated"'):
    """`[sensors.joints]`: the force-torque sensor at each joint, between quadrotor and payload."""

    model: Literal["none", "simulated"] = key(
        "simulated",
        None,
        "model of the joint sensors",
        choices={
            "none": "there are none: the push is known or observed (`estimator.wrench`)",
            "simulated": "sensors with the errors of this table",
        },
    )
    force_noise: Size = key(0.0, "N", f"force: {NOISE}")
    force_bias: Size = key(0.0, "N", f"force: {BIAS}")
    force_drift: Size = key(0.0, "N/√s", f"force: {DRIFT}")
    force_resolution: Resolution = key(0.0, "N", f"force: {STEP}", rule=FINE)
    force_range: Positive = key(1e6, "N", f"force: {RANGE}", source=BOUNDLESS)
    torque_noise: Size = key(0.0, "N m", f"torque: {NOISE}")
    torque_bias: Size = key(0.0, "N m", f"torque: {BIAS}")
    torque_drift: Size = key(0.0, "N m/√s", f"torque: {DRIFT}")
    torque_resolution: Resolution = key(0.0, "N m", f"torque: {STEP}", rule=FINE)
    torque_range: Positive = key(1e6, "N m", f"torque: {RANGE}", source=BOUNDLESS)
    misalignment: Turn = key(
        0.0, "rad", "standard deviation of the sensor's rotation about each axis, which is drawn from the seed"
    )
    interval: Interval | None = key(
        None,
        "s",
        "time between samples, rounded to whole steps; a sample of the imu holds the last one of the joints",
        unset="joints are sampled with the imu",
        example=0.002,
    )
    first_sample: NonNegative = key(0.0, "s", FIRST, rule=f"{WITHIN}, which must be set")


class Accelerometer(Table):
    """`[sensors.accelerometer]`: the accelerometer at the payload's origin."""

    noise: Size = key(0.0, "m/s²", NOISE)
    bias: Size = key(0.0, "m/s²", BIAS)
    drift: Size = key(0.0, "m/s²/√s", DRIFT)
    range: Positive = key(1e6, "m/s²", RANGE, source=BOUNDLESS)


class Gyroscope(Table):
    """`[sensors.gyroscope]`: the gyroscope on the payload."""

    noise: Size = key(0.0, "rad/s", NOISE)
    bias: Size = key(0.0, "rad/s", BIAS)
    drift: Size = key(0.0, "rad/s/√s", DRIFT)
    range: Positive = key(1e6, "rad/s", RANGE, source=BOUNDLESS)


InertialSensor = Accelerometer | Gyroscope


class MotionSensor(Table):
    """`[sensors.motion]`: position and velocity of the system's centre of mass, and attitude, as by motion capture."""

    position_noise: Size = key(0.0, "m", f"position: {NOISE}")
    velocity_noise: Size = key(0.0, "m/s", f"velocity: {NOISE}")
    attitude_noise: Size = key(0.0, "rad", f"attitude: {NOISE}, about each body axis")
    interval: Interval = key(0.0, "s", OFTEN)
    first_sample: NonNegative = key(0.0, "s", FIRST, rule=WITHIN)
    delay: Delay = key(0.0, "s", LATE, rule=STEPS)


AdditionalName: TypeAlias = Literal[tuple(ADDITIONAL)] | str  # type: ignore[valid-type]


class AdditionalSensorTable(Table):
    """`[[sensors.additional]]`: sensors beyond those that the pilot needs, one table each, with a clock of their own.

    Their samples are recorded in channel `measured_NAME`. CONTRIBUTING.md describes how to add a sensor.
    """

    name: AdditionalName = key(
        ...,
        None,
        "name of the sensor",
        rule="or another one that is registered",
        example="altimeter",
        choices={sensor.name: sensor.meaning for sensor in ADDITIONAL.values()},
    )
    noise: Size = key(0.0, THE_SENSORS, NOISE)
    bias: Size = key(0.0, THE_SENSORS, BIAS)
    drift: Size = key(0.0, f"{THE_SENSORS}/√s", DRIFT)
    resolution: Resolution = key(0.0, THE_SENSORS, STEP, rule=FINE)
    range: Positive = key(1e6, THE_SENSORS, RANGE, source=BOUNDLESS)
    interval: Interval = key(0.0, "s", OFTEN)
    first_sample: NonNegative = key(0.0, "s", FIRST, rule=WITHIN)
    delay: Delay = key(0.0, "s", LATE, rule=STEPS)


class SensorsTable(
    Table,
    acts='sensors.model = "simulated"',
    keys_act={
        "noise_interval": "sensors.joints.force_noise > 0 or sensors.joints.torque_noise > 0 or "
        "sensors.accelerometer.noise > 0 or sensors.gyroscope.noise > 0"
    },
):
    """`[sensors]`: simulated sensors; errors are independent along each axis.

    There are a force-torque sensor at every joint, an accelerometer and a gyroscope, all on one clock, the inertial
    measurement unit's (imu), unless the joints have their own, and a motion measurement with a clock of its own. The
    pilot receives a sample one step after it was taken, or later by its delay. Where the imu does not sample at every
    step, the pilot's estimators step with the samples that arrive, and hold their estimates in between.
    """

    model: Literal["none", "simulated"] = key(
        "none",
        None,
        "model of the sensors",
        choices={"none": "no sensors: the pilot uses the truth", "simulated": "sensors with the errors of this table"},
    )
    interval: Interval = key(
        0.0, "s", "time between samples of the imu and the joints, rounded to whole steps; 0 samples at every step"
    )
    first_sample: NonNegative = key(0.0, "s", FIRST, rule=WITHIN)
    noise_interval: Positive | None = key(
        None,
        "s",
        "time between samples with the noise of the tables joints, accelerometer and gyroscope: at other intervals the "
        "density of the noise is the same, so that noise changes with 1/√interval; with 1 s, these keys are densities "
        "in their unit/√Hz, as data sheets give them",
        unset="their noise is that of a sample, whatever the interval",
        example=0.001,
    )
    delay: Delay = key(
        0.0,
        "s",
        "delay of a sample of the imu and the joints beyond the one step after which any sample is known, rounded to "
        "whole steps",
        rule=STEPS,
    )
    errors: Literal["simulated", "none"] = key(
        "simulated",
        None,
        "errors of the sensors: noise, bias, drift and misalignment",
        choices={
            "simulated": "those of this table",
            "none": "exact samples, which observers still weigh by the noise of this table",
        },
    )
    joints: JointSensors = JointSensors()
    accelerometer: Accelerometer = Accelerometer()
    gyroscope: Gyroscope = Gyroscope()
    motion: MotionSensor = MotionSensor()
    additional: tuple[AdditionalSensorTable, ...] = ()


SensorName: TypeAlias = Literal[(*DEVICES, *SENSORS)] | str  # type: ignore[valid-type]
SENSOR_CHOICES = {
    **{device: f"the device with {' and '.join(s.name for s in sensors_on(device))}" for device in DEVICES},
    **{sensor.name: sensor.meaning for sensor in SENSORS.values()},
}


class SensorFaultTable(Table):
    """`[[sensor_faults]]`: sensors that fail, one table each; they need `sensors.model = "simulated"`.

    A sensor, or one joint of it, fails once. The devices "imu" and "motion" stand for all sensors on them.
    """

    sensor: SensorName = key(
        ...,
        None,
        "the sensor or device that fails",
        rule="or the name of an additional sensor",
        example="joints",
        choices=SENSOR_CHOICES,
    )
    quadrotor: Annotated[int, Field(ge=1, le=64)] | None = key(
        None, "1", "number of the quadrotor whose joint fails, from 1", unset="all joints fail", example=1
    )
    kind: Literal["stale", "frozen", "nan", "bias", "range"] = key(
        ...,
        None,
        "kind of the failure",
        example="frozen",
        choices={
            "stale": "a device sends nothing new",
            "frozen": "it repeats its last value",
            "nan": "its values are not numbers",
            "bias": "it has an offset of `size`",
            "range": "it reads `size`",
        },
    )
    time: NonNegative = key(..., "s", "start of the fault", example=15.0)
    until: NonNegative | None = key(
        None, "s", "end of the fault", rule="after its start", unset="it lasts for good", example=20.0
    )
    size: Exactly3 = key(
        (0.0, 0.0, 0.0),
        THE_SENSORS,
        "offset, or the reading in its place; a force for joints, a rotation about body axes [rad] for the attitude",
        rule="or one number for a sensor that reads one",
    )

    @model_validator(mode="before")
    @classmethod
    def _of_one_number(cls, data: Any) -> Any:
        sensor = ADDITIONAL.get(str(data.get("sensor"))) if isinstance(data, dict) else None
        one = sensor is not None and sensor.width == 1 and is_number(data.get("size"))
        return {**data, "size": (data["size"], 0.0, 0.0)} if one else data


ERRORS = ("noise", "bias", "drift", "misalignment")  # keys, at the end of their names


def as_simulated(s: SensorsTable) -> SensorsTable:
    """The table with the errors that its sensors have in flight."""
    return s if s.errors == "simulated" else _exact(s)


def _exact(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(map(_exact, value))
    if not isinstance(value, Table):
        return value
    return value.model_copy(update={name: 0.0 if name.endswith(ERRORS) else _exact(part) for name, part in value})


def steps_of(interval: float, step: float) -> int:
    """A sampling interval in whole steps, at least one."""
    return max(1, round(interval / step))


def noise_scale(s: SensorsTable, interval: float) -> float:
    """Noise of a sample of the imu or the joints over that of their tables, at an interval [s] between samples."""
    return 1.0 if s.noise_interval is None else sqrt(s.noise_interval / interval)


def joint_steps(s: SensorsTable, step: float) -> int | None:
    """The sampling interval of joints with a clock of their own in whole steps; None without."""
    return None if s.joints.interval is None or s.joints.model == "none" else steps_of(s.joints.interval, step)


def clocks_of(s: SensorsTable) -> Iterator[tuple[str, str, float | None, float]]:
    """Of every device: (its name, the key of its table, `interval`, `first_sample`)."""
    yield "imu", "sensors", s.interval, s.first_sample
    yield "joints", "sensors.joints", s.joints.interval, s.joints.first_sample
    yield "motion", "sensors.motion", s.motion.interval, s.motion.first_sample
    for i, own in enumerate(s.additional):
        yield own.name, f"sensors.additional.{i}", own.interval, own.first_sample


def first_samples(s: SensorsTable, step: float) -> dict[str, int]:
    """The steps before the first sample of each device."""
    return {device: round(first / step) for device, _, _, first in clocks_of(s)}
