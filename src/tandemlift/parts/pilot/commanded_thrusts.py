"""The thrusts of a pilot as a function of a state off hover, and where its laws bend: for bounds of the thrusts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.trajectories import Reference, Trajectory
from tandemlift.core.types import Array
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.controllers import control
from tandemlift.parts.controllers.interface import Measured
from tandemlift.parts.controllers.nftsmc import NFTSMC
from tandemlift.parts.controllers.sliding_surface import Saturation, Tanh, reaching_control, sliding_surface
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler, rotated_by
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import VehicleTable
from tandemlift.parts.pilot.pilot import PilotMemory, PilotParameters
from tandemlift.parts.rotors.allocation import allocate
from tandemlift.parts.rotors.rotors import hover_thrusts

HOVER_REFERENCE = Reference(Trajectory(ZERO, ZERO, ZERO), 0.0)
SURFACE, REACHING = sliding_surface, reaching_control  # the law of S, and the law of S that switches


class RotorAxes(NamedTuple):
    """Thrusts of rotors by axis: thrust, roll, pitch, yaw, each in units of 1 N of each rotor.

    Attributes:
        effect: (4, n) the axes' values that thrusts [N] make.
        inverse: (n, 4) the thrusts [N] that the allocation takes for them.
        room: (n) excursion from hover that the rotors' limits leave up and down [N]; not above 0 at a limit.
        hover: (n) thrusts of hover [N].
        most: (n) largest thrusts [N].
    """

    effect: Array
    inverse: Array
    room: Array
    hover: Array
    most: Array


def rotor_axes(table: VehicleTable, weights: tuple[tuple[float, ...], ...]) -> RotorAxes:
    """The axes of a vehicle's rotors; `weights`: of the allocation."""
    vehicle = Vehicle.from_settings(table)
    rms = np.sqrt(np.mean(np.square(vehicle.effect), axis=1))
    hover = np.array(hover_thrusts(vehicle, weights))
    most = np.array([q.thrust_limit for q in vehicle.quadrotors for _ in range(4)])
    room = np.minimum(hover, most - hover)
    return RotorAxes(vehicle.effect / rms[:, None], vehicle.allocation(weights) * rms, room, hover, most)


def switching_slopes(pilot: PilotParameters) -> Array | None:
    """λ₂/Φ (6), the slope at 0 of NFTSMC's switching; None for another controller, and for `sign`, which has none."""
    k, found = pilot.controller, list[float]()
    if not isinstance(k, NFTSMC):
        return None
    for surface in (k.position, k.attitude):
        if not isinstance(surface.switching, (Saturation, Tanh)):
            return None
        found += surface.lambda_2 * surface.switching.per_width
    return np.array(found)


def commanded_thrusts(pilot: PilotParameters, memory: PilotMemory) -> Callable[[Sequence[Any]], list[Any]]:
    """The thrusts [N] that controller and allocation command, whatever the limits, as a function of 12 numbers.

    These are position [m] and velocity [m/s], Z-X-Y angles [rad] and rates [rad/s] off a hover at rest.

    Raises:
        InputError: the controller is plain Python.
    """
    gains, before = pilot.controller, memory.controller
    if type(gains) in control.interpreted:
        raise InputError(f"controller {type(gains).__name__} is plain Python, which has no intervals")

    def thrusts(x: Sequence[Any]) -> list[Any]:
        state = State(Vec3(*x[0:3]), Vec3(*x[3:6]), quaternion_from_euler(Vec3(*x[6:9])), Vec3(*x[9:12]))
        command, _ = control(gains, before, Measured(state, ZERO), HOVER_REFERENCE)
        return list(allocate(pilot.allocation, command.wrench))

    return thrusts


def disturb(state: Array, offset: Mapping[str, float]) -> None:
    """Add an offset to a body's 13 numbers: "velocity.x" [m/s], "rates.y" [rad/s], "attitude.z" (a turn [rad]), …"""
    velocity, rates, turn = ([offset.get(f"{what}.{axis}", 0.0) for axis in "xyz"] for what in OFFSETS)
    state[3:6] += velocity
    state[6:10] = rotated_by(Quat(*state[6:10].tolist()), Vec3(*turn))
    state[10:13] += rates


OFFSETS = ("velocity", "rates", "attitude")
