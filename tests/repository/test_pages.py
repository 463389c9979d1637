"""What a newcomer reads first is short: the README, the front page and the pages of Start."""

import ast
import re

import numpy as np
from repository import ROOT

import tandemlift as tl

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


def test_the_vehicle_of_the_home_page_hovers_from_the_start_so_that_it_can_be_pulled_at_once():
    source = (ROOT / "docs" / "_extensions" / "live_page.py").read_text("utf-8")
    (start,) = re.findall(r"^IN_THE_AIR = (\{.*\})", source, re.M)
    flight = tl.fly(tl.load_mission("hover", ast.literal_eval(start) | {"mission.duration": 3.0}))
    assert np.abs(flight["position"] - [0.0, 0.0, 1.0]).max() < 2e-3
