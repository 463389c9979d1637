"""Missions in groups that fly together: of one variant and grid, and in the order of what happens in them."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Sequence, Sized
from typing import Any, NamedTuple

SORTED_FLIGHTS = 64  # flights of one variant that are sorted before they are cut into blocks
WAITING = 512  # flights, at most, that wait for others of their variant


class FlightGroup(NamedTuple):
    """Flights that fly together, with their indices among all missions; or the refusal of the mission at one index."""

    places: list[int]
    flights: list[Any]
    refusal: Exception | None = None

    def pop(self, numbers: Sequence[int]) -> FlightGroup:
        """Take some of them out."""
        taken = FlightGroup([self.places[i] for i in numbers], [self.flights[i] for i in numbers])
        for i in sorted(numbers, reverse=True):
            del self.places[i], self.flights[i]
        return taken

    def blocks(self) -> Iterator[FlightGroup]:
        """Take out all, at most `lanes` at once, in the order of what happens in the flights."""
        while self.flights:
            yield self.pop(
                sorted(range(len(self.flights)), key=lambda i: self.flights[i].regime)[: self.flights[0].lanes]
            )


class FlightGroups:
    """The groups of some missions, for any number of threads: each takes the next group when it is free.

    A group is prepared by the thread that takes it, so that one thread prepares while others fly, and no more missions
    are held than those that fly or wait for others of their variant.

    Args:
        missions: an iterable, of which one mission is read after the other.
        plan: gives the `FlightPlan` of a mission, or its refusal.
        progress: called with the flights that are finished, and all of them.

    Attributes:
        read: the number of missions read so far.
    """

    def __init__(
        self,
        missions: Iterable[Any],
        plan: Callable[[Any], Any],
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        self.read, self._plan = 0, plan
        self._finished, self._total = 0, len(missions) if isinstance(missions, Sized) else None
        self._groups, self._progress = self._grouped(missions), progress
        # apart, because a group is prepared, which takes long, while the first is held
        self._taking, self._counting = threading.Lock(), threading.Lock()

    def take(self) -> FlightGroup | None:
        """The next group; None if there is no other. Raises what `plan` raises."""
        with self._taking:
            return next(self._groups, None)

    def finish(self, group: FlightGroup) -> None:
        """Count a group that has flown."""
        with self._counting:
            self._finished += len(group.places)
            if self._progress:
                self._progress(self._finished, self.read if self._total is None else self._total)

    def _grouped(self, missions: Iterable[Any]) -> Iterator[FlightGroup]:
        """Groups of flights of one variant and grid, at most `lanes`; stepwise flights alone.

        A block takes as long as if what happens in a lane happened in all, so flights wait for others of their regime.
        """
        waiting = OrderedDict[Any, FlightGroup]()
        for place, mission in enumerate(missions):
            self.read, p = place + 1, self._plan(mission)
            if isinstance(p, Exception):
                yield FlightGroup([place], [], p)
            elif p.stepwise:
                yield FlightGroup([place], [p])
            else:
                key = (p.variant, p.steps, p.every, p.dt, tuple(p.delays.tolist()))
                group = waiting.setdefault(key, FlightGroup([], []))
                group.places.append(place)
                group.flights.append(p)
                alike = [i for i, flight in enumerate(group.flights) if flight.regime == p.regime]
                if len(alike) == p.lanes:
                    yield group.pop(alike)
                elif len(group.flights) == SORTED_FLIGHTS:
                    yield from group.blocks()
                elif sum(len(g.flights) for g in waiting.values()) > WAITING:  # the group that waits longest flies
                    yield from waiting.popitem(last=False)[1].blocks()
                if not group.flights:
                    waiting.pop(key, None)
        for group in waiting.values():
            yield from group.blocks()
