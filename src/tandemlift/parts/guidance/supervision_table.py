"""Supervision, `[supervision]`: its keys and its start."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from pydantic import create_model

from tandemlift.core.algebra import cos
from tandemlift.core.errors import CheckResult, refused, shown
from tandemlift.core.faults import FAULTS, REACTION_MEANINGS, REACTIONS, Fault, Reaction
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.vector import Absent, set_of, vec3
from tandemlift.parts.guidance.fault_detection import (
    NO_TIME,
    ActiveFaults,
    Fence,
    FenceTable,
    LimitsTable,
    SupervisionLimits,
)
from tandemlift.parts.guidance.preflight_checks import ChecksTable, PreflightChecks
from tandemlift.parts.guidance.supervision import SLOTS, EventLog, Supervision, SupervisionState
from tandemlift.parts.mechanics.rigid_body import InitialTable, State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import thrust_limits
from tandemlift.parts.rotors.rotor_faults import RotorFaults
from tandemlift.parts.sensors.watchdog import WatchTable


def _reaction(fault: Fault) -> Any:
    """The key of a fault in `[supervision.reactions]`."""
    return key(fault.reaction, None, f"reaction when {fault.condition}", choices=REACTION_MEANINGS)


_REACTION_KEYS: dict[str, Any] = {fault.key: (Reaction, _reaction(fault)) for fault in FAULTS}


class ReactionsTable(create_model("Reactions", __base__=Table, **_REACTION_KEYS)):  # type: ignore[misc]
    """`[supervision.reactions]`: the reaction to each fault, in the order of their priority."""


class SupervisionTable(Table, acts='supervision.model = "on"'):
    """`[supervision]`: checks, watchdogs, limits and reactions in flight; see docs/explanation/safety.md."""

    model: Literal["none", "on"] = key(
        "none",
        None,
        "model of the supervision",
        choices={"none": "no supervision", "on": 'all of it (needs `pilot.guidance = "interactive"`)'},
    )
    hold_timeout: Positive = key(
        5.0, "s", "time for which a fault may hold the vehicle before it lands", source="chosen"
    )
    recovery_time: Positive = key(1.0, "s", "time without a fault after which a hold ends", source="chosen")
    blind_descent_depth: NonNegative = key(
        0.5, "m", "distance below the ground at which a landing with unknown height ends", source="chosen"
    )
    touchdown_gap: Positive = key(
        0.12,
        "m",
        "height above a landing's reference at which the vehicle must be standing on something",
        source="chosen",
    )
    blind_descent_acceleration: NonNegative = key(
        0.2, "m/s²", "downward acceleration of a landing with unknown motion", source="chosen"
    )
    checks: ChecksTable = ChecksTable()
    watchdog: WatchTable = WatchTable()
    fence: FenceTable = FenceTable()
    limits: LimitsTable = LimitsTable()
    reactions: ReactionsTable = ReactionsTable()


def _checks(c: ChecksTable, vehicle: Vehicle) -> PreflightChecks:
    payload = vehicle.payload.mass
    return PreflightChecks(
        thrust_fraction=c.thrust_fraction,
        min_upright=cos(c.tilt),
        speed=c.speed,
        rates=c.rates,
        min_payload=payload * c.min_payload_ratio,
        max_payload=payload * c.max_payload_ratio,
    )


def _limits(table: SupervisionTable) -> SupervisionLimits:
    b, w = table.limits, table.watchdog
    return SupervisionLimits(
        thrust=b.thrust_fraction,
        min_upright=cos(b.tilt),
        rates=b.rates,
        tracking_error=b.tracking_error,
        thrust_time=b.thrust_time,
        tilt_time=b.tilt_time,
        rates_time=b.rates_time,
        tracking_error_time=b.tracking_error_time,
        joints_time=w.joints_time,
        invalid_state_time=w.invalid_time,
        touchdown_gap=table.touchdown_gap,
    )


def start_supervision(
    table: SupervisionTable, vehicle: Vehicle, initial: InitialTable, known: RotorFaults | Absent
) -> tuple[Supervision, SupervisionState] | tuple[Absent, Absent]:
    """The supervision before its first sample, and its memory; or `Absent`.

    Args:
        table: `[supervision]`.
        vehicle: the nominal one.
        initial: the state at the start.
        known: the known rotor faults.
    """
    if table.model == "none":
        return Absent(), Absent()
    supervision = Supervision(
        mass=vehicle.mass,
        payload=vehicle.payload.mass,
        limits=thrust_limits(vehicle),
        known=known,
        checks=_checks(table.checks, vehicle),
        fence=Fence(vec3(table.fence.low), vec3(table.fence.high), table.fence.margin, table.fence.braking_gain),
        bounds=_limits(table),
        reactions=ActiveFaults(**{name: float(REACTIONS.index(r)) for name, r in table.reactions}),
        hold_timeout=table.hold_timeout,
        recovery_time=table.recovery_time,
        blind_descent_depth=table.blind_descent_depth,
        blind_descent_acceleration=table.blind_descent_acceleration,
        slots=set_of([float(slot) for slot in range(SLOTS)]),
    )
    at, empty = vec3(initial.position), set_of([0.0] * SLOTS)
    state = State(at, vec3(initial.velocity), quaternion_from_euler(vec3(initial.euler)), vec3(initial.rates))
    return supervision, SupervisionState(
        reaction=0.0,
        alarm=0.0,
        hold_time=0.0,
        fault_free_time=0.0,
        timers=NO_TIME,
        state=state,
        reference=at,
        failed_lift_check=0.0,
        failed_guidance_check=0.0,
        events=EventLog(empty, empty, 0.0, 0.0, 0.0),
        fault=0.0,
        lift_check=0.0,
        payload=vehicle.payload.mass,
    )


def supervision_checks(table: SupervisionTable, guidance: str) -> Iterator[CheckResult]:
    """Check for a supervision without interactive guidance; `guidance`: `pilot.guidance`."""
    if table.model != "none" and guidance != "interactive":
        yield refused('supervision.model = "on": must be "none" where pilot.guidance is "scheduled"')


def limit_checks(table: SupervisionTable) -> Iterator[CheckResult]:
    """Check for limits that exclude each other."""
    if table.model == "none":
        return
    fence, checks = table.fence, table.checks
    if any(low >= high for low, high in zip(fence.low, fence.high, strict=True)):
        yield refused(
            f"supervision.fence.low = {shown(fence.low)}: must be below supervision.fence.high = "
            f"{shown(fence.high)} along each axis"
        )
    if checks.min_payload_ratio >= checks.max_payload_ratio:
        most = f"supervision.checks.max_payload_ratio = {checks.max_payload_ratio}"
        yield refused(f"supervision.checks.min_payload_ratio = {checks.min_payload_ratio}: must be below {most}")


def watchdog_checks(table: SupervisionTable, intervals: Mapping[str, float], step: float) -> Iterator[CheckResult]:
    """Check for watchdogs that trigger between two samples; `intervals` of the sensors [s] by key."""
    if table.model == "none":
        return
    for name in ("stale_time", "invalid_time"):
        for sensor, interval in intervals.items():
            if getattr(table.watchdog, name) <= max(interval, step):
                given = f"supervision.watchdog.{name} = {getattr(table.watchdog, name)}"
                yield refused(f"{given}: must be longer than {sensor} = {interval}, and than mission.step")
