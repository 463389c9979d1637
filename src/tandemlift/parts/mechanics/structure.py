"""A vehicle whose beam bends and whose mounts give: elastic modes beside the motion of the rigid body.

The body axes are the mean axes of the deformed vehicle (Tisserand): its centre of mass is the state's position, and its
modes carry neither momentum nor angular momentum. So the equations of the rigid body stay, and each mode is an
oscillator, q̈ + 2 ζ ω q̇ + ω² q = φᵀf, under the forces and moments f at its places. What acts back, to first order: a
thrust turns by the slope at its quadrotor, and its lever arm moves. Left out are the moved places of the surroundings'
forces, the change of the inertia, and the stiffness that a static droop and centrifugal forces give.

Source: Canavin and Likins, Journal of Spacecraft and Rockets 14 (1977) 724, for the axes.
"""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.algebra import sqrt
from tandemlift.core.caching import cached
from tandemlift.core.errors import CheckResult, InputError, judged, refused
from tandemlift.core.law import choice, law
from tandemlift.core.part import FlightCheck, Part
from tandemlift.core.types import Number, PerQuadrotor
from tandemlift.core.vector import (
    Absent,
    Quat,
    Vec3,
    apply,
    apply_transposed,
    cross,
    dot,
    hamilton,
    linear,
    plus,
    several,
    spread,
    times,
    total,
    vec3,
)
from tandemlift.parts.mechanics.joint_loads import (
    PartLoad,
    PartLoads,
    PartsLayout,
    PerfectReadings,
    specific_force_at,
    sum_over_set,
)
from tandemlift.parts.mechanics.parts import Acceleration
from tandemlift.parts.mechanics.payload import ELASTIC
from tandemlift.parts.mechanics.push import BeamPush, CentralPush, PointPush, push_moment
from tandemlift.parts.mechanics.rigid_body import State, apply_inertia, with_unit_quaternion
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.structure_modes import ElasticModes, Motions, modes_of
from tandemlift.parts.mechanics.vehicle import Vehicle

LARGEST_SLOPE = 0.1  # rad: sines and angles differ by 0.2 %
TWIST_ARM = 0.25  # m: the place beside the axis at which a twist is compared with a displacement
PHASE_STEP = 0.5  # rad, ω · step of the fastest mode: RK4 then adds 2e-4 to its damping ratio and 5e-4 to its period
DIGITS = 10


@linear
class Deformation(NamedTuple):
    """Coordinates q [m √kg] of the elastic modes, and their rates [m √kg/s]."""

    coordinates: Any
    rates: Any

    def __add__(self, other: Deformation) -> Deformation:  # type: ignore[override]
        return plus(self, other)

    def __mul__(self, k: Number) -> Deformation:  # type: ignore[override]
        return times(self, k)


@linear
class ElasticState(NamedTuple):
    """The motion of the mean axes, and the deformation."""

    body: State
    shape: Deformation

    def __add__(self, other: ElasticState) -> ElasticState:  # type: ignore[override]
        return plus(self, other)

    def __mul__(self, k: Number) -> ElasticState:  # type: ignore[override]
        return times(self, k)


@with_unit_quaternion.register(ElasticState)
def _unit(s: ElasticState) -> ElasticState:
    return ElasticState(with_unit_quaternion(s.body), s.shape)


class PlaceShapes(NamedTuple):
    """A place, or every quadrotor (vectors of sets), in each mode: displacement [1/√kg], rotation [1/(m √kg)]."""

    displacement: Any
    rotation: Any


class BeamShapes(NamedTuple):
    """The payload in each mode at a place r from the vehicle's centre of mass: a + b × r + c y² + d y³ + e y⁴.

    `linear`: a and b. The others (c, d, e) are `Absent` for a rigid payload on mounts that give.
    """

    linear: PlaceShapes
    second: Any
    third: Any
    fourth: Any


