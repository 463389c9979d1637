"""From a wrench to rotor thrusts and back: the constant matrices of a vehicle, row by row, as sets of rotors."""

from typing import Any, NamedTuple

from tandemlift.law import law
from tandemlift.laws.body import Wrench
from tandemlift.vector import Vec3, dot


class Mixer(NamedTuple):
    """A 4 × 4N matrix by rows, each a set of 4N rotor values: of thrust, roll, pitch and yaw."""

    thrust: Any
    roll: Any
    pitch: Any
    yaw: Any


@law
def allocate(inverse: Mixer, u: Wrench) -> Any:
    """Thrust of every rotor [N] for a wrench: u_q* and each quadrotor's mixer inverse, as one matrix (transposed)."""
    # paper: optim_cont_final_equ
    return inverse.thrust * u.thrust + inverse.roll * u.moment.x + inverse.pitch * u.moment.y + inverse.yaw * u.moment.z


@law
def wrench(effect: Mixer, thrusts: Any) -> Wrench:
    """The wrench that rotor thrusts [N] make: B u_q with u_i = A f_i."""
    # paper: contro_input_equ
    return Wrench(
        dot(effect.thrust, thrusts),
        Vec3(dot(effect.roll, thrusts), dot(effect.pitch, thrusts), dot(effect.yaw, thrusts)),
    )
