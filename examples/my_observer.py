"""An observer of the external wrench: a low-pass of the force that the thrust does not explain."""

from typing import NamedTuple

import tandemlift as tl
from tandemlift.core.algebra import ZERO, Vec3
from tandemlift.parts.estimation.wrench.observation import (
    ExternalWrench,
    NominalBody,
    observe,
    unexplained_force,
)


class LowPass(NamedTuple):
    """The nominal vehicle, and the part of each sample that is new; its type selects the law."""

    body: NominalBody
    share: float


class Memory(NamedTuple):
    """The force so far [N, world axes]."""

    force: Vec3


@observe.register(LowPass)
def low_pass(k, memory, sample):
    """The external force [N, world axes], no moment, and the next memory."""
    force = memory.force + (unexplained_force(k.body, sample) - memory.force) * k.share
    return ExternalWrench(force, ZERO), Memory(force)


@tl.plug("observer", "slow")
def start(table, body, noise, interval):
    """A low-pass of 12 rad/s. `table`: [estimator.wrench_observer]; `interval` of samples [s]."""
    return LowPass(body, 12.0 * interval), Memory(ZERO)
