"""One sensor of a vector, or one on every quadrotor: what its samples show of the truth.

A sample is clip(A x + bias + drift + σ n) rounded to whole steps; A turns body axes into the sensor's, the drift is a
random walk. One standard normal n a sample and axis serves both: the drift advances by w n *after* the reading. With
the σ of `sensor_model`, the increments of such readings have the variance 2σ₀² + w² and the covariance −σ₀² with
the one before, as those of white noise of σ₀ and an independent walk of w have; both are Gaussian, so they are the same
process, its walk begun σ/w samples earlier (J. F. Muth, J. Am. Stat. Assoc. 55, 1960), for half the random numbers.
Error terms: IEEE Std 952, annex C.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from tandemlift.algebra.law import elementwise, law
from tandemlift.algebra.ops import clip, maximum, where
from tandemlift.algebra.vector import Mat3, Vec3, apply, each, spread, vec3
from tandemlift.laws.mechanics.rotation import quaternion_from_rotation_vector, rotation_from_quaternion

ROUNDING = 6755399441055744.0  # 1.5 · 2⁵²: a sum with it has no fraction left


class SensorGrade(NamedTuple):
    """How good a sensor is, in plain numbers and in the unit U of what it measures; as it stands, perfect.

    `bias` [U] and `misalignment` (rotation vector of the sensor's axes, body axes [rad]) are a number for all, three,
    or three for each quadrotor; `noise` is the standard deviation of a sample [U], `drift` that of a random walk after
    one second [U/√s]; it reads up to ±`limit` [U] in steps of `resolution` [U], of any size if 0.
    """

    noise: float = 0.0
    bias: Any = 0.0
    drift: float = 0.0
    resolution: float = 0.0
    limit: float = math.inf
    misalignment: Any = 0.0


PERFECT = SensorGrade()


class SensorModel(NamedTuple):
    """A sensor in the numbers that its law needs, of the unit U; on every quadrotor, `axes` and `bias` are of sets.

    Rows of `axes`: the sensor's axes in body axes. `noise` σ and `walk` w [U] multiply a sample's normals. `per_step`:
    1/`step` [1/U], or 0 if that is 0.
    """

    axes: Mat3
    bias: Vec3
    noise: Any
    walk: Any
    limit: Any
    step: Any
    per_step: Any


@elementwise
def displayed(x, limit, step, per_step):
    """x held within ±limit, then rounded to whole steps, half to even; not rounded if step is 0."""
    held = clip(x, -limit, limit)
    steps = held * per_step
    whole = maximum(steps + ROUNDING, 0.0) - ROUNDING  # a bare x + c − c would be cancelled by JAX and CasADi
    return where(step > 0.0, whole * step, held)


@law
def read(k: SensorModel, drift: Vec3, truth: Vec3, normals: Vec3) -> Vec3:
    """A sample of `truth`, a vector in body axes or one of every quadrotor."""
    v = apply(k.axes, truth) + k.bias + drift + normals * k.noise
    return Vec3(
        displayed(v.x, k.limit, k.step, k.per_step),
        displayed(v.y, k.limit, k.step, k.per_step),
        displayed(v.z, k.limit, k.step, k.per_step),
    )


def _rows(value: Any, count: int) -> np.ndarray:
    return np.broadcast_to(np.asarray(value, dtype=float), (count, 3))


def _sensor_axes(turn: np.ndarray) -> np.ndarray:
    """Axes (3 × 3, rows) of a sensor turned by a rotation vector; exactly the body's for none."""
    return np.array(rotation_from_quaternion(quaternion_from_rotation_vector(vec3(turn)))).T


def sensor_model(grade: SensorGrade, interval: float, count: int | None = None) -> SensorModel:
    """The sensor of this grade, or one on every quadrotor.

    Args:
        grade: how good it is.
        interval: time from sample to sample [s].
        count: number of quadrotors; None for a single sensor.
    """
    walk = grade.drift * math.sqrt(interval)
    A = np.array([_sensor_axes(turn) for turn in _rows(grade.misalignment, count or 1)])
    bias = _rows(grade.bias, count or 1)
    return SensorModel(
        axes=Mat3(*[vec3(A[0, i]) if count is None else spread(A[:, i]) for i in range(3)]),
        bias=vec3(bias[0]) if count is None else spread(bias),
        noise=0.5 * (walk + math.sqrt(walk * walk + 4.0 * grade.noise * grade.noise)),
        walk=walk,
        limit=grade.limit,
        step=grade.resolution,
        per_step=1.0 / grade.resolution if grade.resolution > 0.0 else 0.0,
    )


def no_drift(count: int | None = None) -> Vec3:
    """The drift before the first sample."""
    return vec3(np.zeros(3)) if count is None else Vec3(*[each(count)(*(0.0,) * count)] * 3)
