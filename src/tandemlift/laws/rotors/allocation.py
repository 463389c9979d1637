"""From a wrench to rotor thrusts and back: the constant matrices of a vehicle, row by row, as sets of rotors."""

from typing import Any, NamedTuple

from numpy.typing import NDArray

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import maximum, where
from tandemlift.algebra.vector import Vec3, dot, each
from tandemlift.laws.mechanics.body import Wrench
from tandemlift.laws.rotors.dynamics import efficiency_at


class Mixer(NamedTuple):
    """A 4 × 4N matrix by rows, each a set of 4N rotor values: of thrust, roll, pitch and yaw."""

    thrust: Any
    roll: Any
    pitch: Any
    yaw: Any


class ConstrainedAllocation(NamedTuple):
    """Allocation within limits: the pseudo-inverse, and what `laws.rotors.thrust_limits` needs where it leaves them.

    `rows` and `weights` of the weighted problem, `limits` [N] of all rotors, and the faults that the pilot `known`s.
    """

    inverse: Mixer
    rows: Mixer
    weights: Wrench
    limits: Any
    known: Any


class AllocationState(NamedTuple):
    """Memory: which rotors are held at a limit (−1 at 0, 1 at the most, 0 free), and the thrusts [N]; sets."""

    active: Any
    thrusts: Any


@choice
def allocate(how: Any, u: Wrench) -> Any:
    """Thrust of every rotor [N] for a wrench, whatever the rotors' limits."""


@allocate.register(Mixer)
def _pseudo_inverse(inverse, u):
    # u_q* and each quadrotor's mixer inverse, as one matrix (transposed)
    # paper: optim_cont_final_equ
    return inverse.thrust * u.thrust + inverse.roll * u.moment.x + inverse.pitch * u.moment.y + inverse.yaw * u.moment.z


@allocate.register(ConstrainedAllocation)
def _unlimited(how, u):
    return allocate(how.inverse, u)


@law
def limits_at(how: ConstrainedAllocation, left: Any, t: Any) -> Any:
    """The most that every rotor gives at time t [s], as far as the pilot knows [N]; `left`: see `detection.left_of`."""
    return how.limits * efficiency_at(how.known, t) * left


@elementwise
def restored(thrust, efficiency):
    """The command that makes a weakened rotor give a thrust; none to one that is lost."""
    return where(efficiency > 0.0, thrust / maximum(efficiency, 1e-9), 0.0)


@law
def commanded(how: ConstrainedAllocation, thrusts: Any, t: Any) -> Any:
    """Commands [N] that make the rotors give these thrusts at time t [s], as far as the pilot knows."""
    return restored(thrusts, efficiency_at(how.known, t))


@elementwise
def beyond(thrust, limit):
    """1 where a thrust is outside its limits, else 0."""
    return where(thrust < 0.0, 1.0, where(thrust > limit, 1.0, 0.0))


@law
def wrench(effect: Mixer, thrusts: Any) -> Wrench:
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
