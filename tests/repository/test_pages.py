"""The pages of the site are short, and the introduction is, too."""

import re

import pytest
from repository import ROOT

PAGES = sorted((ROOT / "docs").rglob("*.md"))
MEASURED = re.compile(r"<!-- begin of what .*?<!-- end of what .*?-->", re.S)  # written by a command
CODE = re.compile(r"^```.*?^```", re.S | re.M)


def words(path):
    """The number of words that are written by hand, outside of code."""
    return len(CODE.sub("", MEASURED.sub("", path.read_text("utf-8"))).split())


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT / "docs").as_posix())
def test_a_page_is_read_in_ten_minutes(page):
    assert page.is_relative_to(ROOT / "docs" / "reference") or words(page) <= 2500


def test_the_readme_fills_two_screens():
    assert len((ROOT / "README.md").read_text("utf-8").splitlines()) <= 82
