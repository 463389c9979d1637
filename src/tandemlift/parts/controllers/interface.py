"""Inputs and outputs of a controller."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, TypeVar

from tandemlift.core.errors import CheckResult
from tandemlift.core.keys import Table, key
from tandemlift.core.law import choice
from tandemlift.core.trajectories import Reference
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.mechanics.rigid_body import State, Wrench


class ControllerTable(Table):
    """`[controller]`: the controller and its settings; each controller adds its own keys."""

    name: str = key(..., None, "name of the controller, one of `tandemlift controllers`", example="nftsmc")

    def checks(self, step: float) -> Iterator[CheckResult]:
        """Warnings of keys that are expected to fly badly with a step [s]; a controller may override it."""
        yield from ()


def tilt_limit_of(table: ControllerTable) -> float | None:
    """The largest tilt that a controller commands [rad]; None without a limit."""
    return getattr(table, "max_tilt", None)


class Disturbance(NamedTuple):
    """The loads that a controller compensates besides a person's force.

    The force that the pilot's observer estimates [N, world axes], and the moment [N·m, body axes] that it and the
    person exert about the centre of mass.
    """

    force: Vec3
    moment: Vec3


NO_DISTURBANCE = Disturbance(ZERO, ZERO)


class Measured(NamedTuple):
    """The pilot's inputs at a sample: the state, the force of the person [N, world axes], and the disturbance."""

    state: State
    push: Vec3
    disturbance: Disturbance = NO_DISTURBANCE


class Command(NamedTuple):
    """The desired wrench (U₁, U₂…U₄), and the Euler angles [rad] that the attitude law tracks."""

    wrench: Wrench
    euler: Vec3


class NoMemory(NamedTuple):
    """The memory of a controller without memory."""


M = TypeVar("M")


@choice
def control(gains: object, memory: M, measured: Measured, reference: Reference) -> tuple[Command, M]:
    """One sample of the controller with this type of gains: (Command, the new memory)."""
