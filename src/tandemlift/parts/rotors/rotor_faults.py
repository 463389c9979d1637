"""Faults of rotors: from some time on, a rotor gives a fraction of its thrust, or none."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated, NamedTuple

from pydantic import Field

from tandemlift.core.algebra import minimum, where
from tandemlift.core.errors import CheckResult, refused, warned
from tandemlift.core.keys import NonNegative, Share, Table, key
from tandemlift.core.law import elementwise, law
from tandemlift.core.types import NEVER, Number, PerRotor
from tandemlift.core.vector import Absent, each
from tandemlift.parts.mechanics.vehicle import Vehicle


class FaultTable(Table):
    """`[[faults]]`: rotors that lose thrust, one table each, a rotor once; they need `actuators.model = "rotors"`."""

    quadrotor: Annotated[int, Field(ge=1, le=64)] = key(
        ..., "1", "number of the quadrotor, from 1", rule="at most the number of quadrotors", example=1
    )
    rotor: Annotated[int, Field(ge=1, le=4)] = key(
        ..., "1", "number of the rotor, in the order of layout or rotor_positions", example=1
    )
    time: NonNegative = key(..., "s", "start of the fault", example=15.0)
    efficiency: Share = key(0.0, "1", "fraction of the rotor's thrust that is left")
    known_after: NonNegative | None = key(
        None, "s", "delay until the 'constrained' allocation uses it", unset="never", example=0.05
    )


class RotorFaults(NamedTuple):
    """From `time` [s] on, the fraction of its thrust that each rotor has left; sets."""

    time: PerRotor
    efficiency: PerRotor


@elementwise
def efficiency_after(time: Number, efficiency: Number, t: Number) -> Number:
    """The efficiency at time t [s] of a rotor that fails at a time [s]."""
    return where(t >= time, efficiency, 1.0)


@law(absent=1.0)
def efficiency_at(faults: RotorFaults, t: Number) -> PerRotor:
    """The fraction of its thrust that each rotor has at time t [s]."""
    return efficiency_after(faults.time, faults.efficiency, t)


def rotor_faults(count: int, failures: Iterable[tuple[int, int, float, float]]) -> RotorFaults | Absent:
    """The faults of `count` rotors, from (quadrotor, rotor, time [s], fraction of the thrust left), numbers from 1."""
    failures = tuple(failures)
    if not failures:
        return Absent()
    times, efficiency = [NEVER] * count, [1.0] * count
    for quadrotor, rotor, time, fraction in failures:
        i = 4 * (quadrotor - 1) + rotor - 1
        times[i], efficiency[i] = time, fraction
    cls = each(count)
    return RotorFaults(cls(*times), cls(*efficiency))


def real_faults(tables: Sequence[FaultTable], vehicle: Vehicle) -> RotorFaults | Absent:
    """The rotor faults as they happen."""
    return rotor_faults(vehicle.rotor_count, [(f.quadrotor, f.rotor, f.time, f.efficiency) for f in tables])


def known_faults(tables: Sequence[FaultTable], vehicle: Vehicle) -> RotorFaults | Absent:
    """The rotor faults known to the pilot, each from the time at which it becomes known."""
    known = [math.inf if f.known_after is None else f.time + f.known_after for f in tables]
    failures = [(f.quadrotor, f.rotor, minimum(t, NEVER), f.efficiency) for f, t in zip(tables, known, strict=True)]
    return rotor_faults(vehicle.rotor_count, failures)


def fault_checks(tables: Sequence[FaultTable], quadrotors: int, rotors: str) -> Iterator[CheckResult]:
    """Check for faults of rotors that do not exist, or that fail twice; `rotors`: `actuators.model`."""
    seen = dict[tuple[int, int], int]()
    for i, f in enumerate(tables):
        if f.quadrotor > quadrotors:
            limit = f"must be from 1 to {quadrotors}, as many as there are"
            yield refused(f"faults.{i}.quadrotor = {f.quadrotor}: {limit}")
        first = seen.setdefault((f.quadrotor, f.rotor), i)
        if first != i:
            where = f"rotor {f.rotor} of quadrotor {f.quadrotor}"
            yield refused(f"faults.{i}.rotor = {f.rotor}: {where} must fail once, and does so in faults.{first}")
    if tables and rotors != "rotors":
        yield refused('actuators.model = "ideal": must be "rotors" where there are faults, or nothing can fail')


def fault_warnings(tables: Sequence[FaultTable], weight: float, lift: float, method: str) -> Iterator[CheckResult]:
    """Check for faults that leave too little `lift` [N] for the weight [N]; `method`: `allocation.method`."""
    if weight > lift:
        yield warned(f"with all faults, the vehicle weighs {weight:.4g} N and its rotors lift {lift:.4g} N")
    known = [i for i, f in enumerate(tables) if f.known_after is not None]
    if known and method != "constrained":
        yield warned(f'faults.{known[0]}.known_after has an effect only if allocation.method is "constrained"')
