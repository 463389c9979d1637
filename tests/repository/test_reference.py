"""The reference is complete: every table of it is made and filled, and every public name has an entry."""

import importlib
import re

import pytest
from for_all import for_all
from reference_tables.settings import tables, value_types
from repository import ROOT

PAGES = ROOT / "docs" / "reference"
TEXTS = {path: path.read_text("utf-8") for path in sorted(PAGES.rglob("*.md"))}
MADE = [name for text in TEXTS.values() for name in re.findall(r"^```{generated} (\S+)$", text, flags=re.M)]
MAY_BE_EMPTY = {  # columns: what has none says so by an empty cell
    "unit",
    "frame",
    "keys",
    "other keys",
    "components",
    "parent",
    "range",
    "channels",
}


def rows(markdown):
    """The rows of all tables, as lists of (column, cell)."""
    head = None
    for line in markdown.splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if not cells:
            head = None
        elif head is None:
            head = cells
        elif set(line) - set("|- "):
            yield list(zip(head, cells, strict=True))


@for_all(MADE)
def test_every_table_is_made_and_says_all_that_it_should(name):
    module, _, function = name.rpartition(".")
    found = list(rows(getattr(importlib.import_module(module), function)()))
    assert found
    for row in found:
        empty = {column for column, cell in row if not cell}
        assert empty <= MAY_BE_EMPTY, row


@pytest.mark.parametrize("module", ["", ".parts.controllers", ".core.algebra", ".core.keys"])
def test_every_public_name_has_an_entry(module):
    text = "".join(text for path, text in TEXTS.items() if path.parent.name == "api")
    text += tables() + value_types()
    entries = re.findall(r"^\.\. \w+:: (?:tandemlift\.)?(?:\w+\.)*(\w+)$", text, flags=re.M)
    entries += re.findall(r"^\| `(\w+)` \|", text, flags=re.M)
    names = importlib.import_module(f"tandemlift{module}").__all__
    assert [name for name in names if name not in entries] == []


def test_every_page_is_in_the_contents_of_the_reference():
    index = TEXTS[PAGES / "index.md"]
    pages = [path.stem for path in TEXTS if path.parent == PAGES and path.stem != "index"]
    assert [page for page in pages if f"({page}.md)" not in index or f"\n{page}\n" not in index] == []
