"""Passivity of the compliance: an observer of the energy from the person, and damping when it is used up.

A vehicle that responds late can give a stiff arm more energy than it received, so that their oscillation grows. The
tank stores the work of the person's force on the vehicle and a fraction of the energy that the virtual damping
dissipates; the emptier it is, the more damping is added. An oscillation empties it only near its extremes, so the
added damping decays slowly.

Sources: Hannaford and Ryu, Time-domain passivity control of haptic interfaces, 2002;
Ferraguti et al., An energy tank-based interactive control architecture, 2015.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from tandemlift.core.algebra import clip, maximum
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.law import law
from tandemlift.core.part import Part
from tandemlift.core.types import Number, filled
from tandemlift.core.vector import Vec3, dot


class TankTable(Table, acts='compliance.tank.model = "tank"'):
    """`[compliance.tank]`: an energy tank that keeps interactive guidance passive.

    Damping is added where the person has put in too little energy.
    """

    model: Literal["none", "tank"] = key(
        "none", None, "passivity by an energy tank", choices={"none": "no tank", "tank": "an energy tank"}
    )
    capacity: Positive = key(2.0, "J", "largest energy that the tank stores", source="chosen")
    low_energy: Positive = key(1.0, "J", "energy below which damping is added", source="chosen: half of the capacity")
    max_damping: Positive = key(20.0, "N s/m", "largest added damping", source="chosen")
    refill_fraction: NonNegative = key(
        0.5, "1", "fraction of the power dissipated by the virtual damping that fills the tank", source="chosen"
    )
    fade_time: Positive = key(2.0, "s", "time constant with which added damping fades", source="chosen")


class EnergyTank(NamedTuple):
    """The largest energy, and the energy below which damping is added [J]; the largest added damping [N·s/m].

    `refill_fraction`: of the dissipated energy that refills the tank; `decay_rate` [1/s]: of the added damping.
    """

    capacity: Number
    low_energy: Number
    max_damping: Number
    refill_fraction: Number
    decay_rate: Number


class EnergyTankState(NamedTuple):
    """Memory: the energy [J], below zero if more was given than received; the fraction of the damping that is added."""

    energy: Number
    added: Number


@law(absent=(0.0, "m"))
def passivity_damping(
    k: EnergyTank, m: EnergyTankState, push: Vec3, velocity: Vec3, dissipated: Number, dt: Number
) -> tuple[Number, EnergyTankState]:
    """(damping to add [N·s/m], the new memory) under a push [N] at a velocity [m/s]; `dissipated`: by damping [W]."""
    energy = clip(m.energy + (dot(push, velocity) + dissipated * k.refill_fraction) * dt, -k.capacity, k.capacity)
    added = maximum(1.0 - clip(energy / k.low_energy, 0.0, 1.0), m.added * (1.0 - k.decay_rate * dt))
    return k.max_damping * added, EnergyTankState(energy, added)


def start_tank(table: TankTable) -> tuple[EnergyTank, EnergyTankState]:
    """The tank, filled."""
    return filled(EnergyTank, table, decay_rate=1.0 / table.fade_time), EnergyTankState(table.capacity, 0.0)


TANK = Part("tank", "guidance", "compliance.tank", TankTable.acts, start_tank)
