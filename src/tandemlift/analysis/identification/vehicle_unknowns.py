"""The unknowns of a vehicle: keys as coordinates of a search, with their priors.

A number that is always positive is estimated by its logarithm. An inertia J is made of the second moments of the mass,
Σ = ∫ r rᵀ dm = L Lᵀ, J = tr(Σ) I − Σ, with logarithms of the diagonal of L: so every estimate is the inertia of a body
(Rucker and Wensing, IEEE Robotics and Automation Letters 7, 2022).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, unknown
from tandemlift.core.types import Array, flat, unflat
from tandemlift.engines.driven_vehicle import VehicleNumbers, vehicle_numbers
from tandemlift.missions import VehicleTable

SPREAD = 0.3  # standard deviation of the prior of a positive number, relative
UNLIKE = 0.05  # likewise, of what makes quadrotors that are alike in the table unlike
THIN = 1e-3  # least second moment over the mean of the three
MOST = 1.0  # largest standard deviation of the prior of a logarithm
WEIGHED = 0.0005  # of a weighed one: 95 % of scales err by less than 0.1 %
PAIRS = ((1, 0), (2, 0), (2, 1))  # places of the products Jxy, Jxz, Jyz


class DrivenNumbers(NamedTuple):
    """What the motion under logged commands depends on: the vehicle, its rotors' lags [s], their delay [s]."""

    vehicle: VehicleNumbers
    up: tuple[float, ...]
    down: tuple[float, ...]
    delay: float


class Kind(NamedTuple):
    """A key that can be estimated.

    Attributes:
        fields: of `DrivenNumbers` or `VehicleNumbers`, whose numbers the key has.
        unit: of the key.
        axes: components of a vector, 0 for a number.
        each: whether quadrotors have priors of their own, also where the table has the same for all.
        sd: standard deviation of the prior; None for a positive number, whose prior is relative. That of a product is
            relative to √(Σ_ii Σ_jj).
    """

    field: str
    unit: str
    axes: int = 0
    each: bool = False
    sd: float | None = None


KINDS = {
    "vehicle.payload.mass": Kind("mass", "kg"),
    "vehicle.payload.center_of_mass": Kind("center_of_mass", "m", 3, sd=0.1),
    "vehicle.payload.inertia": Kind("inertia", "kg m²", 3),
    "vehicle.payload.products": Kind("products", "kg m²", 3, sd=0.3),
    "vehicle.quadrotors.*.mass": Kind("masses", "kg", each=True),
    "vehicle.quadrotors.*.inertia": Kind("inertias", "kg m²", 3),
    "vehicle.quadrotors.*.thrust_constant": Kind("thrust_constants", "N/(rad/s)²", each=True),
    "vehicle.quadrotors.*.torque_per_thrust": Kind("torques_per_thrust", "m"),
    "vehicle.quadrotors.*.lag_up": Kind("up", "s"),
    "vehicle.quadrotors.*.lag_down": Kind("down", "s"),
    "actuators.delay": Kind("delay", "s", sd=0.02),
    "vehicle.drag.force": Kind("drag_force", "N s/m", 3, sd=0.2),
    "vehicle.drag.moment": Kind("drag_moment", "N m s", 3, sd=0.05),
    "vehicle.payload.drag_area": Kind("areas", "m²", 3),
}
DEFAULT = tuple(KINDS)
INERTIAS = {"inertia": "inertia", "products": "inertia", "inertias": "inertias"}
AXES = "xyz"


class Unknown(NamedTuple):
    """One number that is estimated.

    Attributes:
        key: of `KINDS`, with the number of the quadrotor in place of the asterisk where each has its own.
        axis: of a vector, else −1.
        quadrotors: those that have it, none for a number of the whole.
        weights: of what makes these unlike, a number for each, which add up to 0; none for what they share.
        start: its value in the table; 0 for what an inertia is made of.
        sd: standard deviation of its prior, of the logarithm if `positive`.
    """

    key: str
    axis: int
    quadrotors: tuple[int, ...]
    start: float
    sd: float
    positive: bool
    weights: tuple[float, ...] = ()

    @property
    def kind(self) -> Kind:
        """The kind of its key."""
        return KINDS[_pattern(self.key)]

    @property
    def name(self) -> str:
        """Its key, with the axis of a vector."""
        return f"{self.key}.{AXES[self.axis]}" if self.axis >= 0 else self.key


