"""A person's pushes on the vehicle: Gaussian in time, in world axes, at points of the body.

Several pushes at several points act as one force F = Σ F_i in world axes and one moment about the centre of mass,
Σ r_i × Rᵀ F_i in body axes. The moment follows from the attitude and the sum of outer products Σ F_i r_iᵀ, so the
number of pushes does not enter the equations of motion.
"""

from typing import Generic, NamedTuple, TypeAlias, TypeVar

from tandemlift.core.algebra import exp, where
from tandemlift.core.keys import Exactly3, Positive, Table, key
from tandemlift.core.law import choice, law
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Mat3, Quat, Vec3, linear, outer, plus
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion


class PushTable(Table):
    """`[[pushes]]`: pushes of a person, one table each: force · exp(−(t − time)²/(2 sigma²))."""

    force: Exactly3 = key(..., "N", "peak force, world axes", example=[3.0, 0.0, 0.0])
    time: float = key(..., "s", "time of the peak", example=14.0)
    sigma: Positive = key(..., "s", "standard deviation σ of the push over time", example=0.6)
    point: Exactly3 = key(
        (0.0, 0.0, 0.0),
        "m",
        "point of application, body axes, from the system's centre of mass",
        rule="no farther away than the vehicle's farthest part",
    )


SUPPORT = 9.0  # a push is exactly zero beyond 9 σ, where the Gaussian is 3e-18 of its peak


@linear
class CentralPush(NamedTuple):
    """A push at the centre of mass: force [N, world axes]."""

    force: Vec3

    def __add__(self, other: "CentralPush") -> "CentralPush":  # type: ignore[override]
        return plus(self, other)


@linear
class PointPush(NamedTuple):
    """Pushes at points of the body: force Σ F_i [N, world axes] and Σ F_i r_iᵀ [N·m], r_i in body axes."""

    force: Vec3
    spread: Mat3

    def __add__(self, other: "PointPush") -> "PointPush":  # type: ignore[override]
        return plus(self, other)


@linear
class BeamPush(NamedTuple):
    """Pushes on a beam that bends: as of a `PointPush`, and Σ F_i y_i², Σ F_i y_i³ and Σ F_i y_i⁴, world axes.

    y_i [m] is the place of the point along the beam, so that the work on a mode follows from a polynomial of its shape.
    """

    force: Vec3
    spread: Mat3
    second: Vec3
    third: Vec3
    fourth: Vec3

    def __add__(self, other: "BeamPush") -> "BeamPush":  # type: ignore[override]
        return plus(self, other)


Push: TypeAlias = CentralPush | PointPush | BeamPush


P = TypeVar("P", CentralPush, PointPush, BeamPush)
P_co = TypeVar("P_co", covariant=True)


class PushSamples(NamedTuple, Generic[P_co]):
    """The push at the start, the middle and the end of a step."""

    start: P_co
    middle: P_co
    end: P_co


class GaussianPush(NamedTuple):
    """One push A exp(−(t − t₀)²/2σ²): peak force A [N, world axes], time t₀ [s], 1/σ [1/s], point r [m, body axes]."""

    force: Vec3
    time: Number
    per_sigma: Number
    point: Vec3


@law
def gaussian_force(p: GaussianPush, t: Number) -> Vec3:
    """Force of one push at time t [s], N in world axes."""
    s = (t - p.time) * p.per_sigma
    return p.force * where(s * s < SUPPORT * SUPPORT, exp(-0.5 * s * s), 0.0)


@choice
def push_at(kind: P, p: GaussianPush, t: Number) -> P:
    """One push at time t, as a value of the same type as `kind`."""


@push_at.register(CentralPush)
def _central(kind: CentralPush, p: GaussianPush, t: Number) -> CentralPush:
    return CentralPush(gaussian_force(p, t))


@push_at.register(PointPush)
def _at_point(kind: PointPush, p: GaussianPush, t: Number) -> PointPush:
    F = gaussian_force(p, t)
    return PointPush(F, outer(F, p.point))


@push_at.register(BeamPush)
def _on_beam(kind: BeamPush, p: GaussianPush, t: Number) -> BeamPush:
    F = gaussian_force(p, t)
    return on_beam(PointPush(F, outer(F, p.point)), p.point)


@law
def on_beam(push: PointPush, point: Vec3) -> BeamPush:
    """A push at one point [m, body axes] of a beam that bends; a couple is linear along the beam, and in `spread`."""
    F, y = push.force, point.y
    return BeamPush(F, push.spread, F * (y * y), F * (y * y * y), F * (y * y * y * y))


@choice
def pushed_at(kind: Push, push: PointPush, point: Vec3) -> Push:
    """A push at one point [m, body axes], as a value of the same type as `kind`."""


@pushed_at.register(PointPush)
def _same(kind: PointPush, push: PointPush, point: Vec3) -> PointPush:
    return push


@pushed_at.register(BeamPush)
def _along(kind: BeamPush, push: PointPush, point: Vec3) -> BeamPush:
    return on_beam(push, point)


@choice
def push_moment(push: Push, attitude: Quat) -> Vec3:
    """Moment of a push about the centre of mass, body axes [N·m]."""


@push_moment.register(CentralPush)
def _no_moment(push: CentralPush, attitude: Quat) -> Vec3:
    return ZERO


@push_moment.register(BeamPush)
@push_moment.register(PointPush)
def _moment(push: PointPush | BeamPush, attitude: Quat) -> Vec3:
    # Σ r × RᵀF, with G = Rᵀ (Σ F rᵀ) = Σ (RᵀF) rᵀ
    R = rotation_from_quaternion(attitude)
    P = push.spread
    G = Mat3(
        P.x * R.x.x + P.y * R.y.x + P.z * R.z.x,
        P.x * R.x.y + P.y * R.y.y + P.z * R.z.y,
        P.x * R.x.z + P.y * R.y.z + P.z * R.z.z,
    )
    return Vec3(G.z.y - G.y.z, G.x.z - G.z.x, G.y.x - G.x.y)
