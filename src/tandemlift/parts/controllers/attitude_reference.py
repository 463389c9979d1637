"""The attitude reference: the desired orientation as it is, or shaped by a command filter that gives its derivatives.

Differences of a desired orientation are too rough to be used as its derivatives. The command filter is critically
damped, ẍ = ω_f²(Θ_d − x) − 2ω_f ẋ (Farrell and Polycarpou, Adaptive Approximation Based Control, 2006); the attitude
law tracks its output, whose derivatives are exact.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.law import choice, law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.trajectories import Reference
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.controllers.interface import NoMemory


class Unfiltered(NamedTuple):
    """The attitude law tracks the desired orientation with derivatives taken as zero."""


class CommandFilter(NamedTuple):
    """Critically damped second-order filter ẍ = ω_f²(Θ_d − x) − 2ω_f ẋ, exact for Θ_d held over a step.

    `bandwidth` ω_f [rad/s]; `transition` of (x − Θ_d, ẋ) over one step, which is that of a low-pass.
    """

    bandwidth: Number
    transition: LowPass


class SmoothCommandFilter(NamedTuple):
    """A command filter behind a low-pass, so that the accelerations of the reference do not contain raw noise."""

    smooth: LowPass
    filter: CommandFilter


class CommandFilterState(NamedTuple):
    """Memory of the command filter: angles [rad] and rates [rad/s]."""

    angles: Vec3
    rates: Vec3


class SmoothCommandFilterState(NamedTuple):
    """Memory of the low-pass [rad] and of the command filter."""

    smooth: LowPassState[Vec3]
    filter: CommandFilterState


class AttitudeReference(NamedTuple):
    """The reference of the attitude law: angles [rad], rates [rad/s], accelerations [rad/s²] of φ, θ, ψ."""

    angles: Vec3
    rates: Vec3
    accelerations: Vec3


@choice
def shape_reference(
    kind: Unfiltered | CommandFilter | SmoothCommandFilter,
    memory: NoMemory | CommandFilterState | SmoothCommandFilterState,
    desired: Vec3,
) -> tuple[AttitudeReference, NoMemory | CommandFilterState | SmoothCommandFilterState]:
    """(the attitude law's reference, the new memory), from the desired orientation [rad]."""


@shape_reference.register(Unfiltered)
def _unfiltered(kind: Unfiltered, memory: NoMemory, desired: Vec3) -> tuple[AttitudeReference, NoMemory]:
    return AttitudeReference(desired, ZERO, ZERO), memory


@shape_reference.register(CommandFilter)
def _filtered(
    kind: CommandFilter, memory: CommandFilterState, desired: Vec3
) -> tuple[AttitudeReference, CommandFilterState]:
    x, step = memory.angles - desired, kind.transition
    acceleration = -(x * (kind.bandwidth * kind.bandwidth) + memory.rates * (2.0 * kind.bandwidth))
    after = CommandFilterState(
        desired + x * step.value_from_value + memory.rates * step.value_from_rate,
        x * step.rate_from_value + memory.rates * step.rate_from_rate,
    )
    return AttitudeReference(memory.angles, memory.rates, acceleration), after


@shape_reference.register(SmoothCommandFilter)
def _smooth(
    kind: SmoothCommandFilter, memory: SmoothCommandFilterState, desired: Vec3
) -> tuple[AttitudeReference, SmoothCommandFilterState]:
    smooth = low_pass_step(kind.smooth, memory.smooth, desired)
    reference, after = shape_reference(kind.filter, memory.filter, smooth.value)
    return reference, SmoothCommandFilterState(smooth, after)


@law
def with_heading(tracked: AttitudeReference, reference: Reference) -> AttitudeReference:
    """The attitude law's reference with the yaw and its derivatives replaced by those of the trajectory."""
    a, r, c = tracked.angles, tracked.rates, tracked.accelerations
    return AttitudeReference(
        Vec3(a.x, a.y, reference.yaw), Vec3(r.x, r.y, reference.yaw_rate), Vec3(c.x, c.y, reference.yaw_acceleration)
    )


def command_filter(bandwidth: float, step: float) -> CommandFilter:
    """The command filter of bandwidth ω_f [rad/s], sampled every `step` [s]."""
    return CommandFilter(bandwidth, low_pass(bandwidth, step))
