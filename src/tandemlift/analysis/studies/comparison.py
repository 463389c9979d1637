"""Comparison of flights of one mission, by several controllers or in several engines: who takes part, and the flights.

`comparison_scores` has the scores.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, NamedTuple

from tandemlift.analysis.studies.comparison_scores import (
    ScoreTable,
    controller_table,
    effort,
    engine_table,
    largest_differences,
    step_time,
)
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.core.errors import InputError
from tandemlift.core.plugs import explained
from tandemlift.core.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, MissionTemplate, load_mission
from tandemlift.parts.controllers import CONTROLLERS, Controller, controller


class Entry(NamedTuple):
    """A controller or an engine in a comparison.

    Attributes:
        name: of the controller or the engine.
        mission: that is flown; None if the controller cannot fly it.
        engine: in which it is flown.
        refusal: why the controller cannot fly it.
        flight: once it is flown.
    """

    name: str
    mission: Mission | None = None
    engine: str = "compiled"
    refusal: str = ""
    flight: Flight | None = None


@dataclass(frozen=True)
class MissionComparison:
    """Flights of one mission that differ in one thing, from `with_controllers` or `in_engines`.

    Attributes:
        of: what differs.
        entries: in the order of the tables.
    """

    of: Literal["controllers", "engines"]
    entries: Sequence[Entry]

    @property
    def name(self) -> str:
        """The name of the mission."""
        return next(e.mission.mission.name for e in self.entries if e.mission)

    @cached_property
    def flights(self) -> dict[str, Flight]:
        """The flights by the name of the controller or engine; at least one has flown."""
        return {e.name: e.flight for e in self.entries if e.flight}

    @cached_property
    def table(self) -> ScoreTable:
        """The table of scores."""
        return (controller_table if self.of == "controllers" else engine_table)(self.flights)

    def fly(self, progress: Progress | None = None) -> MissionComparison:
        """Fly every entry that has a mission, in the order given.

        Args:
            progress: called with (flights flown, flights in all).

        Raises:
            InputError: an engine is unknown or cannot fly the mission, or a user's controller fails.
        """
        missions, engines = zip(*((e.mission, e.engine) for e in self.entries if e.mission), strict=True)
        try:  # on one thread, because their speed is compared
            flights = fly_each(missions, engines, keep="flights", interrupted=True, threads=1, progress=progress)
        except Exception as error:
            if (told := explained(error)) is error:
                raise
            raise told from error
        flown = iter(flights)
        return replace(self, entries=[e._replace(flight=next(flown)) if e.mission else e for e in self.entries])

    def lines(self) -> Iterator[str]:
        """The table as text, with what failed or was refused."""
        table = self.table
        yield f"{self.name}: {table.what}"
        sizes = [max(map(len, column)) for column in zip(table.titles, *table.rows.values(), strict=True)]
        width = max(len(entry.name) for entry in self.entries) + 2
        yield "  " + " " * width + "  ".join(map(str.rjust, table.titles, sizes))
        for name, _, _, refusal, flight in self.entries:
            yield f"  {name.ljust(width)}{'  '.join(map(str.rjust, table.rows.get(name, ()), sizes))}".rstrip()
            if note := flight.failure if flight else f"not flown: {refusal}":
                yield f"  {'':{width}}{note}"

    def as_json(self) -> dict[str, Any]:
        """The comparison as JSON, an object for each entry; SI units. Differences of engines are from the first."""
        if self.of == "engines":
            first = next(iter(self.flights.values()))
            return {"mission": self.name, "engines": [_engine_json(*one, first) for one in self.flights.items()]}
        rows = [_controller_json(entry) for entry in self.entries]
        return {"mission": self.name, "engine": self.entries[0].engine, "controllers": rows}


def _controller_json(entry: Entry) -> dict[str, Any]:
    flight, flown = entry.flight, entry.flight is not None
    row: dict[str, Any] = {"controller": entry.name, "flown": flown, "refused": entry.refusal}
    if flight:
        time, findings = step_time(flight), [finding.as_table() for finding in flight.findings]
        row |= {"effort_n_m": effort(flight), "step_ns": time and 1e9 * time, "findings": findings}
        row |= {"failure": flight.failure or None, "settings": flight.mission["controller"]}
        row |= {"metrics": flight.metrics()}
    return row


def _engine_json(name: str, flight: Flight, first: Flight) -> dict[str, Any]:
    time = step_time(flight)
    return {
        "engine": name,
        "difference": largest_differences(flight, first),
        "final_position_m": flight.metrics()["final_position_m"],
        "steps_per_s": time and 1.0 / time,
        "findings": [finding.as_table() for finding in flight.findings],
        "failure": flight.failure or None,
        "version": flight.version,
    }


def in_engines(mission: Mission, engines: Sequence[str]) -> MissionComparison:
    """A mission in several engines, not yet flown.

    Args:
        mission: from `load_mission`.
        engines: names of the engines, without repetition.

    Raises:
        InputError: fewer than two engines are named, or one twice.
    """
    if len(set(engines)) < max(2, len(engines)):
        raise InputError(f"engines = {', '.join(engines)}: must be two or more, without repetition")
    return MissionComparison("engines", [Entry(engine, mission, engine) for engine in engines])


def with_controllers(
    name: str, changes: Mapping[str, Any], chosen: Sequence[Controller] | None = None, engine: str = "compiled"
) -> MissionComparison:
    """A mission with several controllers, not yet flown.

    Args:
        name: name of a built-in mission, or path of a TOML file.
        changes: values by dotted key; those of `controller` apply to the mission's own controller only.
        chosen: the controllers; if None, the mission's own and then all others by name. Of these, one that lacks
            settings is refused, and the others fly.
        engine: name of the engine.

    Raises:
        InputError: the mission cannot be loaded, or a chosen controller cannot fly it.
    """
    others = {key: value for key, value in changes.items() if key.partition(".")[0] != "controller"}
    own = _own_mission(name, changes, others)

    def enter(entrant: Controller) -> Entry:
        same = entrant.name == own.controller.name
        return Entry(entrant.name, own if same else load_mission(name, others, controller=entrant), engine)

    if chosen is not None:
        return MissionComparison("controllers", [enter(one) for one in chosen])
    entries = [Entry(own.controller.name, own, engine)]
    for other in sorted(CONTROLLERS.keys() - {own.controller.name}):
        try:
            entries.append(enter(controller(other)))
        except InputError as error:
            entries.append(Entry(other, None, engine, str(error)))
    return MissionComparison("controllers", entries)


def _own_mission(name: str, changes: Mapping[str, Any], others: Mapping[str, Any]) -> Mission:
    """The mission with its own controller; keys of another one are rejected, with the right place for them.

    Args:
        name: of the mission.
        changes: values by dotted key.
        others: those that are not of `controller`.
    """
    try:
        return load_mission(name, changes)
    except InputError as error:
        if "controller.name" in changes or not re.search(r"\bcontroller\.[^\n]*: unknown key", str(error)):
            raise
        own = MissionTemplate.read(name, others, quiet=True).mission({})
        raise InputError(
            f"{error}\n--set gives keys to {own.controller.name} only, the controller of mission {own.mission.name}. "
            "Give those of another one by a mission file that has its [controller]."
        ) from None


def names_in(option: str, given: str, example: str) -> list[str]:
    """The names of a comma-separated list, without repetition.

    Raises:
        InputError: the list is empty.
    """
    names = list(dict.fromkeys(part.strip() for part in given.split(",") if part.strip()))
    if not names:
        raise InputError(f"{option}: must be a comma-separated list of names, such as {example}")
    return names
