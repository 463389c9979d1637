"""The values of a key on a grid: a list, or evenly spaced between two ends."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from tandemlift.analysis.studies.design.keys import by_key, key_at, leaves_of, validated
from tandemlift.core.errors import InputError, shown
from tandemlift.core.keys import Table, key, must
from tandemlift.missions import Place, Tables

MOST_VALUES = 1_000_000  # of one key


class Range(Table):
    """Evenly spaced values of a key."""

    low: float = key(..., None, "first value")
    high: float = key(..., None, "last value")
    count: Annotated[int, Field(ge=2, le=MOST_VALUES)] = key(..., "1", "number of values, ends included")
    spacing: Literal["linear", "log"] = key("linear", None, "equal differences, or equal ratios")

    @model_validator(mode="after")
    def _in_order(self) -> Range:
        if self.low >= self.high:
            raise must("range", f"have low = {self.low:g} below high = {self.high:g}")
        if self.spacing == "log" and self.low <= 0.0:
            raise must("range", f"have low above 0 for spacing = 'log', not {self.low:g}")
        return self

    @property
    def values(self) -> list[float]:
        """The values, ends exact."""
        if self.spacing == "linear":
            return np.linspace(self.low, self.high, self.count).tolist()
        inner = np.exp(np.linspace(np.log(self.low), np.log(self.high), self.count)).tolist()[1:-1]
        return [self.low, *inner, self.high]


def grid_axes(tables: Tables) -> dict[str, list[Any]]:
    """The values of each key of `[grid]`.

    Raises:
        InputError: an entry is neither a list of different values nor a range.
    """
    leaves = leaves_of(tables.get("grid", {}), lambda table: "count" in table or "low" in table)
    return by_key(((place, _axis(tables, place, given)) for place, given in leaves), "grid")


def _axis(tables: Tables, place: Place, given: object) -> list[Any]:
    where = f"grid.{key_at(place)}"
    if isinstance(given, dict) and given:
        return validated(Range, given, tables, ("grid", *place)).values
    if not isinstance(given, list) or not given:
        allowed = "a list of at least one value, or a table such as {low = 1.0, high = 8.0, count = 8}"
        raise InputError(f"{where} = {shown(given)}: must be {allowed}")
    if any(value in given[:i] for i, value in enumerate(given)):
        raise InputError(f"{where} = {shown(given)}: must be without repetition")
    return given
