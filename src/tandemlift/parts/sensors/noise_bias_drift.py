"""The errors of a sensor: noise, bias, drift, misalignment, saturation and quantisation. `read` makes a sample of them.

A sample is clip(A x + bias + drift + σ n) rounded to whole steps; A maps body axes to the sensor's, the drift is a
random walk. One standard normal n a sample and axis serves both: the drift advances by w n *after* the reading. With
the σ of `sensor_model`, the increments of such readings have the variance 2σ₀² + w² and the covariance −σ₀² with
the one before, as those of white noise of σ₀ and an independent walk of w have; both are Gaussian, so they are the same
process, its walk begun σ/w samples earlier (J. F. Muth, J. Am. Stat. Assoc. 55, 1960), for half the random numbers.
Error terms: IEEE Std 952, annex C.

The type of a model picks its law: `SensorModel` for a vector or one on every quadrotor, `ScalarSensorModel` for a
number, `WhiteNoise` and `AttitudeNoise` for readings without other errors, `NoError` for copied ones, `NoSensor` for
quantities without a sensor.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.algebra import clip, maximum, sqrt, where
from tandemlift.core.arrays import array
from tandemlift.core.law import STAIRCASES, choice, elementwise
from tandemlift.core.types import Array, Number, number
from tandemlift.core.vector import ZERO, Absent, Mat3, Quat, Vec3, apply, is_set, spread, vec3
from tandemlift.parts.mechanics.rotation import quaternion_from_rotation_vector, rotated_by, rotation_from_quaternion

ROUNDING = 6755399441055744.0  # 1.5 · 2⁵²: a sum with it has no fraction left


class SensorGrade(NamedTuple):
    """The grade of a sensor, as plain numbers in the unit U of its readings; perfect by default.

    `bias` [U] and `misalignment` (rotation vector of the sensor's axes, body axes [rad]) are a number for all, three,
    or three for each quadrotor; `noise` is the standard deviation of a sample [U], `drift` that of a random walk after
    one second [U/√s]; it reads up to ±`limit` [U] in steps of `resolution` [U], of any size if 0.
    """

    noise: float = 0.0
    bias: ArrayLike = 0.0
    drift: float = 0.0
    resolution: float = 0.0
    limit: float = math.inf
    misalignment: ArrayLike = 0.0


class SensorErrors(NamedTuple):
    """The errors of a sensor of the unit U, besides its bias.

    `noise` σ and `walk` w [U] multiply a sample's normals; it reads up to ±`limit` [U] in steps of `step` [U];
    `per_step`: 1/`step` [1/U], or 0 if that is 0.
    """

    noise: Number
    walk: Number
    limit: Number
    step: Number
    per_step: Number


class SensorModel(NamedTuple):
    """A sensor of a vector; if there is one on every quadrotor, `axes` and `bias` are of sets.

    Rows of `axes`: the sensor's axes in body axes.
    """

    axes: Mat3
    bias: Vec3
    errors: SensorErrors


class ScalarSensorModel(NamedTuple):
    """A sensor of a number; as `SensorModel`, without axes."""

    bias: Number
    errors: SensorErrors


class WhiteNoise(NamedTuple):
    """A sensor of a vector whose only error is noise, of standard deviation `sigma`."""

    sigma: Number


class AttitudeNoise(NamedTuple):
    """A sensor of the attitude whose only error is noise, of standard deviation `sigma` about each body axis [rad]."""

    sigma: Number


class NoError(NamedTuple):
    """A quantity that is sampled without errors."""


class NoSensor(NamedTuple):
    """A quantity that is not measured: its reading is `Absent`."""


@elementwise
def displayed(x: Number, limit: Number, step: Number, per_step: Number) -> Number:
    """x held within ±limit, then rounded to whole steps, half to even; not rounded if step is 0."""
    held = clip(x, -limit, limit)
    steps = held * per_step
    whole = maximum(steps + ROUNDING, 0.0) - ROUNDING  # a bare x + c − c would be cancelled by JAX and CasADi
    return where(step > 0.0, whole * step, held)


STAIRCASES.append(displayed.scalar)
ChannelModel: TypeAlias = SensorModel | ScalarSensorModel | WhiteNoise | AttitudeNoise | NoError | NoSensor
Sample: TypeAlias = Number | Vec3 | Quat | Absent
Drift: TypeAlias = Number | Vec3 | Absent
"""Of a sample: its drift, or the standard normals of its noise."""
S = TypeVar("S", Number, Vec3, Quat)
D = TypeVar("D", Number, Vec3, Absent)
V = TypeVar("V", Number, Vec3)


@choice(instead={NoError: "truth", NoSensor: Absent()})
def read(model: ChannelModel, drift: Drift, truth: S, normals: Drift) -> S:
    """A sample of `truth` with the drift so far; `normals`: independent standard normals, laid out like the sample."""


@read.register(SensorModel)
def _read_vector(k: SensorModel, drift: Vec3, truth: Vec3, normals: Vec3) -> Vec3:
    e = k.errors
    v = apply(k.axes, truth) + k.bias + drift + normals * e.noise
    return Vec3(*[displayed(component, e.limit, e.step, e.per_step) for component in v])


@read.register(ScalarSensorModel)
def _read_scalar(k: ScalarSensorModel, drift: Number, truth: Number, normals: Number) -> Number:
    e = k.errors
    return displayed(truth + k.bias + drift + normals * e.noise, e.limit, e.step, e.per_step)


@read.register(WhiteNoise)
def _read_with_noise(k: WhiteNoise, drift: Absent, truth: Vec3, normals: Vec3) -> Vec3:
    return truth + normals * k.sigma


@read.register(AttitudeNoise)
def _read_attitude(k: AttitudeNoise, drift: Absent, truth: Quat, normals: Vec3) -> Quat:
    return rotated_by(truth, normals * k.sigma)


@choice(instead={WhiteNoise: "drift", AttitudeNoise: "drift", NoError: "drift", NoSensor: "drift"})
def next_drift(model: ChannelModel, drift: D, normals: Drift, fresh: Number) -> D:
    """The drift after a sample (`fresh` 1), or as it was (0)."""


@next_drift.register(SensorModel)
@next_drift.register(ScalarSensorModel)
def _random_walk(k: ScalarSensorModel | SensorModel, drift: V, normals: V, fresh: Number) -> V:
    return drift + normals * (k.errors.walk * fresh)


def start_drift(model: ChannelModel) -> Drift:
    """The drift before the first sample of a sensor with this model; `Absent` if it does not drift."""
    if isinstance(model, SensorModel):
        return spread(np.zeros((len(model.bias.x), 3))) if is_set(model.bias.x) else ZERO
    return 0.0 if isinstance(model, ScalarSensorModel) else Absent()


def no_noise(model: ChannelModel) -> Drift:
    """Standard normals of 0 for a sensor, laid out as `read` takes them."""
    return ZERO if isinstance(model, (WhiteNoise, AttitudeNoise)) else start_drift(model)


def _sensor_axes(turn: Array) -> Array:
    """Axes (3 × 3, rows) of a sensor rotated by a rotation vector; exactly the body's for a zero vector."""
    return np.array(rotation_from_quaternion(quaternion_from_rotation_vector(vec3(turn)))).T


def _errors(grade: SensorGrade, interval: float) -> SensorErrors:
    walk, stepped = grade.drift * sqrt(interval), grade.resolution > 0.0
    return SensorErrors(
        noise=0.5 * (walk + sqrt(walk * walk + 4.0 * grade.noise * grade.noise)),
        walk=walk,
        limit=grade.limit,
        step=grade.resolution,
        per_step=where(stepped, 1.0 / where(stepped, grade.resolution, 1.0), 0.0),
    )


def sensor_model(grade: SensorGrade, interval: float, count: int | None = None) -> SensorModel:
    """The sensor of a vector of this grade, or one on every quadrotor.

    Args:
        grade: its errors.
        interval: time from sample to sample [s].
        count: number of quadrotors; None for a single sensor.
    """
    turns, bias = (np.broadcast_to(array(value), (count or 1, 3)) for value in (grade.misalignment, grade.bias))
    A = np.array([_sensor_axes(turn) for turn in turns])
    return SensorModel(
        Mat3(*[vec3(A[0, i]) if count is None else spread(A[:, i]) for i in range(3)]),
        vec3(bias[0]) if count is None else spread(bias),
        _errors(grade, interval),
    )


def scalar_sensor_model(grade: SensorGrade, interval: float) -> ScalarSensorModel:
    """The sensor of a number of this grade, whose `bias` is a number; `interval` from sample to sample [s]."""
    return ScalarSensorModel(number(grade.bias), _errors(grade, interval))
