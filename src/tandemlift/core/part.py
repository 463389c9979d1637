"""Optional parts of a flight declare themselves: one `Part` beside the table and the laws of each.

Its functions name what they read by their arguments (`missions.facts`). So whoever goes over the parts knows none of
them; only the step does, for it is the equations.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from tandemlift.core.errors import CheckResult
from tandemlift.core.findings import Finding
from tandemlift.core.law import choice


class FlightCheck(NamedTuple):
    """A check: its name, value, limit and unit, the missions to which it applies, and the keys that change it."""

    name: str
    value: str
    limit: str
    unit: str
    applies: str
    keys: str


Checks = Callable[..., Iterable[CheckResult]]
Started = Callable[[str], tuple[dict[str, Any], dict[str, Any]]]
"""Parameters and memory of the parts within something before the first sample, by name; `Absent` of others."""


class Part(NamedTuple):
    """What an optional part declares.

    `name` of the fields for its parameters and memory, `within` the "pilot", its hand "guidance", its "compliance", the
    "estimators" or the "body"; the `key` of its table; where it `acts` (`core.keys.Table`), else it is `Absent`.
    `start` gives (parameters, memory) before the first sample, or parameters alone if it does not remember. `refusals`
    reject a mission, `checks` tell what may fly badly, `rows` say so in the reference. `channels`: their type;
    `logged`: the group of a sample that has those of `channels_of`. `findings` and `metrics` of a flight, for parts of
    pilot and guidance, may ask for the last parameters `k` and memory `m`. `calm`: whether a vehicle with it rests in
    hover; if it `begins` [s], until then.
    """

    name: str
    within: str
    key: str
    acts: str
    start: Callable[..., Any]
    remembers: bool = True
    refusals: Checks | None = None
    checks: Checks | None = None
    rows: tuple[FlightCheck, ...] = ()
    channels: type[tuple[Any, ...]] | None = None
    logged: str = ""
    findings: Callable[..., Iterator[Finding]] | None = None
    metrics: Callable[..., Mapping[str, Any]] | None = None
    calm: bool = True
    begins: Callable[..., float] | None = None


@choice(absent="k")
def channels_of(k: object, memory: Any, decision: Any) -> Any:
    """The channels of a part of the pilot, from its parameters, and the pilot's memory and decision."""
