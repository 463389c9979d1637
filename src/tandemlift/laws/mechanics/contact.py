"""Contact of a vehicle's feet with a level floor: normal force, and friction with stiction.

Every quadrotor has four feet. A foot is a pad on a ball joint, so its force acts at the joint's centre, ρ above the
pad. With the penetration δ of the pad and the displacement e of the joint from its anchor, in world axes,

    N = max(0, k δ + c δ̇) if δ > 0, else 0         F = −(k_t e + c_t ė), shortened to the length μ N if it is longer.

Both forces are passive. In N, k δ is a spring and the rest dissipates c δ̇², or −k δ δ̇ where N is cut to 0, which
happens only for δ̇ < −k δ/c. In F, k_t e is a spring and the rest dissipates power as long as |k_t e| ≤ μ N.
`grips_after_step` enforces that at the end of every step, with the smaller N of its start and its end, so that a foot
that has just landed stores no energy. Below μ N the anchor does not move: a vehicle at rest stays where it is.

A step evaluates `feet_load` at every stage with the anchors held, then `grips_after_step`. Only feet touch the floor.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tandemlift.algebra.arrays import array, eigenvectors, has_symbols, inverse, largest, largest_eigenvalue, lengths
from tandemlift.algebra.constants import GRAVITY
from tandemlift.algebra.law import elementwise, law
from tandemlift.algebra.ops import absolute, greatest, maximum, minimum, sqrt, where
from tandemlift.algebra.types import Condition, Number, PerQuadrotor, number
from tandemlift.algebra.vector import Mat3, Quarters, Vec3, apply, apply_transposed, cross, dot, spread, vec3
from tandemlift.laws.mechanics.loads import PartLoad, PartsLayout, add_to_each
from tandemlift.laws.mechanics.rigid_body import State
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion

MAX_ANGULAR_ACCELERATION = 1000.0  # rad/s², more than rotors give

TINY = 1e-300  # N²: keeps 0/0 out of the friction of a foot in the air
OSCILLATION = 0.5  # rad a step: the fastest oscillation on springs that a Runge-Kutta step resolves well
DECAY = 2.0  # time constants a step: the fastest decay; Runge-Kutta of order four is stable to 2.78


class Floor(NamedTuple):
    """A level floor, and the feet that stand on it.

    `height` z of the floor [m]; of one foot `stiffness` k [N/m] and `damping` c [N·s/m], `tangential_stiffness` k_t and
    `tangential_damping` c_t; `friction` μ; `radius` ρ [m]; `feet`: centre of foot j of every quadrotor from the
    system's centre of mass [m, body axes], vectors of sets. From there [m], `extent`: how
    far feet are along each body axis; `reach`: how far any pad can be.
    """

    height: Number
    stiffness: Number
    damping: Number
    friction: Number
    tangential_stiffness: Number
    tangential_damping: Number
    radius: Number
    feet: Quarters
    extent: Vec3
    reach: Number


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
def spring_damper(depth: Number, rate: Number, stiffness: Number, damping: Number) -> Number:
    """Normal force [N] at a penetration [m] that grows at a rate [m/s]; it never pulls and is passive."""
    return where(depth > 0.0, maximum(stiffness * depth + damping * rate, 0.0), 0.0)


@elementwise
def friction_factor(square: Number, longest: Number) -> Number:
    """The factor, at most 1, that shortens a vector of squared length `square` to the length `longest`."""
    return longest / sqrt(maximum(maximum(square, longest * longest), TINY))


@elementwise
def drawn_towards(anchor: Number, place: Number, factor: Number) -> Number:
    """The anchor drawn towards a place, to `factor` times its distance; unchanged at a factor of 1."""
    return where(factor < 1.0, place + (anchor - place) * factor, anchor)


@law
def foot_at(floor: Floor, s: State, R: Mat3, spin: Vec3, f: Vec3) -> Foot:
    """The feet at f [m, body axes] of a vehicle that turns at `spin` [rad/s, world axes]."""
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
def feet_at(floor: Floor, s: State, R: Mat3) -> Quarters:
    """The four feet of every quadrotor; R of the state's attitude."""
    spin, feet = apply(R, s.rates), floor.feet
    return Quarters(
        foot_at(floor, s, R, spin, feet.first),
        foot_at(floor, s, R, spin, feet.second),
        foot_at(floor, s, R, spin, feet.third),
        foot_at(floor, s, R, spin, feet.fourth),
    )


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
def feet_load(floor: Floor, grip: Quarters, frame: PartsLayout, s: State) -> PartLoad:
    """Load of the floor on every quadrotor, as sets: force, and moment about each quadrotor's centre of mass."""
    R = rotation_from_quaternion(s.attitude)
    a, b, c, d = feet_at(floor, s, R)
    f, g, h, i = (
        foot_force(floor, a, grip[0]),
        foot_force(floor, b, grip[1]),
        foot_force(floor, c, grip[2]),
        foot_force(floor, d, grip[3]),
    )
    force = f + g + h + i
    moment = cross(a.arm, f) + cross(b.arm, g) + cross(c.arm, h) + cross(d.arm, i)
    return PartLoad(force, apply_transposed(R, moment - cross(apply(R, frame.quadrotors), force)))


