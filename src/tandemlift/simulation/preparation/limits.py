"""The limits of a flight: those that end it early, and those of the detectors, above which it has findings."""

from __future__ import annotations

import math
from typing import Any

from tandemlift.core.algebra import cos, maximum, minimum, where
from tandemlift.core.caching import cached
from tandemlift.core.phases import CRASH_SPEED, FLIES
from tandemlift.core.types import GRAVITY, Number, PerRotor
from tandemlift.core.vector import Absent, Vec3, vec3
from tandemlift.missions.outcomes import CrashTable, FindingsTable, PromiseTable, promise_of
from tandemlift.parts.contact.standing import GroundTable
from tandemlift.parts.guidance.admittance import AdmittanceTable
from tandemlift.parts.guidance.compliance import ComplianceTable
from tandemlift.parts.guidance.supervision import SupervisionTable
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.structure import is_elastic
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import PlantTable
from tandemlift.parts.rotors.rotors import ActuatorsTable
from tandemlift.simulation.loop.detectors import ASLEEP, Detectors, FindingLimits, PushLimits
from tandemlift.simulation.loop.ending import Aftermath, CrashLimits, CrashMemory, OuterFence, Strike
from tandemlift.simulation.loop.oscillation import OscillationLimits, Swings
from tandemlift.simulation.loop.thrust_shake import start_shake


def crash_limits_from(
    crash: CrashTable, supervision: SupervisionTable, nominal: Vehicle, plant: PlantTable, ground: GroundTable
) -> CrashLimits:
    """The limits of a flight; each part that it does not have is `Absent`."""
    fence, watched, mass = supervision.fence, supervision.model == "on", nominal.mass * plant.mass_scale
    max_impulse = mass * CRASH_SPEED if crash.impulse is None else crash.impulse
    return CrashLimits(
        min_upright=cos(crash.tilt) if crash.tilt < 3.14159 else -2.0,
        strike=Strike(mass * GRAVITY, max_impulse) if ground.model != "none" else Absent(),
        fence=OuterFence(vec3(fence.low), vec3(fence.high), crash.fence_margin) if watched else Absent(),
        aftermath=Aftermath(crash.fly_on) if crash.fly_on > 0.0 else Absent(),
    )


def start_crash(limits: CrashLimits, state: State) -> Any:
    """The memory of a crash before the first step; `Absent` for a flight that ends where it crashes."""
    if isinstance(limits.aftermath, Absent):
        return Absent()
    return CrashMemory(FLIES, 0.0, state, Absent() if isinstance(limits.strike, Absent) else 0.0, 0.0)


HEARD_FACTOR = 2.0  # times the threshold, above which a true push should have an effect
LEAST_SHARE, LEAST_FORCE = 0.1, 0.01  # of the smallest threshold, and N: the least force after the gate that counts
UNLIMITED_SPEED = 1e6  # m/s


def finding_limits_from(
    promise: PromiseTable,
    guidance: str,
    findings: FindingsTable,
    nominal: Vehicle,
    actuators: ActuatorsTable,
    admittance: AdmittanceTable,
    compliance: ComplianceTable,
) -> FindingLimits:
    """The limits of the detectors."""
    promised, f, by_hand = promise_of(promise, guidance), findings, guidance == "interactive"
    return FindingLimits(
        settled=promised.settling_time,
        distance=promised.distance * promised.distance,
        sinking=promised.sinking,
        heading=promised.heading,
        upright=cos(promised.tilt),
        mass=nominal.mass,
        thrust=nominal.max_thrust * nominal.max_thrust if actuators.model == "rotors" else math.inf,
        rate=f.oscillation_rate * f.oscillation_rate,
        push=_push_limits(admittance, f, compliance.max_speed, by_hand),
        unpushed=f.unpushed_distance,
        oscillation=OscillationLimits(
            levels=Swings(f.oscillation_rate, f.oscillation_rate, f.oscillation_rate, f.oscillation_speed),
            shortest=0.5 / f.fastest_oscillation,
            longest=0.5 / f.slowest_oscillation,
            halves=2.0 * f.oscillation_periods,
        ),
        shake=(f.structure_thrust * nominal.weight / nominal.rotor_count) ** 2 if is_elastic(nominal) else Absent(),
    )


def start_detectors(actuators: ActuatorsTable, thrusts: PerRotor, *, elastic: bool) -> Detectors:
    """The detectors' memory before the first step, with the rotors' thrusts [N]."""
    watched = ASLEEP._replace(shake=start_shake(thrusts)) if elastic else ASLEEP
    return watched if actuators.model == "rotors" else watched._replace(saturation=Absent(), reach=Absent())


@cached
def _push_limits(
    a: AdmittanceTable, f: FindingsTable, max_speed: tuple[float, float, float], by_hand: bool
) -> PushLimits:
    least = maximum(minimum(minimum(*a.threshold[:2]), a.threshold[2]) * LEAST_SHARE, LEAST_FORCE)
    times = [_over(m, c) for m, c in zip(a.mass, a.damping, strict=True)]
    return PushLimits(
        threshold=Vec3(*a.threshold) * HEARD_FACTOR if by_hand else Absent(),
        least=least * least,
        inverse_damping=Vec3(
            *[where(k > 0.0, 0.0, _over(1.0, c)) for k, c in zip(a.stiffness, a.damping, strict=True)]
        ),
        speed=Vec3(*max_speed) if by_hand else Vec3(UNLIMITED_SPEED, UNLIMITED_SPEED, UNLIMITED_SPEED),
        time=f.push_time + maximum(maximum(times[0], times[1]), times[2]),
        response=f.push_response,
    )


def _over(a: Number, b: Number) -> Number:
    """a/b, and 0 for b = 0: an axis without damping ends with no speed."""
    return where(b > 0.0, a / maximum(b, 1e-9), 0.0)
