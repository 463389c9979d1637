"""A vehicle from its parts: mass, centre of mass, inertia, and the matrices between wrench and rotor thrusts.

Body axes are parallel to the payload's; the beam lies along y. Rotors of a "+" quadrotor stand at +x, +y, −x, −y, of
an "x" 45° further, or at `rotor_positions`, all turned by its `heading` about z; without `spins`, the reaction torque
on the body of rotors 1 and 3 is about +z, of 2 and 4 about −z. Thrust is along body z, so heights do not enter the
allocation.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tandemlift.core.algebra import sqrt
from tandemlift.core.arrays import array, has_symbols, inverse, square_roots
from tandemlift.core.caching import cached
from tandemlift.core.errors import InputError
from tandemlift.core.types import GRAVITY, Array
from tandemlift.core.vector import Quat
from tandemlift.parts.mechanics.payload import Payload
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle_table import Drag, PlantTable, Quadrotor, VehicleTable


def condition_number(A: Any, inverted: Callable[[], Any]) -> Any:
    """The condition number of a matrix; with symbols, by Frobenius norms: up to n times as large."""
    if not has_symbols(A):
        return np.linalg.cond(A)
    return sqrt(np.sum(A * A) * np.sum(np.square(inverted())))


def mixer(quadrotor: Quadrotor) -> Array:
    """A (4 × 4) of one quadrotor: (thrust, roll, pitch, yaw moment about its centre) = A (rotor thrusts)."""
    # paper: total_i_thrust_moments_equ, input_vector_equ
    x, y = np.array(quadrotor.rotors).T
    return np.array([np.ones(4), y, -x, quadrotor.torque_per_thrust * np.array(quadrotor.spins, dtype=float)])


def mixer_inverse(quadrotor: Quadrotor) -> Array:
    """A⁻¹ (4 × 4): rotor thrusts from one quadrotor's thrust and moments.

    Raises:
        InputError: its rotors cannot produce every thrust and moment.
    """
    A = mixer(quadrotor)
    if quadrotor.rotor_positions is None and quadrotor.spins == (1, -1, 1, -1):
        return A.T / np.sum(A * A, axis=1)  # its columns are orthogonal
    if condition_number(A, lambda: inverse(A)) > 1e9:
        raise InputError(
            f"vehicle.quadrotors: rotors at {[list(r) for r in quadrotor.rotors]} with spins {list(quadrotor.spins)} "
            "cannot produce every thrust and moment: they must not all be in a line, and their spins must differ"
        )
    return inverse(A)


def parallel_axis_term(mass: float, d: Array) -> Array:
    """Parallel-axis term of a mass at d: m (dᵀd I − d dᵀ) [kg m²]."""
    return mass * (d @ d * np.eye(3) - np.outer(d, d))


NO_DRAG = Drag()
EQUAL = ((1.0, 1.0, 1.0, 1.0),)  # weights of the allocation


@dataclass(frozen=True, eq=False)
class Vehicle:
    """N ≥ 1 quadrotors rigidly fixed to a payload.

    Args:
        payload: the carried body.
        quadrotors: the quadrotors, number 1 first.
        drag: linear drag of the whole vehicle.

    Raises:
        InputError: no quadrotor is given.
    """

    payload: Payload
    quadrotors: Sequence[Quadrotor]
    drag: Drag = NO_DRAG

    def __post_init__(self) -> None:
        if not self.quadrotors:
            raise InputError("vehicle.quadrotors is empty; a vehicle needs at least one quadrotor")

    @staticmethod
    @cached
    def from_settings(table: VehicleTable) -> Vehicle:
        """The vehicle of a mission's table; the same object for the same table, because many missions share one."""
        return Vehicle(table.payload, table.quadrotors, table.drag)

    @classmethod
    def from_mission(cls, mission: Mapping[str, Any]) -> Vehicle:
        """The pilot's model of the vehicle, from a mission's nested tables, as a flight has them.

        Raises:
            InputError: the mission has no valid vehicle.
        """
        try:
            return cls.from_settings(VehicleTable.model_validate(mission["vehicle"]))
        except (KeyError, ValueError) as error:
            raise InputError(f"the mission's vehicle cannot be read: {error}") from error

    @property
    def count(self) -> int:
        """N, the number of quadrotors."""
        return len(self.quadrotors)

    @property
    def rotor_count(self) -> int:
        """Number of rotors, 4 N."""
        return 4 * self.count

    @property
    def mass(self) -> float:
        """Mass of the whole, m_t [kg]."""
        return self.payload.mass + sum(q.mass for q in self.quadrotors)

    @cached_property
    def center_of_mass(self) -> Array:
        """Centre of mass of the system, from the payload's origin [m], body axes (3)."""
        masses, positions = [q.mass for q in self.quadrotors], [q.position for q in self.quadrotors]
        moments = np.array(masses) @ np.array(positions) + self.payload.mass * np.array(self.payload.center_of_mass)
        return moments / self.mass

    @property
    def origin(self) -> Array:
        """The payload's origin, where its accelerometer is, from the system's centre of mass [m], body axes (3)."""
        return -self.center_of_mass

    @property
    def payload_center(self) -> Array:
        """The payload's centre of mass from the system's [m], body axes (3)."""
        return -(self.center_of_mass - np.array(self.payload.center_of_mass))

    @cached_property
    def lever_arms(self) -> Array:
        """Quadrotors' centres of mass from the system's [m], body axes (N × 3)."""
        return np.array([q.position for q in self.quadrotors]) - self.center_of_mass

    def quadrotor_motions(
        self, position: Array, velocity: Array, attitude: Array, rates: Array
    ) -> tuple[Array, Array, Array]:
        """Positions and velocities (N × 3) of the quadrotors, world axes, and R (3 × 3), body to world, of a state."""
        R = np.array(rotation_from_quaternion(Quat(*attitude.tolist())))
        arms = self.lever_arms
        return position + arms @ R.T, velocity + np.cross(rates, arms) @ R.T, R

    @property
    def rotor_hubs(self) -> list[list[tuple[float, float, float]]]:
        """The hubs of every quadrotor's rotors from its centre of mass [m], body axes (N × 4 × 3)."""
        return [[(x, y, q.rotor_height) for x, y in q.rotors] for q in self.quadrotors]

    @property
    def hubs(self) -> Array:
        """The hubs of all rotors from the system's centre of mass [m], body axes (4 N × 3)."""
        return (self.lever_arms[:, None] + array(self.rotor_hubs)).reshape(-1, 3)

    @property
    def soles(self) -> Array:
        """The soles of every quadrotor's feet from the system's centre of mass [m], body axes (N × 4 × 3)."""
        return self.lever_arms[:, None] + array([q.feet for q in self.quadrotors])

    @property
    def beam(self) -> tuple[float, float] | None:
        """Length and radius [m] of a payload that is a beam, else None."""
        payload = self.payload
        return (payload.length, payload.radius) if payload.length is not None and payload.radius is not None else None

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """The lowest and the highest corner of all parts [m], body axes, from the system's centre of mass (3 each)."""
        ends = []
        for q, (x, y, z) in zip(self.quadrotors, self.lever_arms, strict=True):
            wide = max(q.guard_radius, *[math.hypot(*r) + q.rotor_radius for r in q.rotors])
            ends += [(x - wide, y - wide, z - q.feet_depth), (x + wide, y + wide, z + max(q.rotor_height, 0.0))]
        low, high = self.payload.box
        ends += [tuple(self.origin + low), tuple(self.origin + high)]
        return np.min(ends, axis=0), np.max(ends, axis=0)

    def beside(self, point: Sequence[float]) -> float:
        """Distance of a point [m, body axes, from the system's centre of mass] from that box, 0 inside [m]."""
        low, high = self.box
        return math.dist(point, np.clip(point, low, high))

    @cached_property
    def inertia(self) -> Array:
        """J_t [kg m²] about the system's centre of mass, body axes (3 × 3)."""
        total = self.payload.tensor + parallel_axis_term(self.payload.mass, self.payload_center)
        for q, d in zip(self.quadrotors, self.lever_arms, strict=True):
            total = total + q.tensor + parallel_axis_term(q.mass, d)
        return total

    def real_inertia(self, plant: PlantTable) -> Array:
        """The real body's inertia about its centre of mass [kg m²], body axes (3 × 3).

        That centre is off the modelled one because the payload's mass is off its place, by as much as that takes.
        """
        J, off, scale = (
            self.inertia,
            array(plant.center_of_mass_offset),
            np.diag(square_roots(array(plant.inertia_scale))),
        )
        if any(x != 0.0 for x in plant.center_of_mass_offset):
            mass, place = self.payload.mass, self.payload_center
            moved = parallel_axis_term(mass, place + off * (self.mass / mass)) - parallel_axis_term(mass, place)
            J = J + moved - parallel_axis_term(self.mass, off)
        return scale @ J @ scale

    @cached_property
    def B(self) -> Array:
        """B (4 × 4N): (F_t, U_t) = B u_q, u_q the quadrotors' (thrust, roll, pitch, yaw moment) one after another.

        Erratum: the paper prints the sum of the two 4 × 4 blocks; they stand side by side.
        """
        # paper: b_matrix_equ, u_inputs
        blocks = []
        for x, y, _ in self.lever_arms:
            blocks.append(array([[1.0, 0.0, 0.0, 0.0], [y, 1.0, 0.0, 0.0], [-x, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]))
        return np.hstack(blocks)

    @cached_property
    def effect(self) -> Array:
        """(4 × 4N): (F_t, U_t) from the thrusts of all rotors."""
        blocks = np.split(self.B, self.count, axis=1)
        return np.hstack([B_i @ mixer(q) for B_i, q in zip(blocks, self.quadrotors, strict=True)])

    def H(self, weights: Sequence[Sequence[float]]) -> Array:
        """H (4N × 4N) with ‖H u_q‖² = Σ c u_q², c four weights for all quadrotors or four for each.

        Erratum: the paper prints a cost that is linear in u, which has no minimum.

        Raises:
            InputError: the number of rows is neither 1 nor N.
        """
        # paper: h_matrix_equ, cost_fun_equ
        rows = array(weights)
        if rows.shape not in ((1, 4), (self.count, 4)):
            raise InputError(
                f"allocation.weights = {[list(r) for r in weights]} does not fit {self.count} quadrotors: "
                "give one number, four, or four for each quadrotor"
            )
        return np.diag(square_roots(np.broadcast_to(rows, (self.count, 4)).ravel()))

    def pseudo_inverse(self, weights: Sequence[Sequence[float]] = EQUAL) -> Array:
        """(4N × 4): the u_q of least ‖H u_q‖ that gives a wrench: H⁻²Bᵀ(BH⁻²Bᵀ)⁻¹."""
        # paper: optim_fun_equ, optim_cont_final_equ
        H = self.H(weights)
        if has_symbols(H) or has_symbols(self.B):
            scaled = self.B.T / np.square(np.diag(H))[:, None]
        else:
            scaled = inverse(H**2) @ self.B.T
        return scaled @ inverse(self.B @ scaled)

    def allocation(self, weights: Sequence[Sequence[float]] = EQUAL) -> Array:
        """(4N × 4): thrusts of all rotors from a wrench, by `pseudo_inverse` and each quadrotor's mixer inverse."""
        return _allocation(self, tuple(map(tuple, weights)))

    @property
    def max_thrust(self) -> float:
        """Largest total thrust of all rotors [N]."""
        return sum(4.0 * q.thrust_limit for q in self.quadrotors)

    @property
    def weight(self) -> float:
        """m_t g [N]."""
        return self.mass * GRAVITY


@cached
def _allocation(vehicle: Vehicle, weights: tuple[tuple[float, ...], ...]) -> Array:
    parts = np.split(vehicle.pseudo_inverse(weights), vehicle.count, axis=0)
    return np.vstack([mixer_inverse(q) @ u for q, u in zip(vehicle.quadrotors, parts, strict=True)])
