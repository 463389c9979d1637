"""What a newcomer reads first is short: the README, the front page and the pages of Start."""

import re

from repository import ROOT

FIRST_PAGES = [ROOT / "docs" / "index.md", *(ROOT / "docs" / "start").glob("*.md")]
CODE = re.compile(r"^```.*?^```", re.S | re.M)


def words(path):
    """The number of words outside of code."""
    return len(CODE.sub("", path.read_text("utf-8")).split())


def test_the_first_pages_together_are_read_in_five_minutes():
    assert sum(map(words, FIRST_PAGES)) <= 1000


def test_the_readme_fills_two_screens():
    assert len((ROOT / "README.md").read_text("utf-8").splitlines()) <= 82


def test_the_first_pages_show_no_html_as_text_where_their_source_is_read():
    raw = re.compile(r"\{raw\}|<(?:iframe|video|div|a|img)\b")
    assert {path.name: found for path in FIRST_PAGES if (found := raw.findall(path.read_text("utf-8")))} == {}