def _pattern(key: str) -> str:
    """The key with an asterisk in place of the number of a quadrotor."""
    parts = key.split(".")
    return ".".join("*" if part.isdigit() else part for part in parts)


@dataclass(frozen=True)
class Unknowns:
    """All unknowns of a vehicle, as coordinates: 0 for the values of its table.

    Attributes:
        start: the table's numbers.
        unknowns: each coordinate.
    """

    start: DrivenNumbers
    unknowns: tuple[Unknown, ...]

    def __len__(self) -> int:
        return len(self.unknowns)

    @property
    def sd(self) -> Array:
        """Standard deviations of their priors, as coordinates (P,)."""
        return np.array([u.sd for u in self.unknowns])

    @property
    def unweighed(self) -> Array:
        """The same without a scale (P,)."""
        return np.where(self.sd == WEIGHED, SPREAD, self.sd)

    def numbers(self, q: Array) -> DrivenNumbers:
        """The numbers of the vehicle at coordinates (P,)."""
        vehicle = {name: np.array(flat(value)) for name, value in self.start.vehicle._asdict().items()}
        own = {"up": np.array(self.start.up), "down": np.array(self.start.down), "delay": np.array([self.start.delay])}
        every, turned = vehicle | own, dict[tuple[str, int], Array]()
        for u, x in zip(self.unknowns, q, strict=True):
            field = u.kind.field
            if field in INERTIAS:
                for i, weight in zip(u.quadrotors or (0,), u.weights or itertools.repeat(1.0), strict=False):
                    change = turned.setdefault((INERTIAS[field], i), np.zeros(6))
                    change[u.axis + 3 * (field == "products")] += weight * x
                continue
            table = every[field].reshape(u.kind.axes or 1, -1)
            for i, weight in zip(u.quadrotors, u.weights, strict=False):
                table[max(u.axis, 0), i] *= math.exp(weight * x)
            if u.weights:
                continue
            for i in u.quadrotors or range(table.shape[1]):
                table[max(u.axis, 0), i] = u.start * math.exp(x) if u.positive else u.start + x
        for (field, i), change in turned.items():
            moments, whole = every[field].reshape(3, -1), field == "inertia"
            moments[:, i], products = _changed(moments[:, i], every["products"] if whole else np.zeros(3), change)
            if whole:
                every["products"] = products
        numbers = np.concatenate([every[name] for name in self.start.vehicle._fields])
        up, down = (tuple(every[name].tolist()) for name in ("up", "down"))
        return DrivenNumbers(unflat(numbers, self.start.vehicle), up, down, float(every["delay"][0]))

    def derivatives(self, q: Array) -> Array:
        """The derivatives of the numbers, depth first, by the coordinates (numbers, P)."""
        columns = []
        for i, u in enumerate(self.unknowns):
            h = np.zeros(len(q))
            h[i] = 1e-5 if u.positive else 1e-5 * u.sd
            ahead, behind = (np.array(_flat(self.numbers(x))) for x in (q + h, q - h))
            columns.append((ahead - behind) / (2.0 * h[i]))
        return np.array(columns).reshape(len(q), len(_flat(self.start))).T


def _flat(n: DrivenNumbers) -> list[float]:
    return [*flat(n.vehicle), *n.up, *n.down, n.delay]


def _changed(moments: Array, products: Array, change: Array) -> tuple[Array, Array]:
    """(Moments, products) of an inertia after a change of its coordinates (6)."""
    S = np.diag(0.5 * moments.sum() - moments)
    for (i, j), product in zip(PAIRS, products, strict=True):
        S[i, j] = S[j, i] = -product
    size = np.maximum(np.diag(S), THIN * np.trace(S) / 3.0)
    np.fill_diagonal(S, size)
    L = np.linalg.cholesky(S)
    for (i, j), x in zip(PAIRS, change[3:], strict=True):
        L[i, j] -= x * math.sqrt(size[i])
    for i, x in enumerate(change[:3]):
        L[i] *= math.exp(0.5 * x)
    S = L @ L.T
    return np.trace(S) - np.diag(S), np.array([0.0 - S[i, j] for i, j in PAIRS])


