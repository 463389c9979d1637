"""Requests of an operator, at set times or now; and the status of the vehicle beside its state.

A request to lift holds for `REQUEST_TIME`: if a check refuses it for so long, somebody has to ask again, so that no
rotor starts unasked. A landing in flight counts once. A stop is final. Enabled or disabled holds until the next request
about it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from tandemlift.core.algebra import maximum, minimum, where
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import NonNegative, Table, key
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import NEVER, Number, NumberSet
from tandemlift.core.vector import Absent, Vec3, each, total

REQUEST_TIME = 0.2  # s, for which a request to lift holds


class RequestTable(Table):
    """`[[requests]]`: requests of an operator, one table each; they need `pilot.guidance = "interactive"`.

    A lift that a check refuses lapses after 0.2 s.

    If the first request of "enable" and "disable" is "enable", the vehicle starts disabled.
    """

    time: NonNegative = key(..., "s", "time of the request", example=60.0)
    action: Literal["enable", "disable", "lift", "land", "stop"] = key(
        ...,
        None,
        "what is requested",
        example="land",
        choices={
            "enable": "respond to pushes",
            "disable": "hold the position and ignore pushes",
            "lift": "lift off",
            "land": "land",
            "stop": "turn the rotors off for good",
        },
    )


class OperatorRequest(NamedTuple):
    """Requests of now, 1 or 0: to lift, to stop the rotors at once; and whether pushes may be followed."""

    lift: Number
    stop: Number
    enabled: Number


class ReferenceVelocity(NamedTuple):
    """A velocity of the reference [m/s, world axes] in place of the admittance's; it counts if `given` is 1."""

    velocity: Vec3
    given: Number


class VehicleStatus(NamedTuple):
    """The status of the vehicle at a sample, as available to the pilot.

    `rotor_failed` is 1 once a rotor has failed, else 0; `thrust` [N] of all rotors as allocated at the last sample, 0
    if unknown; `state_invalid` is 1 if the pilot's state has values that are not numbers, else 0; `limited`: the number
    of the reason why it cannot follow its reference, or 0.
    """

    rotor_failed: Number
    thrust: Number
    state_invalid: Number
    limited: Number = 0.0


NO_REQUEST = OperatorRequest(0.0, 0.0, 1.0)
UNKNOWN_STATUS = VehicleStatus(0.0, 0.0, 0.0)


class RequestSchedule(NamedTuple):
    """Requests at times [s], sets: 1 where one is to lift, to land, to stop; the change of `enabled` by each."""

    time: NumberSet
    lift: NumberSet
    land: NumberSet
    stop: NumberSet
    change: NumberSet
    enabled: Number


class RequestCounts(NamedTuple):
    """The number of requests to lift that hold, and of all until now to land; 1 or 0 for stop, and for enabled."""

    lifts: Number
    lands: Number
    stop: Number
    enabled: Number


@elementwise
def due(time: Number, request: Number, t: Number) -> Number:
    """A request from its time on, before 0."""
    return where(t >= time, request, 0.0)


@elementwise
def held(time: Number, request: Number, t: Number) -> Number:
    """A request from its time on for `REQUEST_TIME`, before and after 0."""
    return where(t < time, 0.0, where(t < time + REQUEST_TIME, request, 0.0))


@choice(absent=NO_REQUEST)
def operator_request(person: object) -> OperatorRequest:
    """`OperatorRequest` of a person at the vehicle, from their memory."""


@law(absent=RequestCounts(0.0, 0.0, 0.0, 1.0))
def requests_until(requests: RequestSchedule, t: Number) -> RequestCounts:
    """`RequestCounts` of a schedule until time t [s]."""
    r = requests
    return RequestCounts(
        total(held(r.time, r.lift, t)),
        total(due(r.time, r.land, t)),
        minimum(total(due(r.time, r.stop, t)), 1.0),
        r.enabled + total(due(r.time, r.change, t)),
    )


@law
def with_operator(requests: RequestCounts, operator: OperatorRequest, lifts: Number, lands: Number) -> RequestCounts:
    """The requests, with those of an operator of now, and so many more to lift and to land."""
    return RequestCounts(
        requests.lifts + lifts,
        requests.lands + lands,
        maximum(requests.stop, operator.stop),
        minimum(requests.enabled, operator.enabled),
    )


MULTIPLE = 4  # of the size of a set that a mission may lengthen: each size is a compiled variant


def padded_set(values: Sequence[float], rest: float = 0.0) -> NumberSet:
    """The values as a set, which is filled up to a multiple of four with `rest`."""
    filled = [*values, *[rest] * (-len(values) % MULTIPLE)]
    return each(len(filled))(*filled)


def start_requests(tables: Sequence[RequestTable]) -> RequestSchedule | Absent:
    """The requests in the order of time, or `Absent`."""
    requests = sorted(tables, key=lambda r: r.time)
    if not requests:
        return Absent()
    enabling = [r.action == "enable" for r in requests if r.action in ("enable", "disable")]
    first = before = 0.0 if enabling[:1] == [True] else 1.0
    changes = []
    for r in requests:
        after = {"enable": 1.0, "disable": 0.0}.get(r.action, before)
        changes.append(after - before)
        before = after
    lift, land, stop = ([float(r.action == action) for r in requests] for action in ("lift", "land", "stop"))
    return RequestSchedule(
        time=padded_set([r.time for r in requests], NEVER),
        lift=padded_set(lift),
        land=padded_set(land),
        stop=padded_set(stop),
        change=padded_set(changes),
        enabled=first,
    )


def request_checks(tables: Sequence[RequestTable], guidance: str) -> Iterator[CheckResult]:
    """Check for requests that scheduled guidance does not handle; `guidance`: `pilot.guidance`."""
    if tables and guidance != "interactive":
        action = tables[0].action
        yield refused(f'requests.0.action = "{action}": must be left out where pilot.guidance is "scheduled"')