class Structure(NamedTuple):
    """The modes of a vehicle.

    ω² [rad²/s²] and 2 ζ ω [rad/s] of each; their shapes at the payload's origin, at the quadrotors' centres of mass,
    along the payload, and the straight line nearest to that, by which loads on the payload as a whole act. `seen`: how
    far the centre of mass seems to move for a sensor at the origin that takes the vehicle for rigid. `bent`: the
    quadrotors from a rigid payload at its origin.
    """

    stiffness: Any
    damping: Any
    origin: PlaceShapes
    quadrotors: PlaceShapes
    along: BeamShapes
    mean: PlaceShapes
    seen: Any
    bent: PlaceShapes


@cached
def structure_of(vehicle: Vehicle, step: float) -> Structure | Absent:
    """The modes of a vehicle that its flight keeps, in steps of time [s]; `Absent` if it is rigid."""
    if not is_elastic(vehicle):
        return Absent()
    modes = kept_modes(vehicle, step)
    made, middle = several(len(modes.frequency)), int(np.argmin(np.abs(modes.stations)))
    origin = Motions(modes.payload.displacement[middle], modes.payload.rotation[middle])
    along, mean = _along(vehicle, modes)
    arms = [origin.at(arm) for arm in vehicle.lever_arms - vehicle.origin]
    rigid = Motions(*map(np.array, zip(*arms, strict=True)))
    w, ratio = rounded(modes.frequency), rounded(modes.damping)
    return Structure(
        stiffness=made(*(w * w).tolist()),
        damping=made(*(2.0 * ratio * w).tolist()),
        origin=_shapes(origin),
        quadrotors=_sets(modes.quadrotors),
        along=along,
        mean=_shapes(mean),
        seen=_vectors(origin.at(-vehicle.origin).displacement),
        bent=_sets(
            Motions(modes.quadrotors.displacement - rigid.displacement, modes.quadrotors.rotation - rigid.rotation)
        ),
    )


def rounded(x: Any) -> Any:
    """Numbers to ten digits of the largest, so that machines whose libraries round differently fly the same bits."""
    return np.round(x, DIGITS - 1 - math.floor(math.log10(max(float(np.abs(x).max()), 1e-9))))


def _vectors(x: Any) -> Any:
    """A vector for each mode, from an array (3 × n)."""
    return several(x.shape[1])(*map(vec3, rounded(x).T))


def _sets(motions: Motions) -> PlaceShapes:
    """Those of every quadrotor (N × 3 × n)."""
    made = several(motions.displacement.shape[-1])
    return PlaceShapes(*[made(*map(spread, np.moveaxis(rounded(x), -1, 0))) for x in motions])


def _shapes(motions: Motions) -> PlaceShapes:
    return PlaceShapes(*map(_vectors, motions))


def is_elastic(vehicle: Vehicle) -> bool:
    """Whether its beam bends or one of its mounts gives."""
    return vehicle.payload.is_elastic or any(q.joint_stiffness is not None for q in vehicle.quadrotors)


def kept_modes(vehicle: Vehicle, step: float) -> ElasticModes:
    """The lowest modes of an elastic vehicle, as many as its table has and as steps of time [s] can follow."""
    modes = modes_of(vehicle)
    within = int(np.sum(modes.frequency * step <= PHASE_STEP))
    return modes.first(min(within, vehicle.payload.modes))


def _along(vehicle: Vehicle, modes: ElasticModes) -> tuple[BeamShapes, Motions]:
    """The shapes along the payload from the vehicle's centre of mass, and those nearest to them of a rigid payload."""
    displacement, rotation = modes.payload
    origin, y = vehicle.origin, modes.stations + vehicle.origin[1]
    if len(y) == 1:
        whole = Motions(displacement[0], rotation[0])
        return BeamShapes(_shapes(whole.at(-origin)), Absent(), Absent(), Absent()), whole

    def fitted(degree: int) -> tuple[Motions, list[Any]]:
        powers = np.vander(y, degree + 1, increasing=True)
        c, *_ = np.linalg.lstsq(powers, displacement.reshape(len(y), -1), rcond=None)
        a, b, *more = c.reshape(degree + 1, *displacement.shape[1:])
        turn = np.array([b[2], rotation[:, 1].mean(axis=0), -b[0]])  # of u = a + turn × r, on the beam's axis
        return Motions(a, turn).at(-np.array([origin[0], 0.0, origin[2]])), more

    line, curves = fitted(4)
    return BeamShapes(_shapes(line), *map(_vectors, curves)), fitted(1)[0].at(origin)


