"""Clearance of the vehicle from walls: of the guards around its quadrotors, of rotors out of them, and of its payload.

It is exact in every state: the walls near each part are known, and the distance to these is measured. The point of a
straight beam nearest to an upright wall is one of its ends, or lies at one of the wall's edges, or at its top. Of a
convex body it is that of its corners and edges, or of a face above one of the wall's upper corners.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

from tandemlift.core.algebra import least, minimum, sqrt
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Condition, Number, NumberSet, PerQuadrotor, PerRotor
from tandemlift.core.vector import Absent, Vec3, apply, dot, is_set
from tandemlift.parts.contact.beam_axis import beam_axis, beam_point, point_by_edge, point_by_top
from tandemlift.parts.contact.polyhedron import NearPolyhedron, Polyhedron, spots_by_walls
from tandemlift.parts.contact.spheres import NearRotors, RotorSpheres
from tandemlift.parts.contact.wall_geometry import Wall, offset, offset_from_top
from tandemlift.parts.contact.walls import Beam, NearBeam, NearWalls, Walls
from tandemlift.parts.mechanics.joint_loads import PartsLayout, translated
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

DISTANCE_WITHOUT_WALLS = 1000.0  # m
SEARCH_DISTANCE = 0.05  # m, by which the vehicle may move before the nearest walls are found anew


class Clearance(NamedTuple):
    """The smallest distance from walls [m], negative in contact: of every guard (a set), of rotors, of the beam.

    `rotors`: a `RotorClearance`, or `Absent` if all rotors are in their guard.
    """

    guards: PerQuadrotor
    rotors: RotorClearance | Absent
    beam: BeamClearance | Absent


class RotorClearance(NamedTuple):
    """The smallest distance of every rotor [m], a set; that of a rotor in its guard is its hub's."""

    rims: PerRotor


class BeamClearance(NamedTuple):
    """The smallest distance of the payload [m]: of a beam's ends or a body's corners (a set), and of all the rest."""

    ends: Number
    length: Number


@elementwise
def surface_distance(square: Number, radius: Number) -> Number:
    """Distance of a surface [m] whose axis is at a distance √square."""
    return sqrt(square) - radius


@law
def sphere_distance(o: Vec3, radius: Number) -> Number:
    """Distance of a surface [m] whose centre is at the offset o, which may be of sets."""
    return surface_distance(dot(o, o), radius)


@law
def nearest_distance(p: Vec3, first: Wall, second: Wall, radius: NumberSet) -> NumberSet:
    """The smaller distance of spheres about p from two walls [m]."""
    nearest: NumberSet = minimum(sphere_distance(offset(first, p), radius), sphere_distance(offset(second, p), radius))
    return nearest


@law(absent="rotors")
def rotor_clearance(rotors: RotorSpheres, near: NearRotors, s: State) -> RotorClearance:
    """Clearance of the rotors from the walls near them."""
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), rotors.hub))
    return RotorClearance(nearest_distance(p, near.first, near.second, rotors.radius))


@choice(absent="beam")
def beam_clearance(
    beam: Beam | Polyhedron | Absent, near: NearBeam | NearPolyhedron | Absent, frame: PartsLayout, s: State
) -> BeamClearance | Absent:
    """Clearance of the payload from the walls near it."""


@beam_clearance.register(Beam)
def _capsule(beam: Beam, near: NearBeam, frame: PartsLayout, s: State) -> BeamClearance:
    a, half = beam_axis(frame.payload, s), beam.ends[1]
    edge = offset(near.edge, beam_point(a, point_by_edge(a, half, near.edge)))
    other = offset(near.other_edge, beam_point(a, point_by_edge(a, half, near.other_edge)))
    top = offset_from_top(near.topped, beam_point(a, point_by_top(a, half, near.topped)))
    length = minimum(
        minimum(sphere_distance(edge, beam.radius), sphere_distance(other, beam.radius)),
        sphere_distance(top, beam.radius),
    )
    return BeamClearance(sphere_distance(offset(near.ends, beam_point(a, beam.ends)), beam.radius), length)


@beam_clearance.register(Polyhedron)
def _polyhedron(p: Polyhedron, near: NearPolyhedron, frame: PartsLayout, s: State) -> BeamClearance:
    first, second, *others = [sphere_distance(spots.offset, p.radius) for spots in spots_by_walls(p, near, frame, s)]
    return BeamClearance(minimum(first, second), least([least(distances) for distances in others]))


@law(absent="w")
def clearance(w: Walls, near: NearWalls, frame: PartsLayout, s: State) -> Clearance:
    """Clearance of the vehicle from the walls near it."""
    p = translated(s.position, apply(rotation_from_quaternion(s.attitude), frame.quadrotors))
    guards = nearest_distance(p, near.first, near.second, w.guards)
    rotors = rotor_clearance(w.rotors, near.rotors, s)
    return Clearance(guards, rotors, beam_clearance(w.beam, near.beam, frame, s))


@choice(absent=DISTANCE_WITHOUT_WALLS)
def least_clearance(c: Clearance | RotorClearance | BeamClearance | Absent) -> Number:
    """The smallest distance of a clearance [m]."""


@least_clearance.register(RotorClearance)
def _rotor_clearance(c: RotorClearance) -> Number:
    return least(c.rims)


@least_clearance.register(BeamClearance)
def _beam_clearance(c: BeamClearance) -> Number:
    return minimum(least(c.ends), c.length)


@least_clearance.register(Clearance)
def _vehicle_clearance(c: Clearance) -> Number:
    return minimum(minimum(least(c.guards), least_clearance(c.rotors)), least_clearance(c.beam))


@law
def speed_bound(w: Walls, s: State) -> Number:
    """An upper bound on the speed of every point of the vehicle [m/s]; on its acceleration, if `s` is the motion."""
    return sqrt(dot(s.velocity, s.velocity)) + w.reach * sqrt(dot(s.rates, s.rates))


@law
def is_fast(w: Walls, s: State, span: Number) -> Condition:
    """Whether the vehicle may move so far within a span [s] that other walls may be the nearest by then."""
    return speed_bound(w, s) * span > SEARCH_DISTANCE


@law
def may_touch_wall(w: Walls, c: Clearance, s: State, rate: State, dt: Number) -> Condition:
    """1 if any part may touch a wall in a step of dt [s] from state `s`, whose motion without walls is `rate`.

    Every point moves at no more than |v| + r |ω|, r the vehicle's reach, and accelerates by no more than the same bound
    on `rate`. The distance so covered is doubled for safety.
    """
    fast, faster = speed_bound(w, s), speed_bound(w, rate)
    return least_clearance(c) < 2.0 * dt * (fast + faster * dt)


C = TypeVar("C")


@law
def smaller_clearance(a: C, b: C) -> C:
    """The smaller of two clearances, distance by distance."""
    if isinstance(a, tuple) and isinstance(b, tuple) and not is_set(a):
        return type(a)(*[smaller_clearance(x, y) for x, y in zip(a, b, strict=True)])
    smaller: C = minimum(a, b)
    return smaller
