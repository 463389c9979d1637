"""docs/reference/checks.md has every check as the code says it."""

from repository import ROOT

from tandemlift.linearization.mission_check import LOOP_CHECKS
from tandemlift.missions.flight_checks.table import CHECKS

TEXT = (ROOT / "docs" / "reference" / "checks.md").read_text("utf-8")


def rows(columns):
    lines = [line.strip("|").split("|") for line in TEXT.splitlines() if line.startswith("| `")]
    return [tuple(cell.strip() for cell in line) for line in lines if len(line) == columns]


def test_the_table_of_checks_at_load_is_that_of_the_code():
    assert rows(6) == [(f"`{c.name}`", c.value, c.limit, c.unit, c.applies or "always", c.keys) for c in CHECKS]


def test_the_table_of_checks_of_the_loops_is_that_of_the_code():
    assert rows(5) == [(f"`{c.name}`", c.value, c.limit, c.unit, c.keys) for c in LOOP_CHECKS]