@law
def superposed(shapes: Any, q: Any) -> Any:
    """Σ φ_i q_i: a vector, or one for each quadrotor."""
    return functools.reduce(operator.add, [shape * x for shape, x in zip(shapes, q, strict=True)])


@law
def work_on_modes(shapes: PlaceShapes, force: Vec3, moment: Vec3) -> Any:
    """The modal forces φᵀf of a force and a moment at a place, body axes."""
    pairs = zip(shapes.displacement, shapes.rotation, strict=True)
    return type(shapes.displacement)(*[dot(force, u) + dot(moment, turn) for u, turn in pairs])


@law
def work_on_modes_of_each(shapes: PlaceShapes, force: Vec3, moment: Vec3) -> Any:
    """The modal forces of a force and a moment at each quadrotor, body axes, vectors of sets."""
    pairs = zip(shapes.displacement, shapes.rotation, strict=True)
    return type(shapes.displacement)(*[_sum_of_set(force * u) + _sum_of_set(moment * turn) for u, turn in pairs])


@law
def _sum_of_set(v: Vec3) -> Number:
    s = sum_over_set(v)
    return s.x + s.y + s.z


@choice
def work_of_push(push: CentralPush | PointPush | BeamPush, k: Structure, attitude: Quat) -> Any:
    """The modal forces of a push."""


@work_of_push.register(CentralPush)
@work_of_push.register(PointPush)
def _on_rigid_payload(push: CentralPush | PointPush, k: Structure, attitude: Quat) -> Any:
    force = apply_transposed(rotation_from_quaternion(attitude), push.force)
    return work_on_modes(k.along.linear, force, push_moment(push, attitude))


@work_of_push.register(BeamPush)
def _on_beam(push: BeamPush, k: Structure, attitude: Quat) -> Any:
    R = rotation_from_quaternion(attitude)
    work = _on_rigid_payload(PointPush(push.force, push.spread), k, attitude)
    second, third, fourth = (apply_transposed(R, x) for x in (push.second, push.third, push.fourth))
    curves = zip(k.along.second, k.along.third, k.along.fourth, strict=True)
    return work + type(work)(*[dot(second, c) + dot(third, d) + dot(fourth, e) for c, d, e in curves])


@choice(absent="work")
def with_work_of_loads(loads: PartLoads | PartLoad | Absent, k: Structure, attitude: Quat, work: Any) -> Any:
    """Modal forces, with those of loads on the parts."""


@with_work_of_loads.register(PartLoads)
def _of_all_parts(loads: PartLoads, k: Structure, attitude: Quat, work: Any) -> Any:
    R = rotation_from_quaternion(attitude)
    on_payload = work_on_modes(k.mean, apply_transposed(R, loads.payload.force), loads.payload.moment)
    return _of_quadrotors(loads.quadrotors, k, attitude, work + on_payload)


@with_work_of_loads.register(PartLoad)
def _of_quadrotors(load: PartLoad, k: Structure, attitude: Quat, work: Any) -> Any:
    force = apply_transposed(rotation_from_quaternion(attitude), load.force)
    return work + work_on_modes_of_each(k.quadrotors, force, load.moment)


class TurnedThrusts(NamedTuple):
    """What turned and shifted thrusts add: force and moment about the centre of mass (body axes), and modal forces."""

    force: Vec3
    moment: Vec3
    work: Any


