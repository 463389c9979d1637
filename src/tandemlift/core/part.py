"""Optional parts of a flight declare themselves: one `Part` beside the table and the laws of each.

Its functions name what they read: each argument is a fact of the mission of that name (`missions.facts`). So whoever
goes over the parts knows none of them: the checks of a mission, the start of a flight, its channels, metrics and
findings. Only the step does: it is the equations, and names each part where it acts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from tandemlift.core.errors import CheckResult
from tandemlift.core.findings import Finding


class FlightCheck(NamedTuple):
    """A check: its name, value, limit and unit, the missions to which it applies, and the keys that change it."""

    name: str
    value: str
    limit: str
    unit: str
    applies: str
    keys: str


Checks = Callable[..., Iterable[CheckResult]]


class Part(NamedTuple):
    """What an optional part declares. Its functions may also ask for `table`, the value of its key.

    Attributes:
        name: of the field that holds its parameters, and of the one that holds its memory.
        within: whose fields: those of the "pilot", of hand "guidance", its "compliance", or the "estimators".
        key: of its table in a mission.
        acts: the condition of a mission that has it (`core.keys.Table`); a part without it is `Absent`.
        start: (parameters, memory) before the first sample.
        refusals: results that reject a mission.
        checks: results of a mission that may fly badly.
        rows: what the checks compare, for the reference.
        channels: the type of its channels.
        log: its channels, from parameters, memory and the pilot's decision, unless the law of what has it gives them.
        findings: of a flight; may also ask for its last parameters `k`, its memory `m` and the `last` state.
        metrics: of a flight, by name; asks for the same.
        metric_names: their names.
        calm: whether a vehicle with it can rest in hover.
        begins: the time [s] until which it can, at least.
    """

    name: str
    within: str
    key: str
    acts: str
    start: Callable[..., tuple[Any, Any]]
    refusals: Checks = lambda: ()
    checks: Checks = lambda: ()
    rows: tuple[FlightCheck, ...] = ()
    channels: type[tuple[Any, ...]] | None = None
    log: Callable[[Any, Any, Any], Any] | None = None
    findings: Callable[..., Iterator[Finding]] | None = None
    metrics: Callable[..., Mapping[str, Any]] | None = None
    metric_names: tuple[str, ...] = ()
    calm: bool = True
    begins: Callable[..., float] | None = None
