"""The result of a search, and its files: the mission with the new values, and the evidence."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.analysis.studies.tuning.candidates import Cost
from tandemlift.analysis.studies.tuning.draws import Draw
from tandemlift.analysis.studies.tuning.holdout import Evidence, as_table
from tandemlift.analysis.studies.tuning.task import Task, Values
from tandemlift.core.errors import InputError
from tandemlift.core.files import versions, write_file
from tandemlift.missions import MISSING, Mission, Place, Tables, built_in, format_toml, tables_of, value_at

MISSION_FILE, EVIDENCE_FILE = "tuned.toml", "evidence.json"


class Tuning(NamedTuple):
    """The result of a search.

    Attributes:
        task: the task of the search.
        seed: of the search and of its draws.
        budget: number of candidates allowed.
        draws: on which candidates were compared.
        holdout: draws that the search never saw.
        old: the present values.
        new: the best values found.
        costs: of old and new, on the draws for the choice among the best; of an interrupted search, on its own draws.
        history: the cost of every candidate in the order of the search, the present values first.
        tried: the values of every candidate in that order.
        records: the candidates that were better than all before them, with their numbers in the history.
        ended: the reason for the end of the search.
        is_finished: whether it was not interrupted.
        evidence: the comparison on holdout draws; None after an interrupted search.
    """

    task: Task
    seed: int
    budget: int
    draws: tuple[Draw, ...]
    holdout: tuple[Draw, ...]
    old: Values
    new: Values
    costs: tuple[Cost, Cost]
    history: tuple[Cost, ...]
    tried: tuple[Values, ...]
    records: tuple[tuple[int, Values], ...]
    ended: str
    is_finished: bool
    evidence: Evidence | None = None

    @property
    def name(self) -> str:
        """The name of the mission that was tuned."""
        return self.task.source.mission.mission.name

    @property
    def changes(self) -> dict[str, Any]:
        """The new values as changes of the mission by dotted key; none if nothing better was found."""
        return {} if self.new == self.old else self.task.changes(self.new)

    @property
    def mission(self) -> Mission:
        """The mission with the new values."""
        return self.task.source.load(self.changes, {"mission.name": f"{self.name}-tuned"})

    @property
    def is_better(self) -> bool:
        """Whether the new values are better on holdout draws."""
        return self.evidence is not None and self.evidence.better

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Write the mission and the evidence atomically into a folder, and return the mission's path.

        Raises:
            InputError: the folder cannot be made.
        """
        folder = Path(folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{folder}: cannot be made: {error.strerror or error}") from None
        write_file(folder / EVIDENCE_FILE, json.dumps(self.as_table(), indent=1, allow_nan=False) + "\n")
        write_file(folder / MISSION_FILE, self.to_toml(folder))
        return folder / MISSION_FILE

    def to_toml(self, folder: Path = Path()) -> str:
        """The mission with the new values as a file for a folder: it extends the one that was tuned."""
        source, resolved = self.task.source, tables_of(self.mission)
        path = os.path.relpath(Path(source.name).resolve(), folder.resolve())
        tables: Tables = {"extends": source.name if source.name in built_in() else Path(path).as_posix()}
        for place in _places((*source.changes, *self.changes, "mission.name"), whole=source.controller is not None):
            value = value_at(resolved, place)
            if value is not MISSING:
                _put(tables, place, value)
        unfinished = "" if self.is_finished else ", unfinished"
        return (
            f"# {self.name}, tuned for {', '.join(g.name for g in self.task.goals)}{unfinished}\n{format_toml(tables)}"
        )

    @property
    def identity(self) -> str:
        """A digest of all that decides which candidates are tried and what they cost, but for the budget."""
        task, p = self.task, self.task.parameters
        goals = [(goal, scale.tolist()) for goal, scale in zip(task.goals, task.scales, strict=True)]
        said = (tables_of(task.source.mission), p, goals, task.aim, task.strict, self.seed, self.draws)
        return hashlib.sha256(repr((said, sorted(versions("compiled").items()))).encode()).hexdigest()[:16]

    def tried_before(self, folder: str | os.PathLike[str]) -> list[tuple[Values, Cost]]:
        """The candidates of this search that a folder holds, as it was stopped; none of another search."""
        try:
            found = json.loads((Path(folder) / EVIDENCE_FILE).read_text("utf-8"))["search"]
            before = [(tuple(v), Cost(*c)) for v, c in zip(found["tried"], found["history"], strict=True)]
        except (OSError, ValueError, LookupError, TypeError, RecursionError):
            return []
        now = list(zip(self.tried, self.history, strict=True))
        return before if found["identity"] == self.identity and before[: len(now)] == now else []

    def as_table(self) -> dict[str, Any]:
        """The result as JSON: task, optimiser, values, history, evidence."""
        task = self.task
        return {
            "mission": task.source.name,
            "changes": task.source.changes,
            "controller": task.source.mission.controller.name,
            "seed": self.seed,
            "budget": self.budget,
            "aim": task.aim,
            "strict": task.strict,
            "finished": self.is_finished,
            "ended": self.ended,
            "goals": [
                {"metric": goal.name, "target": goal.target, "targets": dict(goal.targets), "scale": scale[0].tolist()}
                for goal, scale in zip(task.goals, task.scales, strict=True)
            ],
            "parameters": [
                {
                    "key": p.name,
                    "old": old,
                    "new": new,
                    "low": p.low,
                    "high": p.high,
                    "scale": "log" if p.is_log else "linear",
                }
                for p, old, new in zip(task.parameters, self.old, self.new, strict=True)
            ],
            "choice": {"old": self.costs[0]._asdict(), "new": self.costs[1]._asdict()},
            "search": {
                "draws": [draw._asdict() for draw in self.draws],
                "identity": self.identity,
                "history": [[cost.bad, cost.ratio] for cost in self.history],
                "tried": [list(values) for values in self.tried],
                "records": [[number, *values] for number, values in self.records],
            },
            "evidence": None if self.evidence is None else as_table(self.evidence, self.holdout, task.goals),
        }


def present_values(task: Task) -> Values:
    """The present values of a task's parameters, exactly."""
    return tuple(p.own if p.place is None else p.own[p.place] for p in task.parameters)


def _places(keys: Iterable[str], *, whole: bool) -> Iterable[Place]:
    """The places of dotted keys; a list of tables is written whole, as is the table of another controller."""
    found: dict[Place, None] = {("controller",): None} if whole else {}
    for key in keys:
        parts = key.split(".")
        stop = next((i for i, part in enumerate(parts) if part.isdigit()), len(parts))
        found[("controller",) if key == "controller.name" else tuple(parts[:stop])] = None
    return [place for place in found if not any(place[:i] in found for i in range(1, len(place)))]


def _put(tables: Tables, place: Place, value: object) -> None:
    *above, last = map(str, place)
    for part in above:
        tables = tables.setdefault(part, {})
    tables[last] = value
