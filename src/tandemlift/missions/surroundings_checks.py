"""What a mission puts around the vehicle: floor, walls and wind that cannot be, and what may fly badly there."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra.constants import GRAVITY
from tandemlift.core.algebra.vector import vec3
from tandemlift.core.caching import kept
from tandemlift.core.errors import InputError
from tandemlift.core.outcomes import HARD
from tandemlift.core.settings import Mission, VehicleTable
from tandemlift.core.settings.corridor import SHORTEST
from tandemlift.core.settings.surroundings import GroundTable
from tandemlift.missions.values import shown
from tandemlift.parts.contact.feet import Floor, floor, sinkage_of, sole_positions, standing_height
from tandemlift.parts.contact.hull import hull, lowest_of_hull
from tandemlift.parts.contact.wall_geometry import offset, wall
from tandemlift.parts.mechanics.rotation import rotation_from_euler
from tandemlift.parts.mechanics.turbulence import FOOT, HIGHEST, LOWEST
from tandemlift.parts.vehicle import Vehicle

DEEP = 0.02  # m, of feet in the floor at the start
FAR_DOWN, FAR_UP = 0.02, 0.3  # m, of the landed reference above and below where the vehicle stands
THROWN = 5.0  # times its sinkage
NEARLY = 0.75  # of the impulse that ends a flight, as a contact gives back some of it
SOFT = 2.0  # times the sinkage that was asked for


class Standing(NamedTuple):
    """The floor and, as the vehicle really is, z [m] of its centre of mass where it stands, and its sinkage there [m].

    `depth`: of its lowest point in the floor at t = 0, beyond that sinkage [m].
    """

    floor: Floor
    rests: float
    sinkage: float
    depth: float


def check_surroundings(m: Mission) -> None:
    """Refuse a floor, walls or rotors stopped where the vehicle could not be.

    Raises:
        InputError: with the key, its value and what is allowed.
    """
    if m.ground.model == "none":
        _check_without_floor(m)
    elif m.ground.effect and m.actuators.model != "rotors":
        raise InputError('ground.effect = true: must be false where actuators.model is "ideal"')
    else:
        _check_start(m)
    for i, w in enumerate(m.walls):
        if math.dist(w.start, w.end) < SHORTEST:
            raise InputError(f"walls.{i}.end = {shown(w.end)}: must be {SHORTEST} m or more from walls.{i}.start")


def _check_without_floor(m: Mission) -> None:
    if m.ground.effect:
        raise InputError('ground.effect = true: must be false without a floor, or ground.model must be "floor"')
    if m.all_walls:
        raise InputError('ground.model = "none": must be "floor" where there are walls or a corridor')
    if m.phases.rotors == "flight":
        raise InputError(
            'phases.rotors = "flight": must be "always" without a floor, or the vehicle falls while its rotors are '
            'stopped; or ground.model must be "floor"'
        )


def _check_start(m: Mission) -> None:
    depth = standing_of(m).depth
    if depth > DEEP:
        key, value, hint = "ground.height", m.ground.height, "must be lower, or initial.position higher"
        if value is None:
            key, hint = "initial.euler", "must be level, or ground.height lower"
        given = shown(m.initial.euler if value is None else value)
        raise InputError(f"{key} = {given}: the vehicle starts {depth:.3g} m deep in the floor; {hint}")


def standing_of(m: Mission) -> Standing:
    """How the vehicle stands on the floor of a mission."""
    return _standing(m.vehicle, m.ground, m.plant.mass_scale, m.mission.step, m.initial.position[2], m.initial.euler)


@kept
def _standing(
    table: VehicleTable, g: GroundTable, mass_scale: float, step: float, z: float, euler: tuple[float, float, float]
) -> Standing:
    vehicle, fleet = Vehicle.from_settings(table), table.quadrotors
    mass = vehicle.mass * mass_scale
    soles = sole_positions(vehicle.lever_arms, [q.feet_spread for q in fleet], [q.feet_depth for q in fleet])
    shapes = hull(**vehicle.hull_shapes, mass=mass, inertia=vehicle.inertia, step=step)
    built = floor(soles, mass, vehicle.inertia, step, friction=g.friction, sinkage=g.sinkage, hull=shapes)
    stands, sinkage = standing_height(built, mass * GRAVITY), sinkage_of(built, mass * GRAVITY)
    height = z - stands if g.height is None else g.height
    R = rotation_from_euler(vec3(euler))
    lowest = z + min(float((soles @ np.array(R.z)).min()), lowest_of_hull(shapes, R))
    return Standing(built._replace(height=height), height + stands, sinkage, height - lowest - sinkage)


def surroundings_warnings(m: Mission) -> Iterator[str]:
    """What may fly badly, with the numbers."""
    if m.ground.model == "floor":
        standing = standing_of(m)
        yield from _of_floor(m, standing)
        yield from _of_start(m, standing)
        yield from _of_reference(m, standing)
        yield from _of_walls(m)
    yield from _of_wind(m)


def _of_floor(m: Mission, standing: Standing) -> Iterator[str]:
    if standing.sinkage > SOFT * m.ground.sinkage:
        yield (
            f"ground.sinkage = {m.ground.sinkage} m: with mission.step = {m.mission.step} s the floor must be softer, "
            f"and the standing vehicle sinks by {standing.sinkage:.2g} m"
        )
    if m.actuators.model == "ideal":
        yield (
            'actuators.model = "ideal": thrusts have no limits and may pull down, so the pilot may press the vehicle '
            'on the floor as hard as a blow; "rotors" cannot'
        )
    soles = min(q.position[2] - q.feet_depth for q in m.vehicle.quadrotors)
    radius = m.vehicle.payload.radius or 0.0
    if soles > -radius:
        yield f"the payload hangs {soles + radius:.3g} m lower than the feet: the vehicle stands on it, and may roll"


def _of_start(m: Mission, standing: Standing) -> Iterator[str]:
    depth, p = standing.depth, m.phases
    if depth > THROWN * standing.sinkage:
        height = f"{depth**2 / (2.0 * standing.sinkage):.2g} m"  # of springs, undamped
        yield f"the vehicle starts {depth:.2g} m deep in the floor, which throws the vehicle up by as much as {height}"
    if p.rotors == "flight" and p.lift_start > 0.0 and -depth > FAR_DOWN:
        yield f"the vehicle starts {-depth:.3g} m above the floor, with its rotors stopped until {p.lift_start:g} s"
    yield from _of_first_blow(m, depth)


def _of_first_blow(m: Mission, depth: float) -> Iterator[str]:
    """A start so fast into the floor that it ends the flight, or nearly so; a contact gives back some of the speed.

    With stopped rotors, a vehicle that starts upwards falls back as fast.
    """
    stopped = m.phases.rotors == "flight" and m.phases.lift_start > 0.0
    down = max(-m.initial.velocity[2], 0.0)
    speed = math.hypot(*m.initial.velocity) if stopped or down else 0.0
    mass = Vehicle.from_settings(m.vehicle).mass * m.plant.mass_scale
    limit = mass * HARD if m.crash.impulse is None else m.crash.impulse
    if -depth < FAR_DOWN and mass * speed > NEARLY * limit:
        straight = mass * down > NEARLY * limit
        speed = down if straight else speed
        what = f"[2] = {-down:g}" if straight else f" = {shown(m.initial.velocity)}"
        yield (
            f"initial.velocity{what} m/s drives the vehicle into the floor with "
            f"{mass * speed:.3g} N s, and a blow of {limit:.3g} N s (crash.impulse) ends the flight"
        )


def _of_reference(m: Mission, standing: Standing) -> Iterator[str]:
    p, rests = m.phases, standing.rests
    stops = math.inf if p.land_start is None else p.land_start + p.land_duration
    if p.rotors == "flight" and rests < -FAR_DOWN and stops < m.mission.duration:
        yield f"the landing ends at z = 0, {-rests:.3g} m above where the vehicle stands: then its rotors stop"
    if rests > FAR_UP:
        yield f"the vehicle stands at z = {rests:.3g} m while its reference, not lifted, is at z = 0: it presses down"


def _of_walls(m: Mission) -> Iterator[str]:
    R = np.array(rotation_from_euler(vec3(m.initial.euler)))
    centers = np.array(m.initial.position) + Vehicle.from_settings(m.vehicle).lever_arms @ R.T
    for i, w in enumerate(m.all_walls):
        name = f"walls.{i}" if i < len(m.walls) else f"wall {i - len(m.walls) + 1} of the corridor"
        upright = wall(w.start, w.end, w.top)
        for j, (q, center) in enumerate(zip(m.vehicle.quadrotors, centers, strict=True), 1):
            distance = math.hypot(*offset(upright, vec3(center)))
            if distance < q.guard_radius:
                yield f"quadrotor {j} starts {q.guard_radius - distance:.2g} m deep in {name}"


def _of_wind(m: Mission) -> Iterator[str]:
    w = m.wind
    if w.gusts and w.model == "none":
        yield 'wind.gusts do not blow while wind.model is "none"'
    lowest, highest = LOWEST * FOOT, HIGHEST * FOOT
    held = min(max(w.height, lowest), highest)
    if w.model == "air" and w.turbulence and abs(held - w.height) > 1e-6 * held:
        yield (
            f"wind.height = {w.height}: MIL-F-8785C gives the turbulence from {lowest:g} m to {highest:g} m; "
            f"that of {held:g} m blows"
        )