def driven_numbers(table: VehicleTable, delay: float) -> DrivenNumbers:
    """The numbers of a vehicle whose rotors receive commands late by a delay [s]."""
    quadrotors = table.quadrotors
    up, down = tuple(q.lag_up for q in quadrotors), tuple(q.lag_down for q in quadrotors)
    return DrivenNumbers(vehicle_numbers(table), up, down, delay)


def unknowns_of(
    vehicle: VehicleTable, delay: float, keys: Sequence[str] = DEFAULT, weighed: Mapping[str, float] | None = None
) -> Unknowns:
    """The unknowns of a vehicle.

    Args:
        vehicle: the table of about such a vehicle.
        delay: of its rotors [s].
        keys: of `KINDS`; all are estimated by default.
        weighed: masses [kg] known from a scale, by key; of one quadrotor with its number in place of the asterisk.

    Raises:
        InputError: a key cannot be estimated.
    """
    start = driven_numbers(vehicle, delay)
    every = {**start.vehicle._asdict(), **start._asdict()}
    found, N = list[Unknown](), len(start.up)
    for key in keys:
        if key not in KINDS:
            raise unknown("parameter", key, KINDS)
        kind = KINDS[key]
        value = every[kind.field]
        table = np.array(flat(value) if hasattr(value, "_fields") else value, dtype=float).reshape(kind.axes or 1, -1)
        for group in _groups(table, kind, N) if "*" in key else [()]:
            alike = len(group) == N or not group
            own = key if alike and not (kind.each and group) else key.replace("*", str(group[0]))
            for axis in range(kind.axes or 1):
                positive, column = kind.sd is None, table[:, group[0] if group else 0]
                number = 0.0 if kind.field in INERTIAS else float(column[axis])
                spread = SPREAD if kind.sd is None else kind.sd
                if kind.field in INERTIAS and positive:
                    moment = 0.5 * column.sum() - column  # a thin one is less certain than the moments of inertia
                    spread = min(SPREAD * max(1.0, moment.mean() / max(moment[axis], 1e-300)), MOST)
                shared = Unknown(own, axis if kind.axes else -1, group, number, spread, positive)
                found += [shared, *_unlike(shared)]
    return _weighed(Unknowns(start, tuple(found)), weighed or {})


def _unlike(shared: Unknown) -> list[Unknown]:
    """What makes the quadrotors of a shared number unlike: each but the first against those before it."""
    count, found = len(shared.quadrotors), list[Unknown]()
    for k in range(1, count):
        weights = np.array([1.0] * k + [-float(k)] + [0.0] * (count - k - 1)) / math.sqrt(k * (k + 1))
        found.append(shared._replace(sd=UNLIKE, weights=tuple(weights.tolist())))
    return found


def _groups(table: Array, kind: Kind, count: int) -> list[tuple[int, ...]]:
    """The quadrotors that share a prior: all of them if the table has the same for them, else each has its own."""
    if kind.each or not np.all(table == table[:, :1]):
        return [(i,) for i in range(count)]
    return [tuple(range(count))]


def _weighed(unknowns: Unknowns, weighed: Mapping[str, float]) -> Unknowns:
    """The unknowns with narrow priors at weighed masses.

    Raises:
        InputError: a key is no mass of a part, or its value is not positive.
    """
    found = list(unknowns.unknowns)
    masses = {u.name: i for i, u in enumerate(found) if u.kind.unit == "kg"}
    for key, value in weighed.items():
        if not masses:
            raise InputError(f"weighed {key}: no mass is among the parameters: add it to them, or leave weighed out")
        if key not in masses:
            raise unknown("weighed mass", key, masses)
        if not value > 0.0:
            raise InputError(f"weighed {key} = {value}: must be a mass above 0 kg")
        found[masses[key]] = found[masses[key]]._replace(start=value, sd=WEIGHED)
    return replace(unknowns, unknowns=tuple(found))
