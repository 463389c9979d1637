"""Passivity of the compliance: an observer of the energy that a person puts in, and damping where it runs out.

A vehicle that yields late can hand a stiff arm more energy than it got, and the two then swing each other up. The tank
holds what the person's force did to the vehicle and a share of what the virtual damping burned; the emptier it gets,
the more damping is added. A swing empties it only where it turns round, so the damping stays for a while.

Sources: Hannaford and Ryu, Time-domain passivity control of haptic interfaces, 2002;
Ferraguti et al., An energy tank-based interactive control architecture, 2015.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice
from tandemlift.algebra.ops import clip, maximum
from tandemlift.algebra.vector import dot


class EnergyTank(NamedTuple):
    """Energy that it holds, and below which damping is added [J]; the most damping [N·s/m]; the share that refills.

    `fading`: one over the time that damping stays [1/s].
    """

    capacity: Any
    low_energy: Any
    most: Any
    refill_fraction: Any
    fading: Any


class EnergyTankState(NamedTuple):
    """Memory: the energy in it [J], which may be owed; the share of the damping that is added."""

    energy: Any
    added: Any


@choice(absent=(0.0, "m"))
def passivity_damping(k: Any, m: Any, push: Any, velocity: Any, burned: Any, dt: Any) -> Any:
    """(damping to add [N·s/m], the new memory): a push [N] at a velocity [m/s], and power burned by damping [W]."""


@passivity_damping.register(EnergyTank)
def _tank(k, m, push, velocity, burned, dt):
    energy = clip(m.energy + (dot(push, velocity) + burned * k.refill_fraction) * dt, -k.capacity, k.capacity)
    added = maximum(1.0 - clip(energy / k.low_energy, 0.0, 1.0), m.added * (1.0 - k.fading * dt))
    return k.most * added, EnergyTankState(energy, added)
