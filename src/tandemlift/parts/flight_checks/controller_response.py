"""The linear response of any registered controller about hover, by finite differences of its law.

Each component of the controller's input is changed separately, because products of inertia couple the axes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.core.caching import cached
from tandemlift.core.trajectories import Reference, Trajectory
from tandemlift.core.types import Array, flat, unflat
from tandemlift.core.vector import ZERO, vec3
from tandemlift.parts.controllers import CONTROLLERS, control
from tandemlift.parts.controllers.interface import NO_DISTURBANCE, ControllerTable, Measured
from tandemlift.parts.mechanics.rigid_body import InitialTable, State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle

INPUTS = 5  # position, velocity, angles, rates, push: vectors
CHANGE = 1e-6  # of an input or a memory, in its unit
STILL = Reference(Trajectory(ZERO, ZERO, ZERO), 0.0)


class ControllerResponse(NamedTuple):
    """A controller about hover, m₊ = A m + B y, u = C m + D y, for samples every step.

    Attributes:
        A: (n, n), of its memory.
        B: (n, 15), by x, y, z of position [m], velocity [m/s], angles [rad], rates [rad/s] and push [N].
        C: (4, n): thrust [N], roll, pitch, yaw [N m].
        D: (4, 15).
    """

    A: Array
    B: Array
    C: Array
    D: Array

    def at(self, z: NDArray[np.complex128]) -> NDArray[np.complex128] | Array:
        """The response (w, 4, 5, 3) at points z (w,) of the discrete plane."""
        found = np.broadcast_to(self.D, (len(z), *self.D.shape))
        if len(self.A):
            many = np.broadcast_to(self.B, (len(z), *self.B.shape))
            found = found + self.C @ np.linalg.solve(z[:, None, None] * np.eye(len(self.A)) - self.A, many)
        return found.reshape(len(z), 4, INPUTS, 3)


def controller_response(controller: ControllerTable, vehicle: Vehicle, step: float) -> ControllerResponse | None:
    """The response of a controller, sampled every step [s]; None if its law does not return numbers at hover."""
    return _response(controller, CONTROLLERS[controller.name].start, vehicle, step)


def first_command(controller: ControllerTable, vehicle: Vehicle, step: float, start: InitialTable) -> Array:
    """Thrust [N] and moments [N m] (4) that a controller commands at a start, with the reference at rest at 0."""
    gains, memory = CONTROLLERS[controller.name].start(controller, vehicle, step)
    motion = np.concatenate([start.position, start.velocity, start.euler, start.rates, np.zeros(3)])
    return _answer(gains, memory, motion, np.array(flat(memory), dtype=float))[:4]


@cached
def _response(
    settings: ControllerTable, start: Callable[..., Any], vehicle: Vehicle, step: float
) -> ControllerResponse | None:
    try:
        gains, memory = start(settings, vehicle, step)
        here = np.array(flat(memory), dtype=float)
        read = 3 * INPUTS
        rows = [_answer(gains, memory, np.zeros(read), here)]
        for change in CHANGE * np.eye(read + len(here)):
            rows.append((_answer(gains, memory, change[:read], here + change[read:]) - rows[0]) / CHANGE)
    except (ArithmeticError, TypeError, ValueError, AttributeError):
        return None  # a law in plain Python may keep anything in its memory
    J = np.array(rows[1:]).T
    if not np.isfinite(J).all():
        return None
    return ControllerResponse(J[4:, read:], J[4:, :read], J[:4, read:], J[:4, :read])


def _answer(gains: object, memory: object, y: Array, numbers: Array) -> Array:
    """(Thrust, moments, memory after) for a small motion and push."""
    position, velocity, angles, rates, push = map(vec3, y.reshape(INPUTS, 3).tolist())
    state = State(position, velocity, quaternion_from_euler(angles), rates)
    measured = Measured(state, push, NO_DISTURBANCE)
    command, after = control(gains, unflat(numbers.tolist(), memory), measured, STILL)
    return np.array([command.wrench.thrust, *command.wrench.moment, *flat(after)], dtype=float)
