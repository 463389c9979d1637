"""An observer of one's own as a law, compiled and flown: a low-pass of m (a + g e_z) − R e_z f.

    tandemlift benchmark examples/observers/own_law.py --quick
    tandemlift run iris --plugin examples/observers/own_law.py --set estimator.wrench=low-pass

`start` returns parameters and memory, by whose types `observe` picks the law. A law chooses by
`where`, never by `if`; docs/reference/controllers.md has the rules. The force is in world axes, the
moment in body axes; the pilot takes the tare away.
"""

from typing import NamedTuple

from tandemlift.core.plugs import plug
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.estimation.wrench.observation import (
    ExternalWrench,
    NominalBody,
    Observation,
    observe,
    unexplained_force,
)


class Filter(NamedTuple):
    """The vehicle, and the part of each sample that is new."""

    body: NominalBody
    share: float


class Memory(NamedTuple):
    """The force so far [N, world axes]."""

    force: Vec3


@observe.register(Filter)
def low_pass(k: Filter, m: Memory, x: Observation) -> tuple[ExternalWrench, Memory]:
    """The force [N], without a moment."""
    force = m.force + (unexplained_force(k.body, x) - m.force) * k.share
    return ExternalWrench(force, ZERO), Memory(force)


@plug("observer", "low-pass")
def start(table, body, noise, interval):
    """A low-pass of 12 rad/s, whatever the noise."""
    return Filter(body, 12.0 * interval), Memory(ZERO)
