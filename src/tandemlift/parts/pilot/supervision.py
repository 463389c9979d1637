"""The supervision of a mission, and its scheduled requests."""

from __future__ import annotations

from typing import Any

from tandemlift.core.algebra.ops import cos
from tandemlift.core.algebra.vector import Nothing, Vec3, each, vec3
from tandemlift.core.faults import REACTIONS
from tandemlift.core.settings import Mission
from tandemlift.parts.guidance.fault_detection import NO_TIME, ActiveFaults, Fence, SupervisionLimits
from tandemlift.parts.guidance.preflight_checks import PreflightChecks
from tandemlift.parts.guidance.requests import RequestSchedule
from tandemlift.parts.guidance.supervision import EventLog, Supervision, SupervisionState
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler
from tandemlift.parts.vehicle import Vehicle

SLOTS = 16  # largest number of events
PADDED = 4  # the number of requests is rounded up to a multiple: it is a part of the compiled variant
NEVER = 1e18  # s


def start_requests(mission: Mission) -> Any:
    """The requests of a mission, in the order of time, or `Nothing`."""
    requests = sorted(mission.requests, key=lambda r: r.time)
    if not requests:
        return Nothing()
    enabling = [r.action == "enable" for r in requests if r.action in ("enable", "disable")]
    first = before = 0.0 if enabling[:1] == [True] else 1.0
    changes = []
    for r in requests:
        after = {"enable": 1.0, "disable": 0.0}.get(r.action, before)
        changes.append(after - before)
        before = after
    spare = -len(requests) % PADDED
    cls = each(len(requests) + spare)

    def column(values: list[float], rest: float = 0.0) -> Any:
        return cls(*values, *[rest] * spare)

    lift, land, stop = ([float(r.action == what) for r in requests] for what in ("lift", "land", "stop"))
    times = column([r.time for r in requests], NEVER)
    return RequestSchedule(times, column(lift), column(land), column(stop), column(changes), first)


def _checks(mission: Mission, vehicle: Vehicle) -> PreflightChecks:
    c, payload = mission.supervision.checks, vehicle.payload.mass
    return PreflightChecks(
        thrust_fraction=c.thrust_fraction,
        min_upright=cos(c.tilt),
        speed=c.speed,
        rates=c.rates,
        min_payload=payload * c.min_payload_ratio,
        max_payload=payload * c.max_payload_ratio,
    )


def _limits(mission: Mission) -> SupervisionLimits:
    b, w = mission.supervision.limits, mission.supervision.watchdog
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
        touchdown_gap=mission.supervision.touchdown_gap,
    )


def start_supervision(mission: Mission, vehicle: Vehicle, known: Any) -> tuple[Any, Any]:
    """The supervision of a mission before its first sample, and its memory; or `Nothing`.

    Args:
        mission: the mission.
        vehicle: the nominal one.
        known: the known rotor faults.
    """
    s, i = mission.supervision, mission.initial
    if s.model == "none":
        return Nothing(), Nothing()
    slots, rotors = each(SLOTS), each(vehicle.rotor_count)
    supervision = Supervision(
        mass=vehicle.mass,
        payload=vehicle.payload.mass,
        limits=rotors(*[q.max_thrust for q in vehicle.quadrotors for _ in range(4)]),
        known=known,
        checks=_checks(mission, vehicle),
        fence=Fence(vec3(s.fence.low), vec3(s.fence.high), s.fence.margin, s.fence.braking_gain),
        bounds=_limits(mission),
        reactions=ActiveFaults(**{name: float(REACTIONS.index(r)) for name, r in s.reactions}),
        hold_timeout=s.hold_timeout,
        recovery_time=s.recovery_time,
        blind_descent_depth=s.blind_descent_depth,
        blind_descent_acceleration=s.blind_descent_acceleration,
        slots=slots(*map(float, range(SLOTS))),
    )
    at, empty = Vec3(*i.position), slots(*(0.0,) * SLOTS)
    state = State(at, vec3(i.velocity), quaternion_from_euler(vec3(i.euler)), vec3(i.rates))
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
