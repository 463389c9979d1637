"""The tables of a study file, except for varied keys: `[study]`, `[[cases]]` and `[keep]`."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field

from tandemlift.core.keys import Table, key, must
from tandemlift.core.phases import OUTCOMES

MAX_ROWS = 10**9
OUTCOME_NAMES = tuple(kind.name for kind in OUTCOMES)
BLOCK, ROWS_PER_CHUNK, MOST_CHUNKS = 8, 256, 10_000
CHUNKS = 32  # at least, of a study that has enough rows: so many workers have something to do
Sampling = Literal["random", "sobol", "latin-hypercube"]
REFUSED = "refused"  # the outcome of a row that cannot be flown


def _name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}", name):
        raise must("name", "be 1 to 64 letters, digits, '.', '_' or '-', the first a letter or a digit")
    return name


def _words(name: str) -> str:
    if not re.fullmatch(r"\S(.{0,62}\S)?", name) or not name.isprintable():
        raise must("name", "be 1 to 64 characters on one line, the first and the last no spaces")
    return name


def _different(values: tuple[Any, ...]) -> tuple[Any, ...]:
    if len(set(values)) < len(values):
        raise must("different", "be without repetition")
    return values


def _some(values: tuple[Any, ...]) -> tuple[Any, ...]:
    if not values:
        raise must("some", "be a list of at least one")
    return values


def _plain(value: object, place: str = "") -> object:
    """A value as plain TOML and JSON data, with NumPy's numbers and tuples converted."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner, f"{place}.{key}" if place else str(key)) for key, inner in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist(), place)
    if isinstance(value, (list, tuple)):
        return [_plain(inner, f"{place}.{i}") for i, inner in enumerate(value)]
    if isinstance(value, (bool, int, str)) or (isinstance(value, float) and math.isfinite(value)):
        return value
    raise must("plain", f"hold finite numbers, true, false, texts, lists and tables only; {place} is {value!r}")


def _outcomes(values: tuple[str, ...]) -> tuple[str, ...]:
    if not set(values) <= set(OUTCOME_NAMES):
        raise must("outcomes", f"be a list of outcomes: {', '.join(OUTCOME_NAMES)}")
    return values


Name = Annotated[str, AfterValidator(_name)]
Names = Annotated[tuple[str, ...], AfterValidator(_different)]
MissionKeys = Annotated[dict[str, Any], BeforeValidator(_plain)]
Count = Annotated[int, Field(ge=1, le=MAX_ROWS)]


class StudyTable(Table):
    """`[study]`: missions, controllers and engines, and the number of random draws."""

    name: Name = key(..., None, "name of the study; its folder is out/NAME", example="gusts")
    missions: Annotated[Names, AfterValidator(_some)] = key(
        ..., None, "missions to fly: built-in names, or paths from the folder of this file", example=["hover"]
    )
    controllers: Names = key(
        (), None, "controllers to fly each mission with: names or .py files; empty: the mission's own", example=[]
    )
    plugins: Names = key(
        (), None, "files, from the folder of this one, or entry points of packages that bring what it names", example=[]
    )
    engines: Annotated[Names, AfterValidator(_some)] = key(
        ("compiled",), None, "engines to fly each of these in", example=["compiled"]
    )
    draws: Count = key(
        1,
        "1",
        "number of points of `[draw]`; the same points at every grid point, case, controller, engine and mission",
        example=200,
    )
    sampling: Sampling = key(
        "random",
        None,
        "sampling of the points",
        choices={
            "random": "independent",
            "sobol": "scrambled Sobol' sequence",
            "latin-hypercube": "one point in each slice of each axis",
        },
    )
    persons: Literal["own", "random"] = key(
        "own",
        None,
        "who pushes",
        choices={
            "own": "the person of the mission",
            "random": "a person drawn with each point: see `tandemlift study --template`",
        },
    )
    seeds: Count = key(1, "1", "flights of each point, with different mission.seed: noise, wind, tremor")
    seed: Annotated[int, Field(ge=0, le=10**18)] = key(0, "1", "seed of the points, and first mission.seed")
    rows_per_chunk: Annotated[int, Field(ge=1, le=1_000_000)] | None = key(
        None,
        "1",
        "flights in one file of results",
        unset="256; fewer for a small study, more for one of millions of rows",
    )


def default_rows_per_chunk(count: int) -> int:
    """Rows in one file of results of a study of `count` rows: whole blocks, so that all workers have some."""
    fewest, most = -(-count // MOST_CHUNKS), -(-count // CHUNKS)
    return -(-max(fewest, min(most, ROWS_PER_CHUNK)) // BLOCK) * BLOCK


class CaseTable(Table):
    """`[[cases]]`: a named set of changes of the mission."""

    name: Annotated[str, AfterValidator(_words)] = key(..., None, "name of the case", example="calm")
    set: MissionKeys = key({}, None, "changes of the mission, as in `[set]`")
    targets: dict[str, Any] = key(
        {}, None, "for `tandemlift tune`: targets of metrics in this case, by their names in metrics.json"
    )


class KeepTable(Table):
    """`[keep]`: data of each flight that goes into the table."""

    metrics: Names = key((), None, "metrics by their names in metrics.json; empty: all", example=[])
    channels: Names = key((), None, "channels to keep of some flights, such as position", example=[])
    rows: Annotated[tuple[Annotated[int, Field(ge=0)], ...], AfterValidator(_different)] = key(
        (), "1", "rows of which channels are kept", example=[]
    )
    every: Annotated[int, Field(ge=1)] | None = key(
        None, "1", "channels are kept of one row in so many, too", unset="of none"
    )
    outcomes: Annotated[Names, AfterValidator(_outcomes)] = key(
        (), None, "channels are kept of all rows with these outcomes, too", example=[]
    )


class StudySettings(Table):
    """A study file; `[set]`, `[grid]` and `[draw]` hold keys of missions."""

    study: StudyTable
    set: MissionKeys = Field({})
    cases: tuple[CaseTable, ...] = ()
    grid: MissionKeys = Field({})
    draw: MissionKeys = Field({})
    keep: KeepTable = KeepTable()
