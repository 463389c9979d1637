"""What a controller is given and what it answers."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.law import choice
from tandemlift.laws.admittance import Trajectory
from tandemlift.laws.body import State, Wrench
from tandemlift.vector import Vec3


class Measured(NamedTuple):
    """What the pilot knows at a sample: the state, and the force of the person [N, world axes]."""

    state: State
    push: Vec3


class Reference(NamedTuple):
    """What is to be tracked: the centre of mass's trajectory in world axes, and the yaw ψ_d [rad]."""

    trajectory: Trajectory
    yaw: Any


class Command(NamedTuple):
    """The wanted wrench (U₁, U₂…U₄), and the Euler angles [rad] that the attitude law tracks."""

    wrench: Wrench
    euler: Vec3


class NoMemory(NamedTuple):
    """Of a controller without memory."""


@choice
def control(gains: Any, memory: Any, measured: Any, reference: Any) -> Any:
    """One sample of the controller with this type of gains: (Command, the new memory)."""
