"""Contact of a vehicle's feet with a level floor: normal force, and friction with stiction.

Every quadrotor has four feet. A foot is a pad on a ball joint, so its force acts at the joint's centre, ρ above the
pad. With the penetration δ of the pad and the displacement e of the joint from its anchor, in world axes,

    N = max(0, k δ + c δ̇) if δ > 0, else 0         F = −(k_t e + c_t ė), shortened to the length μ N if it is longer.

Both forces are passive. In N, k δ is a spring and the rest dissipates c δ̇², or −k δ δ̇ where N is cut to 0, which
happens only for δ̇ < −k δ/c. In F, k_t e is a spring and the rest dissipates power as long as |k_t e| ≤ μ N.
`grips_after_step` enforces that at the end of every step, with the smaller N of its start and its end, so that a foot
that has just landed stores no energy. Below μ N the anchor does not move: a vehicle at rest stays where it is.

A step evaluates `feet_load` at every stage with the anchors held, then `grips_after_step`. Other parts meet the floor
by their own law (`hull`).
"""

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import absolute, greatest, maximum, minimum, sqrt, where
from tandemlift.core.arrays import array, largest, lengths
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import GRAVITY, Condition, Number, PerQuadrotor, number
from tandemlift.core.vector import Absent, Mat3, Quarters, Vec3, apply, apply_transposed, cross, dot, spread, vec3
from tandemlift.parts.contact.hull import MAX_ACCELERATION, MAX_ANGULAR_ACCELERATION, Ellipsoids, Hull
from tandemlift.parts.contact.springs import friction_factor, mobility, softened_for_step, spring_damper
from tandemlift.parts.mechanics.joint_loads import PartLoad, PartsLayout, add_to_each
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion, world_z_in_body
from tandemlift.parts.mechanics.vehicle import Vehicle

NO_HULL = Absent()
RADIUS = 0.01  # m, of the ball joint above the sole
DAMPING_RATIO = 1.0  # of the heave oscillation on all feet


class Floor(NamedTuple):
    """A level floor, and the parts of the vehicle that touch it: feet, and its `hull`, a `Hull` or `Absent`.

    `height` z of the floor [m]; of one foot `stiffness` k [N/m] and `damping` c [N·s/m], `tangential_stiffness` k_t and
    `tangential_damping` c_t; `friction` μ; `radius` ρ [m]; `feet`: centre of foot j of every quadrotor from the
    system's centre of mass [m, body axes], vectors of sets. From there [m], `extent`: how far feet and hull reach along
    each body axis; `reach`: how far any point of them can be.
    """

    height: Number
    stiffness: Number
    damping: Number
    friction: Number
    tangential_stiffness: Number
    tangential_damping: Number
    radius: Number
    feet: Quarters[Vec3]
    extent: Vec3
    reach: Number
    hull: Hull | Absent


class FootGrip(NamedTuple):
    """Memory of one foot of every quadrotor, as sets: its anchor [m, world axes], and N [N] at the last step.

    The memory of a vehicle is `Quarters` of it.
    """

    x: PerQuadrotor
    y: PerQuadrotor
    normal: PerQuadrotor


class Foot(NamedTuple):
    """One foot of every quadrotor, world axes: lever arm from the centre of mass, position, velocity, and N."""

    arm: Vec3
    x: PerQuadrotor
    y: PerQuadrotor
    velocity_x: PerQuadrotor
    velocity_y: PerQuadrotor
    normal: PerQuadrotor


@elementwise
def drawn_towards(anchor: Number, place: Number, factor: Number) -> Number:
    """The anchor drawn towards a place, to `factor` times its distance; unchanged at a factor of 1."""
    return where(factor < 1.0, place + (anchor - place) * factor, anchor)


@law
def foot_at(floor: Floor, s: State, R: Mat3, spin: Vec3, f: Vec3) -> Foot:
    """The feet at f [m, body axes] of a vehicle that rotates at `spin` [rad/s, world axes]."""
    arm = apply(R, f)
    turn = cross(spin, arm)
    depth = add_to_each(-arm.z, floor.radius + floor.height - s.position.z)
    return Foot(
        arm,
        add_to_each(arm.x, s.position.x),
        add_to_each(arm.y, s.position.y),
        add_to_each(turn.x, s.velocity.x),
        add_to_each(turn.y, s.velocity.y),
        spring_damper(depth, add_to_each(-turn.z, -s.velocity.z), floor.stiffness, floor.damping),
    )


@law
def feet_at(floor: Floor, s: State, R: Mat3) -> Quarters[Foot]:
    """The four feet of every quadrotor; R of the state's attitude."""
    spin = apply(R, s.rates)
    return Quarters(*[foot_at(floor, s, R, spin, place) for place in floor.feet])


@law
def foot_force(floor: Floor, foot: Foot, grip: FootGrip) -> Vec3:
    """Force of the floor [N, world axes] on a foot of every quadrotor."""
    pull_x = (foot.x - grip.x) * floor.tangential_stiffness + foot.velocity_x * floor.tangential_damping
    pull_y = (foot.y - grip.y) * floor.tangential_stiffness + foot.velocity_y * floor.tangential_damping
    factor = friction_factor(pull_x * pull_x + pull_y * pull_y, foot.normal * floor.friction)
    return Vec3(-(pull_x * factor), -(pull_y * factor), foot.normal)


