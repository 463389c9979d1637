"""The tables of checks before a flight."""

from __future__ import annotations

from reference_tables.markdown import table
from tandemlift.linearization.mission_check import LOOP_CHECKS
from tandemlift.missions.flight_checks.table import CHECKS


def checks_at_load() -> str:
    """The checks that are closed forms."""
    rows = [(f"`{c.name}`", c.value, c.limit, c.unit, c.applies or "always", c.keys) for c in CHECKS]
    return table(("check", "value", "limit", "unit", "when", "keys"), rows)


def loop_checks() -> str:
    """The checks that need the linear model."""
    rows = [(f"`{c.name}`", c.value, c.limit, c.unit, c.keys) for c in LOOP_CHECKS]
    return table(("check", "value", "limit", "unit", "keys"), rows)