@law
def turned_thrusts(
    k: Structure, frame: PartsLayout, inverse_mass: Number, thrusts: PerQuadrotor, q: Any
) -> TurnedThrusts:
    """The effect of the deformation on thrusts [N] of the quadrotors, to first order.

    A thrust turns by the slope at its quadrotor. What it does not carry of the quadrotor's own weight (and inertia)
    pushes at the joint, about which the quadrotor's centre of mass has turned: as of a pendulum that stands or hangs.
    """
    shift, turn = superposed(k.quadrotors.displacement, q), superposed(k.quadrotors.rotation, q)
    none = thrusts * 0.0
    aside = Vec3(turn.y * thrusts, -(turn.x * thrusts), none)  # turn × (0, 0, thrust)
    arms = cross(frame.quadrotors, aside) + Vec3(shift.y * thrusts, -(shift.x * thrusts), none)
    left, leant = thrusts - frame.mass * (total(thrusts) * inverse_mass), cross(frame.joints, turn)
    about_joint = Vec3(leant.y * left, -(leant.x * left), none)
    return TurnedThrusts(
        sum_over_set(aside), sum_over_set(arms), work_on_modes_of_each(k.quadrotors, aside, about_joint)
    )


@law
def modal_acceleration(k: Structure, shape: Deformation, work: Any) -> Any:
    """q̈ of every mode under its modal force."""
    rows = zip(work, k.stiffness, shape.coordinates, k.damping, shape.rates, strict=True)
    return type(work)(*[f - stiffness * q - damping * rate for f, stiffness, q, damping, rate in rows])


@law(absent="readings")
def elastic_readings(
    k: Structure,
    frame: PartsLayout,
    s: State,
    shape: Deformation,
    a: Acceleration,
    bending: Deformation,
    struck: PartLoads | Absent,
    readings: PerfectReadings,
) -> PerfectReadings:
    """The readings of sensors that move and turn with their places, from those of the rigid body.

    `a`: of the mean axes; `bending`: the rate of the shape, without the mean loads of walls that `struck`.
    Quadrotors' sensors read in the axes of their quadrotor.
    """
    acceleration = with_work_of_loads(struck, k, s.attitude, bending.rates)
    q, felt = shape.coordinates, readings.specific_force
    more = superposed(k.origin.displacement, acceleration) - cross(superposed(k.origin.rotation, q), felt)
    turn, here = superposed(k.quadrotors.rotation, q), specific_force_at(s, a, frame.quadrotors)
    shaken = superposed(k.quadrotors.displacement, acceleration) - cross(turn, here)
    force = -(shaken * Vec3(frame.mass, frame.mass, frame.mass))
    couple = -apply_inertia(frame.inertia, superposed(k.quadrotors.rotation, acceleration))
    torque = couple - cross(frame.joints, force)
    return PerfectReadings(
        felt + more, readings.joint_force + force, readings.joint_torque + torque, readings.contact_force
    )


@law(absent="s")
def seen_state(k: Structure, shape: Deformation, s: State) -> State:
    """The motion of the vehicle as sensors at the payload's origin see it, which take it for rigid."""
    q, rate, R = shape.coordinates, shape.rates, rotation_from_quaternion(s.attitude)
    turn, spin = superposed(k.origin.rotation, q), superposed(k.origin.rotation, rate)
    half = Quat(1.0, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z)
    return State(
        s.position + apply(R, superposed(k.seen, q)),
        s.velocity + apply(R, superposed(k.seen, rate)),
        hamilton(s.attitude, half * (1.0 / sqrt(dot(half, half)))),
        s.rates + spin,
    )


class ShapeChannels(NamedTuple):
    """Where each quadrotor is and how it turned, from its place on a rigid payload at the payload's origin."""

    deflection: Vec3
    slope: Vec3


@law(absent=Absent())
def shape_channels(k: Structure, shape: Deformation) -> ShapeChannels:
    """The channels of a deformation: displacement [m] and rotation [rad] of each quadrotor (vectors of sets)."""
    q = shape.coordinates
    return ShapeChannels(superposed(k.bent.displacement, q), superposed(k.bent.rotation, q))


def structure_refusals(vehicle: Vehicle, step: float) -> Iterator[CheckResult]:
    """Refusal of a structure of which no mode is slow enough for the step [s]."""
    if not is_elastic(vehicle):
        return
    try:
        modes = kept_modes(vehicle, step)
    except InputError as error:
        yield refused(str(error))
        return
    if not len(modes.frequency):
        lowest = float(modes_of(vehicle).frequency[0])
        yield refused(
            f"mission.step = {step:g}: must be at most {PHASE_STEP / lowest:.2g} s for the lowest mode of the vehicle, "
            f"{lowest / (2.0 * math.pi):.3g} Hz; or leave out vehicle.payload.material and joint_stiffness: it is rigid"
        )


