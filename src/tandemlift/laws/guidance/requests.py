"""What an operator asks of the vehicle: at set times, or now; and what it is told of itself beside the state.

To lift and to land are asked once, and forgotten when done or in vain; stop is for good; enabled or not holds until the
next word on it.
"""

from typing import Any, NamedTuple

from tandemlift.algebra.law import choice, elementwise, law
from tandemlift.algebra.ops import maximum, minimum, where
from tandemlift.algebra.vector import total


class OperatorRequest(NamedTuple):
    """What is asked now, 1 or 0: to lift, to stop the rotors at once; and whether pushes may be listened to."""

    lift: Any
    stop: Any
    enabled: Any


class VehicleStatus(NamedTuple):
    """What the pilot knows of its vehicle at a sample.

    `rotor_lost` is 1 if one is found to be lost, else 0; `thrust` [N] of all rotors as allocated at the last sample, 0
    if that is not known; `blank` is 1 if the state that it is told has no numbers, else 0.
    """

    rotor_lost: Any
    thrust: Any
    blank: Any


NOBODY = OperatorRequest(0.0, 0.0, 1.0)
UNAWARE = VehicleStatus(0.0, 0.0, 0.0)


class RequestSchedule(NamedTuple):
    """Requests at times [s], sets: 1 where one is to lift, to land, to stop; by how much one changes `enabled`."""

    time: Any
    lift: Any
    land: Any
    stop: Any
    change: Any
    enabled: Any


class RequestCounts(NamedTuple):
    """What has been asked until a time: how often to lift and to land; 1 or 0 for to stop, and for enabled."""

    lifts: Any
    lands: Any
    stop: Any
    enabled: Any


@elementwise
def due(time, what, t):
    """What is asked from a time on, else 0."""
    return where(t >= time, what, 0.0)


@choice(absent=NOBODY)
def operator_of(company: Any) -> Any:
    """What is asked by somebody at the vehicle, from their memory: nothing, but of those who can."""


@choice(absent=RequestCounts(0.0, 0.0, 0.0, 1.0))
def asked_until(requests: Any, t: Any) -> Any:
    """What requests ask until time t [s]."""


@asked_until.register(RequestSchedule)
def _asked(requests, t):
    r = requests
    return RequestCounts(
        total(due(r.time, r.lift, t)),
        total(due(r.time, r.land, t)),
        minimum(total(due(r.time, r.stop, t)), 1.0),
        r.enabled + total(due(r.time, r.change, t)),
    )


@law
def also(asked: RequestCounts, operator: OperatorRequest, lifts: Any, lands: Any) -> RequestCounts:
    """What is asked, with an operator's wishes and so many more requests to lift and to land."""
    return RequestCounts(
        asked.lifts + lifts,
        asked.lands + lands,
        maximum(asked.stop, operator.stop),
        minimum(asked.enabled, operator.enabled),
    )
