"""The modes of a vehicle whose beam bends and whose mounts give: finite elements, solved when it is assembled.

The beam is a row of Euler–Bernoulli elements along body y that bend in two planes and twist; it does not stretch. Each
quadrotor is a rigid body at its joint, whose mount is rigid or has a stiffness in six directions. A payload that is no
elastic beam is a rigid body. Displacements are small and along the body axes, from the payload's origin.

Source: Przemieniecki, Theory of Matrix Structural Analysis (1968), sections 5.6 and 11.3, for the elements; Johnson and
Kienholz, AIAA Journal 20 (1982) 1284, for the damping of a mode: each member's ratio, weighted by its strain energy.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from tandemlift.core.caching import cached
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.vehicle import Vehicle

ELEMENTS = 24  # of a beam, at least: its first six frequencies are within 1e-5 of those of a fine mesh
RIGID = 6  # modes of a free body without strain
SPLIT = 1e-7  # relative: a beam is so much stiffer along x, or the planes of its modes would hang on rounding
U, TURN = slice(0, 3), slice(3, 6)  # of a node: displacement [m], rotation [rad]


class Motions(NamedTuple):
    """Displacement and rotation of a place for each degree of freedom (3 × n each), or each mode."""

    displacement: Array
    rotation: Array

    def at(self, r: Array) -> Motions:
        """Those of a place that is rigidly fixed at r [m] from it."""
        return Motions(self.displacement + np.cross(self.rotation, r, axis=0), self.rotation)


class Mesh(NamedTuple):
    """The structure of a vehicle with n degrees of freedom.

    Attributes:
        mass: mass matrix (n × n).
        members: stiffness matrices (n × n) of the beam and of the mounts, with their damping ratios.
        stations: places y [m] of the nodes on the payload.
        nodes: their motions.
        quadrotors: motions of the quadrotors' centres of mass.
    """

    mass: Array
    members: list[tuple[Array, float]]
    stations: Array
    nodes: list[Motions]
    quadrotors: list[Motions]


class ElasticModes(NamedTuple):
    """The elastic modes of a free vehicle, mass-normalised, lowest first.

    Attributes:
        frequency: angular frequencies [rad/s] (n).
        damping: ratios (n).
        stations: places y along the payload [m] (s), from its origin.
        payload: motions there (s × 3 × n) [1/√kg], [rad/(m √kg)].
        quadrotors: motions of the quadrotors' centres of mass (N × 3 × n).
        mounts: share of the strain energy that is in the mounts (n).
    """

    frequency: Array
    damping: Array
    stations: Array
    payload: Motions
    quadrotors: Motions
    mounts: Array

    def first(self, count: int) -> ElasticModes:
        """The lowest of them."""
        payload, quadrotors = (Motions(*(x[..., :count] for x in m)) for m in (self.payload, self.quadrotors))
        return ElasticModes(
            self.frequency[:count], self.damping[:count], self.stations, payload, quadrotors, self.mounts[:count]
        )


def beam_element(h: float, bending: float, per_length: float, gyration: float) -> tuple[Array, Array]:
    """(Stiffness, mass) of a bending element (4 × 4), over displacement and slope at both ends.

    Args:
        h: length [m].
        bending: E I [N m²].
        per_length: mass per length [kg/m].
        gyration: radius of gyration of the section [m], for the inertia of its rotation (Rayleigh's beam).
    """
    k = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2]])
    K = np.vstack([k, -k[0], [6 * h, 2 * h**2, -6 * h, 4 * h**2]]) * (bending / h**3)
    a, b, c, d = 156.0, 22 * h, 54.0, 13 * h
    M = np.array([[a, b, c, -d], [b, 4 * h**2, d, -3 * h**2], [c, d, a, -b], [-d, -3 * h**2, -b, 4 * h**2]])
    r = np.array([[36, 3 * h, -36, 3 * h], [3 * h, 4 * h**2, -3 * h, -(h**2)]])
    turned = np.vstack([r, -r[0], [3 * h, -(h**2), -3 * h, 4 * h**2]])
    return K, M * (per_length * h / 420.0) + turned * (per_length * gyration**2 / (30.0 * h))


def _stations(vehicle: Vehicle, elements: int) -> Array:
    """The nodes of a beam: its ends, its middle, the joints, and enough between them."""
    half = 0.5 * (vehicle.payload.length or 0.0)
    joints = [min(max(q.joint_position[1], -half), half) for q in vehicle.quadrotors]
    fixed = np.unique(np.round([-half, 0.0, half, *joints], 12))
    apart = 2.0 * half / elements
    parts = [np.linspace(a, b, 1 + math.ceil((b - a) / apart - 1e-9))[:-1] for a, b in pairwise(fixed)]
    return np.append(np.concatenate(parts), half)


def mesh_of(vehicle: Vehicle, elements: int = ELEMENTS, *, slender: bool = False) -> Mesh:
    """The mesh of a vehicle; of a `slender` beam, sections have no inertia of rotation in bending."""
    payload, elastic = vehicle.payload, vehicle.payload.is_elastic
    stations = _stations(vehicle, elements) if elastic else np.zeros(1)
    own = [q for q in vehicle.quadrotors if q.joint_stiffness is not None]
    # a beam's nodes share one displacement along it, the last degree of freedom of the payload
    n = (5 * len(stations) + 1 if elastic else RIGID) + RIGID * len(own)
    unit, nodes = np.eye(n), list[Motions]()
    for i in range(len(stations)):
        if elastic:
            x, z, *turns = unit[5 * i : 5 * i + 5]
            nodes.append(Motions(np.array([x, unit[5 * len(stations)], z]), np.array(turns)))
        else:
            nodes.append(Motions(unit[U], unit[TURN]))
    mass, beam = np.zeros((n, n)), np.zeros((n, n))
    if elastic:
        _add_beam(vehicle, stations, nodes, mass, beam, slender)
    else:
        _add_body(mass, nodes[0].at(np.array(payload.center_of_mass)), payload.mass, payload.tensor)
    members, quadrotors, free = [(beam, payload.beam_damping)], list[Motions](), n - RIGID * len(own)
    for q in vehicle.quadrotors:
        joint, center = np.array(q.joint_position), np.array(q.position)
        i = int(np.argmin(np.abs(stations - joint[1])))
        base = np.array([0.0, stations[i], 0.0])
        if q.joint_stiffness is None:
            motions = nodes[i].at(center - base)
        else:
            motions = Motions(unit[free : free + 3], unit[free + 3 : free + 6])
            there, here = motions.at(joint - center), nodes[i].at(joint - base)
            gap = np.vstack([there.displacement - here.displacement, there.rotation - here.rotation])
            members.append((gap.T @ (np.array(q.joint_stiffness)[:, None] * gap), q.joint_damping))
            free += RIGID
        quadrotors.append(motions)
        _add_body(mass, motions, q.mass, q.tensor)
    return Mesh(mass, members, stations, nodes, quadrotors)


def _add_body(M: Array, at: Motions, mass: float, inertia: Array) -> None:
    M += mass * at.displacement.T @ at.displacement + at.rotation.T @ inertia @ at.rotation


def _add_beam(vehicle: Vehicle, stations: Array, nodes: list[Motions], M: Array, K: Array, slender: bool) -> None:
    """Add the elements of the beam: it bends along z with the rotation about x, along x with that about −z."""
    payload = vehicle.payload
    bending, torsion = payload.stiffnesses
    gyration, per_length = math.sqrt(payload.round_section.gyration_squared), payload.mass / float(np.ptp(stations))
    for i, h in enumerate(np.diff(stations).tolist()):
        a, b = nodes[i : i + 2]
        k, m = beam_element(h, bending, per_length, 0.0 if slender else gyration)
        for axis, turn, sign, more in ((2, 0, 1.0, 1.0), (0, 2, -1.0, 1.0 + SPLIT)):
            ends = np.array([x for e in (a, b) for x in (e.displacement[axis], sign * e.rotation[turn])])
            K += ends.T @ k @ ends * more
            M += ends.T @ m @ ends
        twist = np.array([a.rotation[1], b.rotation[1]])
        K += twist.T @ np.array([[1.0, -1.0], [-1.0, 1.0]]) @ twist * (torsion / h)
        M += twist.T @ np.array([[2.0, 1.0], [1.0, 2.0]]) @ twist * (2.0 * per_length * gyration**2 * h / 6.0)
    M += payload.mass * np.outer(nodes[0].displacement[1], nodes[0].displacement[1])


@cached
def modes_of(vehicle: Vehicle, elements: int = ELEMENTS, slender: bool = False) -> ElasticModes:
    """All elastic modes of a vehicle that is not rigid.

    Args:
        vehicle: with an elastic beam or a mount that gives.
        elements: of the beam, at least.
        slender: leave out the inertia of the rotation of the beam's sections in bending.

    Raises:
        InputError: masses and stiffnesses are too far apart to compute with.
    """
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            return _solved(mesh_of(vehicle, elements, slender=slender))
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        raise InputError(
            "vehicle.payload, vehicle.quadrotors: masses, lengths and stiffnesses must not be so far apart; the modes "
            "of the vehicle cannot be computed"
        ) from error


def _solved(mesh: Mesh) -> ElasticModes:
    K = np.sum([k for k, _ in mesh.members], axis=0)
    inverse = np.linalg.inv(np.linalg.cholesky(mesh.mass))
    squares, vectors = np.linalg.eigh(inverse @ K @ inverse.T)
    shapes = (inverse.T @ vectors)[:, RIGID:]
    frequency = np.sqrt(squares[RIGID:])
    energy = np.array([np.sum(shapes * (k @ shapes), axis=0) for k, _ in mesh.members]) / squares[RIGID:]
    # of two signs the one whose largest motion of the first quadrotor is positive
    first = np.vstack(mesh.quadrotors[0]) @ shapes
    shapes = shapes * np.sign(first[np.argmax(np.abs(first), axis=0), np.arange(first.shape[1])])
    of_places = lambda motions: Motions(*(np.array(group) @ shapes for group in zip(*motions, strict=True)))  # noqa: E731
    damping = np.array([ratio for _, ratio in mesh.members]) @ energy
    payload, quadrotors = of_places(mesh.nodes), of_places(mesh.quadrotors)
    return ElasticModes(frequency, damping, mesh.stations, payload, quadrotors, energy[1:].sum(axis=0))
