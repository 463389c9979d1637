"""A hovering vehicle: its true weight, and the thrust and moments of its rotors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift.core.caching import cached
from tandemlift.core.types import GRAVITY, Array
from tandemlift.core.vector import set_of
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import PlantTable
from tandemlift.parts.rotors.allocation import AllocationState, AllocationTable, mixer_from, weighted_rows, wrench_of
from tandemlift.parts.rotors.rotor_faults import FaultTable
from tandemlift.parts.rotors.rotors import ActuatorsTable
from tandemlift.parts.rotors.thrust_limit_solver import BoundedProblem, limited_thrusts

CONTROL = 0.15  # of the largest moment, reserved for control, as supervision.checks.thrust_fraction does for the thrust
HELD = 1e4  # weight of what is held against the moment that is made as large as possible: held to 1e-6 of it


class HoverFacts(NamedTuple):
    """A vehicle with its rotors, and the facts of its hover.

    Attributes:
        vehicle: the vehicle as the pilot assumes it.
        plant: deviations of the real body from it.
        actuators: model of the rotors.
        allocation: distribution of a wrench over the rotors.
        faults: all faults of rotors within the flight.
    """

    vehicle: Vehicle
    plant: PlantTable
    actuators: ActuatorsTable
    allocation: AllocationTable
    faults: tuple[FaultTable, ...]

    @property
    def mass(self) -> float:
        """The true mass [kg]."""
        return self.vehicle.mass * self.plant.mass_scale

    @property
    def payload_mass(self) -> float:
        """The payload's mass in the joint forces [kg], which assign all of the difference in mass to it."""
        return self.vehicle.payload.mass + (self.plant.mass_scale - 1.0) * self.vehicle.mass

    @property
    def weight(self) -> float:
        """The true weight [N]."""
        return self.vehicle.weight * self.plant.mass_scale

    @property
    def lift(self) -> float:
        """The largest thrust of all rotors together [N]."""
        return self.vehicle.max_thrust * self.plant.thrust_scale

    @property
    def level_lift(self) -> float:
        """The largest thrust of all rotors together without a moment about the real centre of mass [N].

        It is less than `lift` where quadrotors differ: the weaker ones limit what the others give.
        """
        return _level_lift(self.vehicle, tuple(self.most.tolist()), self.plant.center_of_mass_offset[:2])

    @property
    def most(self) -> Array:
        """The largest thrust of a rotor of each quadrotor [N] (N)."""
        return np.array([q.thrust_limit for q in self.vehicle.quadrotors]) * self.plant.thrust_scale

    @property
    def faulty_lift(self) -> float:
        """The largest thrust of all rotors together with all faults of the flight [N]."""
        left = np.tile(self.most, (4, 1))  # of each rotor, so that nothing is left of none by rounding
        for f in self.faults:
            left[f.rotor - 1, f.quadrotor - 1] *= f.efficiency
        return float(left.sum())

    @property
    def lag(self) -> float:
        """The mean lag of the rotors, up and down [s]."""
        return sum(self.lags) / self.vehicle.count

    @property
    def lags(self) -> list[float]:
        """The lag of each quadrotor's rotors [s] (N), the mean of up and down."""
        return [0.5 * (q.lag_up + q.lag_down) for q in self.vehicle.quadrotors]

    @property
    def response_time(self) -> float:
        """The time after which rotors follow a command [s]: delay and the slower lag; 0 of ideal ones."""
        if self.actuators.model == "ideal":
            return 0.0
        return self.actuators.delay + max(max(q.lag_up, q.lag_down) for q in self.vehicle.quadrotors)

    @property
    def thrusts(self) -> Array:
        """Thrusts of all rotors [N] by the allocation of the weight, at the real centre of mass (N × 4)."""
        inverse, (x, y, _) = self.vehicle.allocation(self.allocation.weights), self.plant.center_of_mass_offset
        return (inverse[:, 0] + y * inverse[:, 1] - x * inverse[:, 2]).reshape(-1, 4) * self.weight

    @property
    def share(self) -> float:
        """The thrust of the most loaded rotor, of the largest that it can give."""
        return float(np.max(self.thrusts / self.most[:, None]))

    def largest_payload(self, share: float) -> float:
        """The largest mass of such a payload [kg] with which no rotor exceeds a share of its thrust; 0 if none."""
        low, high, payload = 0.0, self.lift / GRAVITY, self.vehicle.payload
        for _ in range(50):
            mass = 0.5 * (low + high)
            heavier = Vehicle(payload.model_copy(update={"mass": mass}), self.vehicle.quadrotors)
            low, high = (mass, high) if self._replace(vehicle=heavier).share <= share else (low, mass)
        return low

    @property
    def authority(self) -> Array:
        """The largest moment [N m] about each body axis, either way, by the allocation's pseudo-inverse (3).

        With thrusts f₀ in hover and the moment's column a of the inverse, the first rotor reaches a limit at the least
        of (f_max − f₀)/a and f₀/(−a).
        """
        column = self.vehicle.allocation(self.allocation.weights)[:, 1:]
        return np.minimum(self._room(column), self._room(-column))

    @property
    def largest_moments(self) -> Array:
        """The largest moment [N m] about each body axis, either way, that rotors within limits can exert in hover (3).

        By any thrusts whose sum is the weight and whose other two moments are zero: `authority` is what the mission's
        allocation makes of it.
        """
        return np.array(_largest_moments(self.vehicle, tuple(self.most.tolist()), self.weight))

    @property
    def usable_authority(self) -> Array:
        """`authority` less what is reserved for control [N m] (3)."""
        return (1.0 - CONTROL) * self.authority

    def largest_push(self, place: Array, way: Array) -> float:
        """The push [N] along a unit vector at a place from the centre of mass [m] with which a rotor saturates.

        The allocation's pseudo-inverse counters its vertical part and its moment in hover; the rest takes tilt, which
        needs a thrust that is larger by the square of a small angle only. Body axes.
        """
        counter = -np.array([way[2], *np.cross(place, way)])
        return float(self._room((self.vehicle.allocation(self.allocation.weights) @ counter)[:, None])[0])

    def _room(self, column: Array) -> Array:
        """The multiples of some thrusts (R × n) [N] that the rotors can add in hover (n)."""
        most = np.repeat(self.most, 4)
        hover = self.thrusts.ravel()
        up, down = np.maximum(most - hover, 0.0)[:, None], np.maximum(hover, 0.0)[:, None]
        return (np.where(column > 0.0, up, down) / np.maximum(np.abs(column), 1e-12)).min(axis=0)


