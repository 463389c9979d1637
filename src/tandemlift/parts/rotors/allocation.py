"""Control allocation: rotor thrusts from a wrench and back, by constant matrices, row by row, as sets of rotors."""

from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import GetCoreSchemaHandler
from pydantic_core import core_schema

from tandemlift.core.algebra import absolute, clip, least, maximum, minimum, sqrt, where
from tandemlift.core.arrays import array, square_roots
from tandemlift.core.caching import cached
from tandemlift.core.keys import Bandwidth, Delay, PerAxis, Positive, Scale, Table, is_number, key, must
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number, PerRotor, number
from tandemlift.core.vector import Absent, Vec3, dot, set_of, total, vec3
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.notch import NotchTable
from tandemlift.parts.rotors.rotor_faults import RotorFaults, efficiency_at

AFTER_FAILURE = 0.1  # of the priority of thrust, once a rotor has failed

Priorities = Annotated[tuple[Scale, Scale, Scale, Scale], PerAxis(4)]
Leads = Annotated[tuple[Delay, Delay, Delay, Delay], PerAxis(4)]


class Weights:
    """Mark of the allocation weights: one number, four, or four for each quadrotor."""

    def describe(self, limits: str) -> str:
        """The allowed values in words; `limits` is the condition on each number."""
        return f"one number {limits}, four numbers {limits}, or a list of four for each quadrotor"

    def rows(self, value: object) -> tuple[tuple[float, ...], ...]:
        """Rows of four: one for all quadrotors, or one each."""
        if is_number(value):
            value = [value] * 4
        if isinstance(value, (list, tuple)) and value:
            rows = value if all(isinstance(row, (list, tuple)) for row in value) else [value]
            if all(len(row) == 4 and all(map(is_number, row)) for row in rows):
                return tuple(map(tuple, rows))
        raise must("axes", f"be {self.describe('> 0')}")

    def __get_pydantic_core_schema__(self, source: type, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_before_validator_function(self.rows, handler(source))


class AllocationTable(
    Table, keys_act={"priorities": 'allocation.method = "constrained"', "lead_bandwidth": "allocation.lead > 0"}
):
    """`[allocation]`: how the wrench is distributed over the quadrotors."""

    method: Literal["pseudo-inverse", "constrained"] = key(
        "pseudo-inverse",
        None,
        "how the wrench is distributed over the rotors",
        choices={
            "pseudo-inverse": "the paper's weighted pseudo-inverse",
            "constrained": "beyond a rotor's limits, the thrusts within them that come closest to the wrench",
        },
    )
    weights: Annotated[tuple[tuple[Positive, Positive, Positive, Positive], ...], Weights()] = key(
        ((1.0, 1.0, 1.0, 1.0),),
        "1",
        "cost c of a quadrotor's thrust, roll, pitch and yaw moment",
        source="all equal; open in the paper",
    )
    priorities: Priorities = key(
        (300.0, 900.0, 900.0, 1.0),
        "1",
        "for 'constrained': weights of the errors in thrust, roll, pitch and yaw when the rotors cannot give all four; "
        "that of thrust is a tenth once a rotor has failed",
        source="chosen: roll and pitch first, then thrust, which keeps the weight, then yaw",
    )
    lead: Leads = key(
        (0.0, 0.0, 0.0, 0.0),
        "s",
        "lead times of thrust, roll, pitch and yaw, against lag and delay of the rotors; all 0: as the controller asks",
    )
    lead_bandwidth: Bandwidth = key(
        200.0, "rad/s", "bandwidth of the low-pass that smooths a wrench with lead time", source="chosen"
    )
    notches: tuple[NotchTable, ...] = ()


class Mixer(NamedTuple):
    """A 4 × 4N matrix by rows, each a set of 4N rotor values: of thrust, roll, pitch and yaw."""

    thrust: PerRotor
    roll: PerRotor
    pitch: PerRotor
    yaw: PerRotor


class ConstrainedAllocation(NamedTuple):
    """Allocation within limits: the pseudo-inverse, and the problem of `thrust_limit_solver` where it exceeds them.

    `rows` and `weights` of the weighted problem, `limits` [N] of all rotors, and the faults `known` to the pilot.
    """

    inverse: Mixer
    rows: Mixer
    weights: Wrench
    limits: PerRotor
    known: RotorFaults | Absent


class AllocationState(NamedTuple):
    """Memory: the working set (−1 at 0, 1 at the upper limit, 0 free), and the thrusts [N]; sets."""

    active: PerRotor
    thrusts: PerRotor


@choice
def allocate(how: Mixer | ConstrainedAllocation, u: Wrench) -> PerRotor:
    """Thrust of every rotor [N] for a wrench, whatever the rotors' limits."""


@allocate.register(Mixer)
def _pseudo_inverse(inverse: Mixer, u: Wrench) -> PerRotor:
    # u_q* and each quadrotor's mixer inverse, as one matrix (transposed)
    # paper: optim_cont_final_equ
    return inverse.thrust * u.thrust + inverse.roll * u.moment.x + inverse.pitch * u.moment.y + inverse.yaw * u.moment.z


@allocate.register(ConstrainedAllocation)
def _unlimited(how: ConstrainedAllocation, u: Wrench) -> PerRotor:
    return allocate(how.inverse, u)


@law
def limits_at(how: ConstrainedAllocation, left: Number, t: Number) -> PerRotor:
    """The largest thrust of every rotor at time t [s] that the pilot expects [N]; `left`: of a detected loss, or 1."""
    return how.limits * efficiency_at(how.known, t) * left


@elementwise
def command_for(thrust: Number, efficiency: Number) -> Number:
    """The command [N] that makes a rotor of reduced efficiency give a thrust [N]; 0 for a failed one."""
    return where(efficiency > 0.0, thrust / maximum(efficiency, 1e-9), 0.0)


@law
def rotor_commands(how: ConstrainedAllocation, thrusts: PerRotor, t: Number) -> PerRotor:
    """Commands [N] for these thrusts [N] at time t [s], given the faults that the pilot knows."""
    return command_for(thrusts, efficiency_at(how.known, t))


@elementwise
def outside_limits(thrust: Number, limit: Number) -> Number:
    """1 where a thrust is outside its limits, else 0."""
    return where(thrust < 0.0, 1.0, where(thrust > limit, 1.0, 0.0))


@elementwise
def has_failed(limit: Number, nominal: Number) -> Number:
    """1 where a rotor's limit is less than half its nominal one, else 0."""
    return where(limit < 0.5 * nominal, 1.0, 0.0)


@law
def with_failed(how: ConstrainedAllocation, limits: PerRotor) -> ConstrainedAllocation:
    """An allocation whose thrust comes after roll and pitch once a rotor has failed: else the vehicle turns over.

    Args:
        how: the allocation.
        limits: the largest thrusts that the pilot expects now [N], a set.
    """
    scale = where(total(has_failed(limits, how.limits)) > 0.0, AFTER_FAILURE, 1.0)
    rows, weights = how.rows, how.weights
    return how._replace(
        rows=rows._replace(thrust=rows.thrust * scale), weights=weights._replace(thrust=weights.thrust * scale)
    )


@law
def wrench(effect: Mixer, thrusts: PerRotor) -> Wrench:
    """The wrench of rotor thrusts [N]: B u_q with u_i = A f_i."""
    # paper: contro_input_equ
    return Wrench(
        dot(effect.thrust, thrusts),
        Vec3(dot(effect.roll, thrusts), dot(effect.pitch, thrusts), dot(effect.yaw, thrusts)),
    )


@law
def achieved_fraction(effect: Mixer, scale: Wrench, wanted: Wrench, thrusts: PerRotor) -> Number:
    """Fraction of a desired wrench that thrusts give: 1 − ‖B f − τ‖/‖τ‖ in units of `scale`, in [0, 1]; 1 for τ = 0.

    Args:
        effect: B, by rows.
        scale: one over the size of each component, as of `wrench_scale`.
        wanted: τ [N, N·m body axes].
        thrusts: f [N], a set.
    """
    made = wrench(effect, thrusts)
    short, moment = (made.thrust - wanted.thrust) * scale.thrust, (made.moment - wanted.moment) * scale.moment
    whole, turning = wanted.thrust * scale.thrust, wanted.moment * scale.moment
    size = whole * whole + dot(turning, turning)
    lost = (short * short + dot(moment, moment)) / where(size > 0.0, size, 1.0)
    return where(size > 0.0, clip(1.0 - sqrt(lost), 0.0, 1.0), 1.0)


def mixer_from(rows: NDArray[Any]) -> Mixer:
    """A 4 × 4N matrix as a Mixer."""
    return Mixer(*[set_of([number(x) for x in row]) for row in rows])


def weights_of(effect: NDArray[np.float64], priorities: ArrayLike) -> NDArray[np.float64]:
    """The diagonal of W (4): priority over row rms of the effect B (4 × n), so that priorities compare rotor for rotor.

    Args:
        effect: B (4 × n), rows thrust, roll, pitch, yaw.
        priorities: four numbers > 0, thrust, roll, pitch, yaw.
    """
    return array(priorities) / square_roots(np.mean(np.square(effect), axis=1))


def weighted_rows(effect: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """W B (4 × n), C-contiguous, the rows of a `thrust_limit_solver.BoundedProblem`."""
    return np.ascontiguousarray(weights[:, None] * effect)


def wrench_scale(effect: NDArray[np.float64]) -> Wrench:
    """1 / row rms of the effect B (4 × n): makes the four components of a wrench comparable (`achieved_fraction`)."""
    return wrench_of(weights_of(effect, np.ones(4)))


def wrench_of(four: NDArray[np.float64]) -> Wrench:
    """Four numbers, thrust, roll, pitch, yaw, as a wrench."""
    thrust, *moment = four
    return Wrench(number(thrust), vec3(moment))


def thrust_limits(vehicle: Vehicle) -> PerRotor:
    """The largest thrust of every rotor of a vehicle [N], a set."""
    return set_of([q.thrust_limit for q in vehicle.quadrotors for _ in range(4)])


def hover_moments(table: AllocationTable, vehicle: Vehicle) -> tuple[Number, Number]:
    """The largest roll and pitch moments [N·m], either way, that the pseudo-inverse adds to hover within the limits."""
    inverse, most = _inverse(vehicle, table.weights), thrust_limits(vehicle)
    hover = inverse.thrust * vehicle.weight
    return hover_moment(hover, most, inverse.roll), hover_moment(hover, most, inverse.pitch)


@law
def hover_moment(hover: PerRotor, most: PerRotor, column: PerRotor) -> Number:
    """The largest moment about an axis [N·m], either way, that an allocation adds to hover; 0 if it cannot hover.

    Args:
        hover: thrusts of the rotors in hover [N], a set.
        most: their largest thrusts [N].
        column: the thrusts for a unit moment [1/m].
    """
    return maximum(least(spare_moment(hover, most, column)), 0.0)


@elementwise
def spare_moment(hover: Number, most: Number, column: Number) -> Number:
    """The moment [N·m] with which a rotor reaches the nearer limit."""
    return minimum(most - hover, hover) / maximum(absolute(column), 1e-12)


@cached
def mixer_of(vehicle: Vehicle) -> Mixer:
    """The effect B of a vehicle's rotors."""
    return mixer_from(vehicle.effect)


@cached
def _inverse(vehicle: Vehicle, weights: tuple[tuple[float, ...], ...]) -> Mixer:
    return mixer_from(vehicle.allocation(weights).T)


@cached
def _weighted(vehicle: Vehicle, priorities: tuple[float, ...]) -> tuple[Mixer, Wrench]:
    weights = weights_of(vehicle.effect, priorities)
    return mixer_from(weighted_rows(vehicle.effect, weights)), wrench_of(weights)


def start_allocation(
    table: AllocationTable, vehicle: Vehicle, known: RotorFaults | Absent
) -> tuple[Mixer, Absent] | tuple[ConstrainedAllocation, AllocationState]:
    """The allocation and its memory before the first sample; `known`: the known rotor faults.

    Raises:
        InputError: the weights do not fit the vehicle.
    """
    inverse = _inverse(vehicle, table.weights)
    if table.method == "pseudo-inverse":
        return inverse, Absent()
    rows, weights = _weighted(vehicle, table.priorities)
    none = set_of([0.0] * vehicle.rotor_count)
    allocation = ConstrainedAllocation(inverse, rows, weights, thrust_limits(vehicle), known)
    return allocation, AllocationState(none, none)
