"""How far the vehicle is from the walls: from the guards about its quadrotors, and from its beam.

Exact in every state, as what presses is: the walls near each part are known, and the distance to these is measured. A
straight beam is nearest to an upright wall with one of its ends, at one of the wall's edges, or at its top.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import least, minimum, sqrt
from tandemlift.algebra.types import Condition, Number, PerQuadrotor
from tandemlift.algebra.vector import Nothing, Vec3, apply, dot
from tandemlift.laws.mechanics.body import State
from tandemlift.laws.mechanics.loads import PartsLayout
from tandemlift.laws.mechanics.rectangle import offset, offset_from_top
from tandemlift.laws.mechanics.rotation import rotation_from_quaternion
from tandemlift.laws.mechanics.walls import (
    Beam,
    NearBeam,
    NearWalls,
    Walls,
    beam_axis,
    moved_to,
    on_beam,
    point_by_edge,
    point_by_top,
)

FAR = 1000.0  # m


class Clearance(NamedTuple):
    """The least distance from walls [m], below zero where it presses: of every guard (a set), and of the beam."""

    guards: PerQuadrotor
    beam: "BeamClearance | Nothing"


class BeamClearance(NamedTuple):
    """The least distance of the beam [m]: of its ends (a set), and along its length."""

    ends: Any
    length: Number


@elementwise
def between(square: Number, radius: Number) -> Number:
    """Distance of a surface [m] whose axis is √square away."""
    return sqrt(square) - radius


@law
def away(o: Vec3, radius: Number) -> Number:
    """Distance of surfaces [m] whose centres are o away, which may be of sets."""
    return between(dot(o, o), radius)


@choice(absent="beam")
def beam_clearance(beam: Beam | Nothing, w: Walls, near: NearBeam | Nothing, frame: PartsLayout, s: State) -> Any:
    """How far the beam is from the walls near it."""


@beam_clearance.register(Beam)
def _capsule(beam: Beam, w: Walls, near: NearBeam, frame: PartsLayout, s: State) -> BeamClearance:
    a, half = beam_axis(frame.payload, s), beam.ends[1]
    edge = offset(near.edge, on_beam(a, point_by_edge(a, half, near.edge)))
    other = offset(near.other_edge, on_beam(a, point_by_edge(a, half, near.other_edge)))
    top = offset_from_top(near.topped, on_beam(a, point_by_top(a, half, near.topped)))
    length = minimum(minimum(away(edge, beam.radius), away(other, beam.radius)), away(top, beam.radius))
    return BeamClearance(away(offset(near.ends, on_beam(a, beam.ends)), beam.radius), length)


@choice(absent="w")
def clearance(w: Walls | Nothing, near: NearWalls | Nothing, frame: PartsLayout, s: State) -> Any:
    """How far the vehicle is from the walls near it, as a `Clearance`."""


@clearance.register(Walls)
def _walls(w: Walls, near: NearWalls, frame: PartsLayout, s: State) -> Clearance:
    p = moved_to(s.position, apply(rotation_from_quaternion(s.attitude), frame.quadrotors))
    guards = minimum(away(offset(near.first, p), w.guards), away(offset(near.second, p), w.guards))
    return Clearance(guards, beam_clearance(w.beam, w, near.beam, frame, s))


@choice(absent=FAR)
def closest(c: Clearance | BeamClearance | Nothing) -> Number:
    """The least of a clearance [m]."""


@closest.register(BeamClearance)
def _of_a_beam(c: BeamClearance) -> Number:
    return minimum(least(c.ends), c.length)


@closest.register(Clearance)
def _of_a_vehicle(c: Clearance) -> Number:
    return minimum(least(c.guards), closest(c.beam))


@law
def fastest(w: Walls, s: State) -> Number:
    """A bound on the speed of every point of the vehicle [m/s], or on its acceleration, if `s` is the motion."""
    return sqrt(dot(s.velocity, s.velocity)) + w.reach * sqrt(dot(s.rates, s.rates))


@law
def may_press(w: Walls, c: Clearance, s: State, rate: State, dt: Number) -> Condition:
    """Whether anything may touch a wall in a step of dt [s] from state `s`, whose motion without walls is `rate`.

    Every point moves at no more than |v| + r |ω|, r the vehicle's reach, and that grows by what it is accelerated;
    twice that way is kept.
    """
    fast, faster = fastest(w, s), fastest(w, rate)
    return closest(c) < 2.0 * dt * (fast + faster * dt)


@choice(absent="a")
def nearer_of(a: Any, b: Any) -> Any:
    """The lesser of two clearances, part by part."""


@nearer_of.register(BeamClearance)
def _of_beams(a: BeamClearance, b: BeamClearance) -> BeamClearance:
    return BeamClearance(minimum(a.ends, b.ends), minimum(a.length, b.length))


@nearer_of.register(Clearance)
def _of_vehicles(a: Clearance, b: Clearance) -> Clearance:
    return Clearance(minimum(a.guards, b.guards), nearer_of(a.beam, b.beam))