@law
def grips_after_step(floor: Floor, grip: Quarters, s: State) -> Quarters:
    """The memory after a step that ends in state `s`: feet in the air and sliding feet get new anchors."""
    a, b, c, d = feet_at(floor, s, rotation_from_quaternion(s.attitude))
    return Quarters(
        slide_grip(floor, a, grip[0]),
        slide_grip(floor, b, grip[1]),
        slide_grip(floor, c, grip[2]),
        slide_grip(floor, d, grip[3]),
    )


@law
def may_touch(floor: Floor, s: State, time: Number) -> Condition:
    """Whether a foot may touch the floor within `time` [s] of state `s`."""
    q, size = s.attitude, floor.extent
    tilt = Vec3(2.0 * (q.x * q.z - q.w * q.y), 2.0 * (q.y * q.z + q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))
    hangs = dot(absolute(tilt), size) + floor.radius
    swings = floor.reach * (sqrt(dot(s.rates, s.rates)) + MAX_ANGULAR_ACCELERATION * time) * time
    fall = (minimum(s.velocity.z, 0.0) - 2.0 * GRAVITY * time) * time  # four g, as thrust may add to weight
    return s.position.z + fall - minimum(hangs + swings, floor.reach) < floor.height


def mobility(points: NDArray[np.float64], mass: float, inertia: NDArray[np.float64]) -> float:
    """Mobility of a free body at some of its points [1/kg]: ω² of its fastest oscillation on springs of 1 N/m.

    Args:
        points: n × 3, from its centre of mass [m]; each is sprung in all three directions, so no attitude is faster.
        mass: of the body [kg].
        inertia: 3 × 3 about its centre of mass [kg·m²].
    """
    turns = [array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]) for x, y, z in points]  # motion of each, by rates
    if len(turns) == 1 and has_symbols(inertia):  # the same eigenvalue, but of a smaller matrix
        at_point = np.diag(array([1.0 / mass] * 3)) + turns[0] @ inverse(inertia) @ turns[0].T
        return greatest(tuple(eigenvectors(at_point, vectors=False)[0]))
    zero = np.zeros((3, 3))
    inertias = np.block([[np.diag(array([mass] * 3)), zero], [zero, inertia]])
    stiffness = np.zeros((6, 6))
    for turn in turns:
        G = np.hstack([np.eye(3), turn])
        stiffness = stiffness + G.T @ G
    return largest_eigenvalue(inertias, stiffness)


def surface_mobility(center: NDArray[np.float64], radius: float, mass: float, inertia: NDArray[np.float64]) -> float:
    """The largest `mobility` [1/kg] of the points where the principal axes leave a sphere."""
    axes = eigenvectors(inertia)[1].T * radius
    return greatest([mobility(center + side[None], mass, inertia) for side in (*axes, *-axes)])