class StructureMode(NamedTuple):
    """A mode that is flown: its shape in words, its angular frequency [rad/s], and its damping ratio."""

    shape: str
    frequency: float
    damping: float

    @property
    def hertz(self) -> float:
        """The frequency [Hz]."""
        return self.frequency / (2.0 * math.pi)


def structure_modes(vehicle: Vehicle, step: float) -> tuple[StructureMode, ...]:
    """The modes of a vehicle that its flight keeps, in steps of time [s], the slowest first; none of a rigid one."""
    if not is_elastic(vehicle):
        return ()
    modes = kept_modes(vehicle, step)
    numbers = zip(modes.frequency.tolist(), modes.damping.tolist(), strict=True)
    return tuple(StructureMode(mode_in_words(modes, i), w, ratio) for i, (w, ratio) in enumerate(numbers))


def structure_checks(vehicle: Vehicle, step: float) -> Iterator[CheckResult]:
    """The modes that are flown, and the slope of the hovering vehicle."""
    if not is_elastic(vehicle):
        return
    for mode in structure_modes(vehicle, step):
        subject = f"{mode.shape}, {mode.hertz:.3g} Hz, damping {mode.damping:.2g}"
        yield judged("mode", mode.frequency, PHASE_STEP / step, "rad/s", "", subject=subject, near=0.0)
    turn = hover_slopes(kept_modes(vehicle, step), vehicle)
    text = (
        f"in hover, the quadrotors lean by {turn:.2g} rad, and the model is one of small slopes, up to "
        f"{LARGEST_SLOPE:g} rad: stiffen the beam"
    )
    yield judged("slope", turn, LARGEST_SLOPE, "rad", text)


def hover_slopes(modes: ElasticModes, vehicle: Vehicle) -> float:
    """The largest slope [rad] of a quadrotor in hover, where each carries the same."""
    thrust = vehicle.weight / vehicle.count
    q = np.sum(modes.quadrotors.displacement[:, 2], axis=0) * thrust / np.square(modes.frequency)
    return float(np.abs(modes.quadrotors.rotation @ q).max())


def mode_in_words(modes: ElasticModes, i: int) -> str:
    """The shape of a mode: what bends or twists, and how its ends move."""
    x, _, z = np.sqrt(np.mean(np.square(modes.payload.displacement[:, :, i]), axis=0))
    ends = modes.quadrotors
    twist = TWIST_ARM * np.sqrt(np.mean(np.square(ends.rotation[:, 1, i])))
    kind = int(np.argmax([x, twist, z]))
    moved = ends.rotation[:, 1, i] if kind == 1 else ends.displacement[:, kind, i]
    name = ("bends sideways", "twists", "bends up and down")[kind]
    who = "mounts give, payload" if modes.mounts[i] > 0.5 else "beam"
    if len(moved) != 2:
        return f"{who} {name}"
    return f"{who} {name}, ends {'together' if moved[0] * moved[1] > 0.0 else 'against each other'}"


STRUCTURE = Part(
    *("structure", "plant", "vehicle.payload", ELASTIC, structure_of),
    remembers=False,
    refusals=structure_refusals,
    checks=structure_checks,
    rows=(
        FlightCheck(
            "mode",
            "angular frequency of each mode that is flown",
            "that which the step can follow",
            "rad/s",
            "a beam that bends, or mounts that give",
            "`vehicle.payload`, `vehicle.quadrotors.*.joint_stiffness`, `mission.step`",
        ),
        FlightCheck(
            "slope",
            "largest rotation of a quadrotor against the mean axes in hover",
            "0.1 rad, up to which displacements are linear",
            "rad",
            "a beam that bends, or mounts that give",
            "`vehicle.payload`, `vehicle.quadrotors.*.joint_stiffness`",
        ),
    ),
)
