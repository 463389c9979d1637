"""Requests of an operator, at set times or now; and the status of the vehicle beside its state.

A request to lift or to land counts once, and lapses once it is done or refused. A stop is final. Enabled or disabled
holds until the next request about it.
"""

from typing import Any, NamedTuple

from tandemlift.core.algebra.law import choice, elementwise, law
from tandemlift.core.algebra.ops import maximum, minimum, where
from tandemlift.core.algebra.vector import total


class OperatorRequest(NamedTuple):
    """Requests of now, 1 or 0: to lift, to stop the rotors at once; and whether pushes may be followed."""

    lift: Any
    stop: Any
    enabled: Any


class VehicleStatus(NamedTuple):
    """The status of the vehicle at a sample, as the pilot knows it.

    `rotor_failed` is 1 once a rotor has failed, else 0; `thrust` [N] of all rotors as allocated at the last sample, 0
    if unknown; `state_invalid` is 1 if the pilot's state has values that are not numbers, else 0; `limited`: the number
    of the reason why it cannot follow its reference, or 0.
    """

    rotor_failed: Any
    thrust: Any
    state_invalid: Any
    limited: Any = 0.0


NO_REQUEST = OperatorRequest(0.0, 0.0, 1.0)
UNKNOWN_STATUS = VehicleStatus(0.0, 0.0, 0.0)


class RequestSchedule(NamedTuple):
    """Requests at times [s], sets: 1 where one is to lift, to land, to stop; the change of `enabled` by each."""

    time: Any
    lift: Any
    land: Any
    stop: Any
    change: Any
    enabled: Any


class RequestCounts(NamedTuple):
    """All requests until a time: the number of those to lift and to land; 1 or 0 for stop, and for enabled."""

    lifts: Any
    lands: Any
    stop: Any
    enabled: Any


@elementwise
def due(time: Any, request: Any, t: Any) -> Any:
    """A request from its time on, before 0."""
    return where(t >= time, request, 0.0)


@choice(absent=NO_REQUEST)
def operator_request(person: Any) -> Any:
    """`OperatorRequest` of a person at the vehicle, from their memory."""


@choice(absent=RequestCounts(0.0, 0.0, 0.0, 1.0))
def requests_until(requests: Any, t: Any) -> Any:
    """`RequestCounts` of a schedule until time t [s]."""


@requests_until.register(RequestSchedule)
def _until(requests: RequestSchedule, t: Any) -> RequestCounts:
    r = requests
    return RequestCounts(
        total(due(r.time, r.lift, t)),
        total(due(r.time, r.land, t)),
        minimum(total(due(r.time, r.stop, t)), 1.0),
        r.enabled + total(due(r.time, r.change, t)),
    )


@law
def with_operator(requests: RequestCounts, operator: OperatorRequest, lifts: Any, lands: Any) -> RequestCounts:
    """The requests, with those of an operator of now, and so many more to lift and to land."""
    return RequestCounts(
        requests.lifts + lifts,
        requests.lands + lands,
        maximum(requests.stop, operator.stop),
        minimum(requests.enabled, operator.enabled),
    )
