"""Passivity of the compliance: an observer of the energy that a person puts in, and damping where it runs out.

A vehicle that responds late can give a stiff arm more energy than it received, so that their oscillation grows. The
tank holds the work of the person's force on the vehicle and a fraction of the energy that the virtual damping
dissipates; the emptier it is, the more damping is added. An oscillation empties it only near its turning points, so the
added damping decays slowly.

Sources: Hannaford and Ryu, Time-domain passivity control of haptic interfaces, 2002;
Ferraguti et al., An energy tank-based interactive control architecture, 2015.
"""

from typing import Any, NamedTuple

from tandemlift.core.algebra.law import choice
from tandemlift.core.algebra.ops import clip, maximum
from tandemlift.core.algebra.vector import dot


class EnergyTank(NamedTuple):
    """The largest energy, and the energy below which damping is added [J]; the largest added damping [N·s/m].

    `refill_fraction`: of the dissipated energy that refills the tank; `decay_rate` [1/s]: of the added damping.
    """

    capacity: Any
    low_energy: Any
    max_damping: Any
    refill_fraction: Any
    decay_rate: Any


class EnergyTankState(NamedTuple):
    """Memory: the energy [J], below zero if more was given than received; the fraction of the damping that is added."""

    energy: Any
    added: Any


@choice(absent=(0.0, "m"))
def passivity_damping(k: Any, m: Any, push: Any, velocity: Any, dissipated: Any, dt: Any) -> Any:
    """(damping to add [N·s/m], the new memory) under a push [N] at a velocity [m/s]; `dissipated`: by damping [W]."""


@passivity_damping.register(EnergyTank)
def _tank(k: EnergyTank, m: EnergyTankState, push: Any, velocity: Any, dissipated: Any, dt: Any) -> Any:
    energy = clip(m.energy + (dot(push, velocity) + dissipated * k.refill_fraction) * dt, -k.capacity, k.capacity)
    added = maximum(1.0 - clip(energy / k.low_energy, 0.0, 1.0), m.added * (1.0 - k.decay_rate * dt))
    return k.max_damping * added, EnergyTankState(energy, added)
