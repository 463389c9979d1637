"""The reaction to faults, such as a failed rotor: the strongest reaction that is configured for any of them.

The faults, their numbers and their order are in `common.faults`; `fault_detection` detects them.
"""

from collections import namedtuple
from typing import Any, NamedTuple, cast

from tandemlift.algebra.law import law
from tandemlift.algebra.ops import where
from tandemlift.common.faults import FAULTS, REACTIONS

_, HOLDS, LANDS, STOPS = map(float, range(len(REACTIONS)))
_FaultTuple: Any = cast(Any, namedtuple("_FaultTuple", [fault.key for fault in sorted(FAULTS)]))


class ActiveFaults(_FaultTuple):
    """A value for each fault, by its key: 1 or the number of a symptom (from 1) while it is present, else 0."""

    __slots__ = ()


class FaultReaction(NamedTuple):
    """The strongest reaction to the faults that are present, and the alarm of the first that calls for it; or zeros."""

    reaction: Any
    alarm: Any


NO_ALARM = FaultReaction(0.0, 0.0)


@law
def stronger(w: FaultReaction, fault: Any, reaction: Any, alarm: Any) -> FaultReaction:
    """The reaction with one more fault: to that fault if it is present (above 0) and its reaction is stronger."""
    more = where(fault > 0.0, where(reaction > w.reaction, 1.0, 0.0), 0.0)
    return FaultReaction(where(more > 0.0, reaction, w.reaction), where(more > 0.0, alarm, w.alarm))


@law
def strongest_reaction(f: ActiveFaults, r: ActiveFaults) -> FaultReaction:
    """The strongest reaction to the faults `f`, with the reaction `r` to each."""
    w = NO_ALARM
    for fault in FAULTS:
        present, alarm = getattr(f, fault.key), float(fault.alarm)
        w = stronger(w, present, getattr(r, fault.key), alarm + present if fault.symptoms else alarm)
    return w
