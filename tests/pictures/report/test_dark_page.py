"""On a dark page the figures are dark, too: drawings are inverted with their hues kept."""

import re

import pytest
from colour_contrast import contrast, inverted, on_screen

from tandemlift.pictures.drawing.figure import IEEE, figure_style
from tandemlift.pictures.figures.registry import captions
from tandemlift.pictures.report.page import TEMPLATES, shown_figure

STYLE = (TEMPLATES / "style.css").read_text("utf-8")

DARK = re.search(r"prefers-color-scheme: dark\) \{ :root \{(.*?)\} \}", STYLE, re.DOTALL)[1]
VALUES = dict(re.findall(r"--(\w+): ([^;]+);", DARK))
DOT = b"\x89PNG\r\n\x1a\n" + bytes(8) + (1).to_bytes(4, "big") * 2


def shown(colour):
    """A colour of a drawing on a dark page."""
    return on_screen(inverted(colour), VALUES["sheet"])


def test_the_page_inverts_as_it_is_assumed_here():
    assert (VALUES["drawn"], VALUES["laid"]) == ("invert(1) hue-rotate(180deg)", "screen")
    assert shown(IEEE.palette.paper) == pytest.approx(shown("#ffffff"))
    assert contrast(shown("#ffffff"), VALUES["sheet"]) == pytest.approx(1.0, abs=1e-6), "paper is the sheet"


@pytest.mark.parametrize("name", ["ink", "blue", "vermillion", "green", "grey", "dim"])
def test_lines_and_text_stand_out_from_the_dark_sheet(name):
    colour = getattr(IEEE.palette, name)
    assert contrast(shown(colour), VALUES["sheet"]) >= (4.5 if name != "grey" else 3.0)


@pytest.mark.parametrize(("name", "style", "turned"), [("path", "ieee", True), ("path", "dark", False)])
def test_only_drawings_on_white_are_inverted(name, style, turned, tmp_path):
    (tmp_path / "dot.png").write_bytes(DOT)
    with figure_style(style):
        assert ("drawn" in shown_figure(name, tmp_path / "dot.png", captions()[name]).look.split()) is turned
