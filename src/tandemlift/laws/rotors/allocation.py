"""From a wrench to rotor thrusts and back: the constant matrices of a vehicle, row by row, as sets of rotors."""

from typing import Any, NamedTuple

from numpy.typing import NDArray

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import maximum, where
from tandemlift.algebra.types import Number, PerRotor
from tandemlift.algebra.vector import Vec3, dot, each
from tandemlift.laws.mechanics.body import Wrench
from tandemlift.laws.rotors.dynamics import NoFaults, RotorFaults, efficiency_at


class Mixer(NamedTuple):
    """A 4 × 4N matrix by rows, each a set of 4N rotor values: of thrust, roll, pitch and yaw."""

    thrust: PerRotor
    roll: PerRotor
    pitch: PerRotor
    yaw: PerRotor


class ConstrainedAllocation(NamedTuple):
    """Allocation within limits: the pseudo-inverse, and what `laws.rotors.thrust_limits` needs where it leaves them.

    `rows` and `weights` of the weighted problem, `limits` [N] of all rotors, and the faults that the pilot `known`s.
    """

    inverse: Mixer
    rows: Mixer
    weights: Wrench
    limits: PerRotor
    known: NoFaults | RotorFaults


class AllocationState(NamedTuple):
    """Memory: which rotors are held at a limit (−1 at 0, 1 at the most, 0 free), and the thrusts [N]; sets."""

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
def limits_at(how: ConstrainedAllocation, left: PerRotor, t: Number) -> PerRotor:
    """The most that every rotor gives at time t [s], as far as the pilot knows [N]; `left`: see `detection.left_of`."""
    return how.limits * efficiency_at(how.known, t) * left


@elementwise
def restored(thrust: Number, efficiency: Number) -> Number:
    """The command that makes a weakened rotor give a thrust; none to one that is lost."""
    return where(efficiency > 0.0, thrust / maximum(efficiency, 1e-9), 0.0)


@law
def commanded(how: ConstrainedAllocation, thrusts: PerRotor, t: Number) -> PerRotor:
    """Commands [N] that make the rotors give these thrusts at time t [s], as far as the pilot knows."""
    return restored(thrusts, efficiency_at(how.known, t))


@elementwise
def beyond(thrust: Number, limit: Number) -> Number:
    """1 where a thrust is outside its limits, else 0."""
    return where(thrust < 0.0, 1.0, where(thrust > limit, 1.0, 0.0))


@law
def wrench(effect: Mixer, thrusts: PerRotor) -> Wrench:
    """The wrench that rotor thrusts [N] make: B u_q with u_i = A f_i."""
    # paper: contro_input_equ
    return Wrench(
        dot(effect.thrust, thrusts),
        Vec3(dot(effect.roll, thrusts), dot(effect.pitch, thrusts), dot(effect.yaw, thrusts)),
    )


def mixer_from(rows: NDArray[Any]) -> Mixer:
    """A 4 × 4N matrix as a Mixer."""
    cls = each(rows.shape[1])
    thrust, roll, pitch, yaw = (cls(*map(float, row)) for row in rows)
    return Mixer(thrust, roll, pitch, yaw)
