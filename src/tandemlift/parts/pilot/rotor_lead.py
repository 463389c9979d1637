"""The lead of a commanded wrench by which lag and delay of the rotors are compensated, in part.

A wrench u passes through the low-pass y of bandwidth ω, and y + T ẏ is commanded: (1 + T s)/(1 + s/ω)². Below ω this
takes T − 2/ω off the lag and the delay of the loop; the price is a gain of up to some T ω/2 for noise near ω. Method:
lead compensation, Åström and Murray, Feedback Systems, chapter on frequency-domain design.

The observer and the detection of rotor failures are given the thrusts that are commanded then, so they know of it.
"""

from __future__ import annotations

from typing import NamedTuple

from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.part import Part
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, vec3
from tandemlift.parts.mechanics.rigid_body import Wrench
from tandemlift.parts.rotors.allocation import AllocationTable


class RotorLead(NamedTuple):
    """The low-pass of the wrench, and the lead times T [s] of thrust and moment."""

    smooth: LowPass
    thrust: Number
    moment: Vec3


class RotorLeadState(NamedTuple):
    """Memory: the low-passes of thrust [N] and moment [N·m]."""

    thrust: LowPassState[Number]
    moment: LowPassState[Vec3]


@law(absent=("u", "memory"))
def lead_step(k: RotorLead, memory: RotorLeadState, u: Wrench) -> tuple[Wrench, RotorLeadState]:
    """(The wrench to be commanded, the new memory) at a sample, for the wrench u that the controller asks for."""
    thrust, moment = low_pass_step(k.smooth, memory.thrust, u.thrust), low_pass_step(k.smooth, memory.moment, u.moment)
    led = Wrench(thrust.value + thrust.rate * k.thrust, moment.value + moment.rate * k.moment)
    return led, RotorLeadState(thrust, moment)


def start_lead(table: AllocationTable, weight: float, step: float, *, hovers: bool) -> tuple[RotorLead, RotorLeadState]:
    """The lead of a vehicle with a weight [N], and its memory; `hovers`: whether the rotors do at the start."""
    at_start = RotorLeadState(LowPassState(weight if hovers else 0.0, 0.0), LowPassState(ZERO, ZERO))
    thrust, *moment = table.lead
    return RotorLead(low_pass(table.lead_bandwidth, step), thrust, vec3(moment)), at_start


LEAD = Part("lead", "pilot", "allocation", "allocation.lead > 0", start_lead)
