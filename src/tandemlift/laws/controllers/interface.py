"""What a controller is given and what it answers."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.law import choice
from tandemlift.laws.admittance import Trajectory
from tandemlift.laws.body import State, Wrench
from tandemlift.vector import ZERO, Vec3


class Disturbance(NamedTuple):
    """What a controller is to counter besides a person's force.

    The force that the pilot's observer finds [N, world axes], and the moment [N·m, body axes] that it and the person
    exert about the centre of mass.
    """

    force: Vec3
    moment: Vec3


CALM = Disturbance(ZERO, ZERO)


class Measured(NamedTuple):
    """What the pilot knows at a sample: the state, the force of the person [N, world axes], and the disturbance."""

    state: State
    push: Vec3
    disturbance: Disturbance = CALM


class Reference(NamedTuple):
    """What is to be tracked.

    The centre of mass's trajectory in world axes; the yaw ψ_d [rad], its rate [rad/s] and acceleration [rad/s²]; and by
    how much the trajectory's acceleration will have changed [m/s²] when the vehicle answers, zero if that is not known.
    """

    trajectory: Trajectory
    yaw: Any
    yaw_rate: Any = 0.0
    yaw_acceleration: Any = 0.0
    lead: Vec3 = ZERO


class Command(NamedTuple):
    """The wanted wrench (U₁, U₂…U₄), and the Euler angles [rad] that the attitude law tracks."""

    wrench: Wrench
    euler: Vec3


class NoMemory(NamedTuple):
    """Of a controller without memory."""


@choice
def control(gains: Any, memory: Any, measured: Any, reference: Any) -> Any:
    """One sample of the controller with this type of gains: (Command, the new memory)."""
