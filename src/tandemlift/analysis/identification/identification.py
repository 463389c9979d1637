"""`Identification`: a vehicle from its logs, with intervals; as a mission file, as JSON and in lines."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.files import write_file
from tandemlift.core.types import Array
from tandemlift.missions import Mission, MissionTemplate, format_toml, tables_of

MISSION, JSON = "vehicle.toml", "identification.json"
NORMAL = 1.959963984540054  # of 95 % of a normal distribution
WHOLE = "whole vehicle"


class Row(NamedTuple):
    """An identified number.

    Attributes:
        key: mission key, or the name of a quantity of the whole vehicle.
        value: the estimate.
        low: lower end of its interval of 95 %.
        high: upper end.
        unit: of these.
        start: the mission's value.
        excited: whether the data narrowed the prior to less than half.
        efficiency: variance by the Cramér-Rao bound over that of the interval.
    """

    key: str
    value: float
    low: float
    high: float
    unit: str
    start: float
    excited: bool
    efficiency: float

    @property
    def half(self) -> float:
        """Half the interval."""
        return 0.5 * (self.high - self.low)


@dataclass(frozen=True)
class Identification:
    """A vehicle identified from its logs.

    Attributes:
        mission: the mission with the identified vehicle.
        rows: the estimates by mission key.
        whole: mass, centre of mass and inertia of the whole vehicle.
        remarks: what the data could not tell, in sentences.
        details: what the page shows beside these: `identification.json` has it.

    A row is found by its key; one with an asterisk is the mean of those of all quadrotors, without an efficiency.
    """

    mission: Mission
    rows: tuple[Row, ...]
    whole: tuple[Row, ...]
    remarks: tuple[str, ...]
    details: dict[str, Any]

    def __getitem__(self, key: str) -> Row:
        for row in (*self.rows, *self.whole):
            if row.key == key:
                return row
        if "*" in key and (own := [i for i, row in enumerate(self.rows) if fnmatch(row.key, key)]):
            rows, alike = [self.rows[i] for i in own], np.array(self.details["correlation"])[np.ix_(own, own)]
            value, halves = float(np.mean([row.value for row in rows])), np.array([row.half for row in rows])
            half = float(np.sqrt(max(halves @ alike @ halves, 0.0))) / len(rows)
            return rows[0]._replace(key=key, value=value, low=value - half, high=value + half, efficiency=math.nan)
        raise KeyError(f"{key} was not identified; {', '.join(row.key for row in (*self.rows, *self.whole))} were")

    def __repr__(self) -> str:
        return f"<Identification of {self.mission.mission.name}: {len(self.rows)} numbers, {len(self.remarks)} remarks>"

    def lines(self) -> Iterator[str]:
        """In words: estimates, their efficiency, predictions, then remarks."""
        rows = (*self.rows, *self.whole)
        wide = max(len(row.key) for row in rows)
        for row in rows:
            mark = "" if row.excited else "  not excited: kept by its prior"
            yield f"{row.key:{wide}}  {row.value:>12.6g} ± {row.half:<9.2g} {row.unit:12} was {row.start:.6g}{mark}"
        yield f"efficiency against the Cramér-Rao bound: {self.details['efficiency']:.2f} (median)"
        for title, part in (("held-back windows", "held_back"), ("another flight", "predicted")):
            if ratios := self.details[part].get("ratio", {}).values():
                yield f"{title}: residuals {min(ratios):.2f} to {max(ratios):.2f} times the noise"
        yield from self.remarks

    def as_dict(self) -> dict[str, Any]:
        """All of it as plain values, for JSON."""
        return {
            "mission": self.mission.mission.name,
            "parameters": [row._asdict() for row in self.rows],
            "whole_vehicle": [row._asdict() for row in self.whole],
            "remarks": list(self.remarks),
            **self.details,
        }

    def save(self, folder: Path) -> list[Path]:
        """Write `vehicle.toml` and `identification.json` into a folder, which is made."""
        folder.mkdir(parents=True, exist_ok=True)
        write_file(folder / MISSION, self.toml())
        write_file(folder / JSON, json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False))
        return [folder / MISSION, folder / JSON]

    def toml(self) -> str:
        """The mission as TOML; each identified key that it has, has its interval as a comment."""
        comments = dict[str, list[str]]()
        for row in self.rows:
            key = re.sub(r"\.[xyz]$", "", row.key)
            how = f"± {row.half:.2g}" if row.excited else "not excited: prior"
            comments.setdefault(key, []).append(how)
        return _commented(format_toml(tables_of(self.mission)), comments, self.details.get("refused", ()))


def _commented(text: str, comments: Mapping[str, list[str]], refused: Collection[str]) -> str:
    """TOML text with comments behind the lines of keys, but of those refused; `*` stands for each quadrotor."""
    lines, table, count = list[str](), "", dict[str, int]()
    for line in text.splitlines():
        head = re.match(r"\[\[?([\w.]+)\]\]?$", line)
        if head:
            table = head[1]
            if line.startswith("[["):
                count[table] = count.get(table, -1) + 1
                table = f"{table}.{count[table]}"
        key, _, value = line.partition(" = ")
        full = f"{table}.{key}"
        own = comments.get(full) or comments.get(re.sub(r"quadrotors\.\d+", "quadrotors.*", full))
        lines.append(f"{line}  # {', '.join(own)}" if own and value and full not in refused else line)
    return "# Identified from logs; behind each identified key: half its interval of 95 %.\n" + "\n".join(lines) + "\n"


def with_values(mission: Mission, values: Mapping[str, list[float]]) -> tuple[Mission, dict[str, str]]:
    """The mission with identified values by key; the keys whose values no mission may have, and why.

    Those of the payload are set together, as moments and products of inertia must suit each other.
    """
    template, groups = MissionTemplate.of(mission), dict[str, dict[str, object]]()
    for key, own in values.items():
        group = groups.setdefault("payload" if key.startswith("vehicle.payload.") else key, {})
        group[key] = own if len(own) > 1 else own[0]
    known, failed = dict[str, object](), dict[str, str]()
    for group in groups.values():
        try:
            mission = template.mission(known | group)
            known |= group
        except InputError as error:
            failed |= dict.fromkeys(group, str(error))
    return mission, failed


def rows_of(
    keys: Mapping[str, tuple[Array, Array, str, Array]],
    covariance: Array,
    bound: Array,
    prior: Array,
    offsets: Mapping[str, float] = MappingProxyType({}),
) -> Iterator[Row]:
    """Rows by the delta method.

    Args:
        keys: of each key its values (n,), their derivatives by the coordinates (n, P), unit, values in the mission.
        covariance: of the coordinates (P, P).
        bound: the same by the Cramér-Rao bound.
        prior: the same by the priors.
        offsets: of a key, by how much it may be off whatever the data say.
    """
    for key, (values, J, unit, start) in keys.items():
        for i, value in enumerate(values):
            own, least, wide = (float(J[i] @ C @ J[i]) for C in (covariance, bound, prior))
            name = f"{key}.{'xyz'[i]}" if len(values) > 1 else key
            half = NORMAL * np.sqrt(own)
            low, high = (
                value * np.exp(s * half / value) if value > 3.0 * half else value + s * half for s in (-1.0, 1.0)
            )
            yield Row(
                name,
                float(value),
                float(low) - offsets.get(key, 0.0),
                float(high) + offsets.get(key, 0.0),
                unit,
                float(start[i]),
                bool(own < 0.25 * wide),
                float(least / own) if own > 0.0 else 1.0,
            )