@law
def slide_grip(floor: Floor, foot: Foot, grip: FootGrip) -> FootGrip:
    """The anchor drawn after the foot until friction holds the spring, under the smaller N of now and before."""
    x, y = (foot.x - grip.x) * floor.tangential_stiffness, (foot.y - grip.y) * floor.tangential_stiffness
    factor = friction_factor(x * x + y * y, minimum(foot.normal, grip.normal) * floor.friction)
    return FootGrip(drawn_towards(grip.x, foot.x, factor), drawn_towards(grip.y, foot.y, factor), foot.normal)


@law
def feet_load(floor: Floor, grip: Quarters[FootGrip], frame: PartsLayout, s: State) -> PartLoad:
    """Load of the floor on every quadrotor, as sets: force, and moment about each quadrotor's centre of mass."""
    R = rotation_from_quaternion(s.attitude)
    a, b, c, d = feet_at(floor, s, R)
    f, g, h, i = [foot_force(floor, foot, held) for foot, held in zip((a, b, c, d), grip, strict=True)]
    force = f + g + h + i
    moment = cross(a.arm, f) + cross(b.arm, g) + cross(c.arm, h) + cross(d.arm, i)
    return PartLoad(force, apply_transposed(R, moment - cross(apply(R, frame.quadrotors), force)))


@law
def grips_after_step(floor: Floor, grip: Quarters[FootGrip], s: State) -> Quarters[FootGrip]:
    """The memory after a step that ends in state `s`: feet in the air and sliding feet get new anchors."""
    feet = feet_at(floor, s, rotation_from_quaternion(s.attitude))
    return Quarters(*[slide_grip(floor, foot, held) for foot, held in zip(feet, grip, strict=True)])


@law
def may_touch(floor: Floor, s: State, time: Number) -> Condition:
    """1 if a foot or any other part may touch the floor within `time` [s] of state `s`, else 0."""
    hangs = dot(absolute(world_z_in_body(s.attitude)), floor.extent) + floor.radius
    swings = floor.reach * (sqrt(dot(s.rates, s.rates)) + MAX_ANGULAR_ACCELERATION * time) * time
    fall = (minimum(s.velocity.z, 0.0) - 0.5 * MAX_ACCELERATION * time) * time
    return s.position.z + fall - minimum(hangs + swings, floor.reach) < floor.height


def floor(
    vehicle: Vehicle, mass: float, step: float, *, friction: float, sinkage: float = 5e-4, hull: Hull | Absent = NO_HULL
) -> Floor:
    """A floor at z = 0 for a vehicle, so stiff that it sinks by `sinkage` at rest; softer for a long step.

    Args:
        vehicle: whose feet stand on it.
        mass: of the real vehicle [kg].
        step: of the Runge-Kutta method [s].
        friction: μ of the pads on the floor.
        sinkage: of the vehicle at rest on all its feet [m]; `sinkage_of` gives the actual one after softening.
        hull: a `Hull` that meets the floor, too, or `Absent`.
    """
    places = np.add(vehicle.soles, [0.0, 0.0, RADIUS])
    points = places.reshape(-1, 3)
    share = mass / len(points)
    wanted = share * GRAVITY / sinkage
    body_mobility = mobility(points, mass, array(vehicle.inertia))
    k, c = softened_for_step(wanted, 2.0 * DAMPING_RATIO * sqrt(wanted * share), body_mobility, step)
    reach = number(greatest(lengths(points))) + RADIUS
    feet = Quarters(*[spread(places[:, j]) for j in range(4)])
    extent = vec3(largest(np.abs(points), axis=0))
    if isinstance(hull, Hull):
        extent, reach = maximum(extent, absolute(hull.middle) + hull.half), maximum(reach, hull.reach)
    return Floor(0.0, k, c, number(friction), k, c, RADIUS, feet, extent, reach, hull)


def standing_height(floor: Floor, weight: float) -> float:
    """Height [m] of the level vehicle's centre of mass above the floor when feet and beam carry its weight [N]."""
    springs = [(floor.radius - z, 1.0) for foot in floor.feet for z in foot.z]
    if isinstance(floor.hull, Hull) and isinstance(floor.hull.beam, Ellipsoids):
        ends, ratio = floor.hull.beam, floor.hull.stiffness / floor.stiffness
        springs += [(radius - z, ratio) for z, radius in zip(ends.center.z, ends.radius, strict=True)]
    return greatest([_height_on(springs, lowest, weight / floor.stiffness) for lowest, _ in springs])


def _height_on(springs: list[tuple[Number, Number]], lowest: Number, load: Number) -> Number:
    """Height [m] at which the springs that touch no later than one of them carry a load over a foot's stiffness [m].

    A spring is the height at which it touches [m], and its stiffness over that of a foot.
    """
    bears = [where(touch >= lowest, ratio, 0.0) for touch, ratio in springs]
    return (sum(share * touch for share, (touch, _) in zip(bears, springs, strict=True)) - load) / sum(bears)


def sinkage_of(floor: Floor, weight: float) -> float:
    """The sinkage [m] of a vehicle of this weight [N] at rest on all its feet."""
    return weight / (floor.stiffness * 4 * len(floor.feet.first.x))


def start_foot_grip(floor: Floor, s: State) -> Quarters[FootGrip]:
    """The memory of feet whose anchors are where the feet are in state `s`."""
    none = floor.feet.first.x * 0.0
    return grips_after_step(floor, Quarters(*[FootGrip(none, none, none)] * 4), s)