def softened_for_step(stiffness: float, damping: float, body_mobility: float, step: float) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N·s/m] of springs, reduced, if need be, to what a step [s] can resolve.

    The damping ratio stays. `body_mobility` [1/kg]: the `mobility` of the body that stands on such springs.
    """
    frequency, rate = sqrt(stiffness * body_mobility), 0.5 * damping * body_mobility
    decay = rate + sqrt(maximum(rate**2 - frequency**2, 0.0))
    factor = 1.0 / greatest([1.0, frequency * step / OSCILLATION, decay * step / DECAY])
    return number(stiffness * factor**2), number(damping * factor)


def sole_positions(centers: ArrayLike, span: ArrayLike, depth: ArrayLike) -> NDArray[np.float64]:
    """Four soles under each quadrotor, N × 4 × 3 [m, body axes], from the same point as the centres.

    Args:
        centers: centres of mass of the quadrotors, N × 3 [m].
        span: of a foot along x and along y from there [m], one number or N.
        depth: of the soles below there [m], one number or N.
    """
    d = array(centers)
    size = np.stack([np.broadcast_to(v, len(d)) for v in (span, span, depth)], axis=1)
    return d[:, None] + size[:, None] * [[1.0, 1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, -1.0], [1.0, -1.0, -1.0]]


def floor(
    soles: ArrayLike,
    mass: float,
    inertia: ArrayLike,
    step: float,
    *,
    friction: float,
    height: float = 0.0,
    radius: float = 0.01,
    sinkage: float = 5e-4,
    damping_ratio: float = 1.0,
) -> Floor:
    """A floor for a vehicle: feet so stiff that it sinks by `sinkage` at rest, softer if the step demands it.

    Args:
        soles: N × 4 × 3, of the level vehicle, from its centre of mass [m, body axes].
        mass: of the vehicle [kg].
        inertia: 3 × 3 about its centre of mass [kg·m²].
        step: of the Runge-Kutta method [s].
        friction: μ of the pads on the floor.
        height: of the floor, z [m].
        radius: ρ, of the ball joint above the sole [m].
        sinkage: of the vehicle at rest on all its feet [m]; `sinkage_of` gives the actual one after softening.
        damping_ratio: of the heave oscillation on all its feet.
    """
    places = np.add(soles, [0.0, 0.0, radius])
    points = places.reshape(-1, 3)
    share = mass / len(points)
    wanted = share * GRAVITY / sinkage
    body_mobility = mobility(points, mass, array(inertia))
    k, c = softened_for_step(wanted, 2.0 * damping_ratio * sqrt(wanted * share), body_mobility, step)
    reach = number(greatest(lengths(points))) + radius
    feet = Quarters(*[spread(places[:, j]) for j in range(4)])
    extent = vec3(largest(np.abs(points), axis=0))
    return Floor(number(height), k, c, number(friction), k, c, float(radius), feet, extent, reach)


def standing_height(floor: Floor, weight: float) -> float:
    """Height of the level vehicle's centre of mass above the floor where its feet bear its weight [N], in m."""
    touching = [floor.radius - z for foot in floor.feet for z in foot.z]
    return greatest([_height_on(touching, lowest, weight / floor.stiffness) for lowest in touching])


def _height_on(touching: list[Number], lowest: Number, load: Number) -> Number:
    """Height [m] at which the soles that touch no later than one of them bear a load over their stiffness [m]."""
    bears = [touch >= lowest for touch in touching]
    share = [where(down, touch, 0.0) for down, touch in zip(bears, touching, strict=True)]
    return (sum(share) - load) / sum(where(down, 1.0, 0.0) for down in bears)


def sinkage_of(floor: Floor, weight: float) -> float:
    """How deep a vehicle of this weight [N] sinks at rest on all its feet [m]."""
    return weight / (floor.stiffness * 4 * len(floor.feet.first.x))


def start_foot_grip(floor: Floor, s: State) -> Quarters:
    """The memory of feet whose anchors are where the feet are in state `s`."""
    none = floor.feet.first.x * 0.0
    return grips_after_step(floor, Quarters(*[FootGrip(none, none, none)] * 4), s)
