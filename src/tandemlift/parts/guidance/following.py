"""Detection of a vehicle that cannot follow its reference, with the reason (`core.phases.REASONS`).

The force that the rotors must give is n = m g e_z − d − p, with the observed disturbance d and the push p that is
compensated. The vehicle cannot follow if |n| exceeds the usable thrust, if the horizontal part of n needs too much
tilt, if the heading cannot be held, or if the vehicle stays too far from its reference. A reason must last for a time,
and all must be absent for a longer time before pushes are followed again. Until then the reason only changes to one of
higher priority. A vehicle that has lost its heading rotates faster and faster, so it eventually lands.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from tandemlift.core.algebra import absolute, maximum, minimum, tan, where
from tandemlift.core.findings import Finding, finding
from tandemlift.core.keys import NonNegative, Positive, Table, key
from tandemlift.core.law import law
from tandemlift.core.part import Part
from tandemlift.core.phases import REASONS
from tandemlift.core.types import Number, filled
from tandemlift.core.vector import Vec3, dot
from tandemlift.parts.mechanics.vehicle import Vehicle


class FollowingTable(Table):
    """`[compliance.following]`: when the vehicle counts as unable to follow, phase "limited".

    It then holds and ignores pushes, until it can follow again. docs/reference/faults.md lists all reasons.
    """

    max_error: Positive = key(
        0.3, "m", "largest distance from the reference", source="chosen: ten times that in wind and with slow rotors"
    )
    time: NonNegative = key(0.5, "s", "time for which it must be unable to follow", source="chosen")
    recovery_time: NonNegative = key(1.0, "s", "time after which it counts as able to follow again", source="chosen")
    heading_timeout: NonNegative = key(
        5.0,
        "s",
        "time after which a vehicle that has lost its heading lands, before it rotates too fast for a landing",
        source="chosen",
    )


class FollowingLimits(NamedTuple):
    """Limits, the time [s] for which one must be exceeded, and the time [s] without excess that ends the state.

    `side_force` [N]: force of the largest tilt under the nominal weight; `heading_error` [rad]; `position_error` [m].
    `heading_timeout` [s]: for which the heading may be lost before a landing.
    """

    side_force: Number
    heading_error: Number
    position_error: Number
    time: Number
    recovery_time: Number
    heading_timeout: Number


class Following(NamedTuple):
    """The quantities that are compared with the limits.

    The force that the rotors must give [N, world axes], the largest that may be used [N], the reference less the
    position [m] and heading [rad]; `active` is 1 in the phases that have such limits, else 0.
    """

    needed: Vec3
    max_thrust: Number
    error: Vec3
    heading_error: Number
    active: Number


class FollowingState(NamedTuple):
    """Memory: times [s] for which each limit, and none of them, has been exceeded; the number of the reason, or 0.

    For findings: the time `first` of a reason [s]; the total time with a reason, `lasted` [s]; the most urgent one;
    and the uninterrupted time with a lost heading [s].
    """

    thrust: Number
    tilt: Number
    heading: Number
    position: Number
    clear_time: Number
    reason: Number
    first: Number
    lasted: Number
    most_urgent: Number
    longest_lost: Number


AT_REST = FollowingState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@law
def exceeded_for(time: Number, value: Number, limit: Number, active: Number, dt: Number) -> Number:
    """The time for which a value has been above its limit [s]."""
    return (time + dt) * where(value > limit, active, 0.0)


@law
def first_reason(k: FollowingLimits, m: FollowingState) -> Number:
    """The number of the first limit that has been exceeded for its time, or 0."""
    # from the last reason to the first, which thus takes precedence
    number = 0.0
    for i, reason in reversed(list(enumerate(REASONS, start=1))):
        number = where(getattr(m, reason.key) > k.time, float(i), number)
    return number


@law
def more_urgent(reason: Number, other: Number) -> Number:
    """The reason of higher priority of two, each of which may be 0 for none."""
    return where(reason > 0.0, where(other > 0.0, minimum(reason, other), reason), other)


@law
def update_following(k: FollowingLimits, m: FollowingState, f: Following, t: Number, dt: Number) -> FollowingState:
    """The memory after a sample at time t [s] that is held for dt [s]."""
    n = f.needed
    after = m._replace(
        thrust=exceeded_for(m.thrust, dot(n, n), f.max_thrust * f.max_thrust, f.active, dt),
        tilt=exceeded_for(m.tilt, n.x * n.x + n.y * n.y, k.side_force * k.side_force, f.active, dt),
        heading=exceeded_for(m.heading, absolute(f.heading_error), k.heading_error, f.active, dt),
        position=exceeded_for(m.position, dot(f.error, f.error), k.position_error * k.position_error, f.active, dt),
    )
    clear = where(after.thrust + after.tilt + after.heading + after.position > 0.0, 0.0, m.clear_time + dt)
    kept = where(clear > k.recovery_time, 0.0, m.reason)
    reason = more_urgent(first_reason(k, after), kept) * f.active
    return after._replace(
        clear_time=clear,
        reason=reason,
        first=where(m.lasted + reason > 0.0, where(m.lasted > 0.0, m.first, t), 0.0),
        lasted=m.lasted + where(reason > 0.0, dt, 0.0),
        most_urgent=more_urgent(m.most_urgent, reason),
        longest_lost=maximum(m.longest_lost, after.heading),
    )


@law
def must_land(k: FollowingLimits, m: FollowingState) -> Number:
    """1 once the heading has been lost for too long, else 0."""
    return where(m.heading > k.heading_timeout, 1.0, 0.0)


HEADING_FRACTION = 0.9  # of the angle by which the reference heading may lead, at which the heading counts as lost


def start_following(
    table: FollowingTable, vehicle: Vehicle, guidance_tilt: Number, max_lead_angle: Number
) -> tuple[FollowingLimits, FollowingState]:
    """The limits, with a largest tilt [rad] and a largest lead of the reference heading [rad], and the memory."""
    force, lost = tan(guidance_tilt) * vehicle.weight, HEADING_FRACTION * max_lead_angle
    errors = {"heading_error": lost, "position_error": table.max_error}
    return filled(FollowingLimits, table, side_force=force, **errors), AT_REST


def following_findings(m: FollowingState, table: FollowingTable) -> Iterator[Finding]:
    """The finding of a vehicle that could not follow, with the most urgent reason."""
    if m.most_urgent:
        reason = REASONS[int(m.most_urgent) - 1]
        lands = ", so that it lands" if m.longest_lost > table.heading_timeout else ""
        text = f"the vehicle cannot follow: {reason.text}, for {m.lasted:.3g} s{lands}"
        yield finding("cannot-follow", text, time=m.first, duration=m.lasted, quantity=reason.text)


FOLLOWING = Part("following", "guidance", "compliance.following", "", start_following, findings=following_findings)
