"""The tables of checks before a flight."""

from __future__ import annotations

from collections.abc import Iterable

from reference_tables.markdown import table
from tandemlift.analysis.certification.mission_check import LOOP_CHECKS
from tandemlift.missions.flight_checks import CHECKS, FlightCheck


def checks_at_load() -> str:
    """The checks that are closed forms."""
    return _table(CHECKS)


def loop_checks() -> str:
    """The checks that need the linear model."""
    return _table(LOOP_CHECKS)


def _table(checks: Iterable[FlightCheck]) -> str:
    rows = []
    for check in checks:
        unit = "" if check.unit == "1" else f" [{check.unit}]"
        applies = f"with {check.applies}: " if check.applies else ""
        rows.append((f"`{check.name}`", f"{check.value}{unit}", check.limit, f"{applies}{check.keys}"))
    return table(("check", "value", "limit", "keys"), rows)