@cached
def _largest_moments(vehicle: Vehicle, most: tuple[float, ...], weight: float) -> list[float]:
    wrench = np.array([weight, 0.0, 0.0, 0.0])
    found = [[_most_of(vehicle.effect, most, axis, way, wrench) for axis in (1, 2, 3)] for way in (1, -1)]
    return [float(x) for x in np.min(found, axis=0)]


@cached
def _level_lift(vehicle: Vehicle, most: tuple[float, ...], offset: tuple[float, float]) -> float:
    effect = vehicle.effect.copy()
    effect[1:3] += np.outer([-offset[1], offset[0]], effect[0])  # moments about the real centre of mass
    return _most_of(effect, most, 0, 1, np.zeros(4))


def _most_of(effect: Array, most: tuple[float, ...], axis: int, way: int, held: Array) -> float:
    """The largest entry of a wrench, up (1) or down (-1), by rotors within limits that hold its other entries."""
    limits, weights = np.repeat(most, 4), np.where(np.arange(4) == axis, 1.0, HELD)
    top, none = set_of(limits.tolist()), set_of([0.0] * len(limits))
    wanted = np.where(weights == 1.0, 2.0 * way * np.abs(effect) @ limits, held)
    problem = BoundedProblem(
        mixer_from(weighted_rows(effect, weights)), wrench_of(weights), wrench_of(wanted), none, top
    )
    thrusts = limited_thrusts(problem, AllocationState(none, none), 64 * len(limits))[0].thrusts
    return float(abs(effect[axis] @ np.array(tuple(thrusts))))
