"""Counts of a study's flights by outcome and by kind of finding."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

from tandemlift.core.findings import FINDING_NAMES
from tandemlift.core.phases import OUTCOMES


class Census:
    """Counts of flights: by outcome, by the kinds of findings that they have, and with any finding at all."""

    def __init__(self) -> None:
        self.outcomes, self.kinds, self.found = Counter[str](), Counter[str](), 0

    def add(self, flown: Iterable[Mapping[str, Any]]) -> None:
        """Count flights by their metrics."""
        for metrics in flown:
            kinds = {kind for _, kind, _ in metrics["findings"]}
            self.outcomes[metrics["outcome"]] += 1
            self.kinds.update(kinds)
            self.found += bool(kinds)

    def table(self) -> str:
        """The counts as a Markdown table; kinds that no flight has are left out."""
        rows = [(o.name, self.outcomes[o.name]) for o in OUTCOMES]
        rows += [("with findings", self.found)]
        rows += [(f"with finding: {name}", self.kinds[name]) for name in FINDING_NAMES if self.kinds[name]]
        return "\n".join(["| flights | number |", "|---|---|", *[f"| {what} | {count} |" for what, count in rows]])
