"""docs/reference/outcomes.md names every outcome and every reason to stop a flight."""

from repository import ROOT

from tandemlift.common.outcomes import ENDINGS, OUTCOMES

TEXT = (ROOT / "docs" / "reference" / "outcomes.md").read_text("utf-8")


def rows(columns):
    lines = [line.strip("|").split("|") for line in TEXT.splitlines() if line.startswith("|")]
    return [tuple(cell.strip() for cell in line) for line in lines if len(line) == columns and "---" not in line[0]]


def test_the_table_of_outcomes_is_that_of_the_code():
    assert rows(3)[1:] == [(f"`{o.name}`", o.meaning, "3" if o.failed else "0") for o in OUTCOMES]


def test_the_table_of_endings_is_that_of_the_code():
    assert rows(2)[1:] == [(f"{e.outcome}: {e.quantity}", e.condition) for e in ENDINGS]
