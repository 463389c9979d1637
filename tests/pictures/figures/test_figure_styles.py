"""Figures in a style: as wide as a journal's columns, with its type in the file, in colours that stand out."""

import re
import struct
from itertools import combinations

import numpy as np
import pytest
from colour_contrast import contrast
from IPython.core.formatters import DisplayFormatter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from PIL import Image

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.pictures.drawing.figure import DARK, IEEE, current_style, figure_style
from tandemlift.pictures.drawing.scene import Scene3D
from tandemlift.pictures.drawing.style import save
from tandemlift.pictures.figures.registry import figures, save_figures

POINTS = {  # widths of columns and pages that the journals give, in PostScript points
    "ieee": {3.5 * 72, 7.16 * 72},
    "elsevier": {90 / 25.4 * 72, 140 / 25.4 * 72, 190 / 25.4 * 72},
    "slides": {160 / 25.4 * 72},
}
FONTS = {"ieee": "STIX", "elsevier": "STIX", "slides": "DejaVuSans"}
STRONG = ("ink", "blue", "vermillion", "green", "orange", "purple", "dim", "grey", "edge")


@pytest.fixture(scope="module")
def flight():
    return tl.fly(tl.load_mission("one-push", {"mission.duration": 6.0, "pushes.0.time": 3.0}))


def drawn(flight, name, style):
    with figure_style(style):
        return figures()[name].draw(flight)


@pytest.mark.parametrize(("name", "style"), [("interaction", "ieee"), ("path", "elsevier"), ("reference", "slides")])
def test_a_pdf_is_as_wide_as_the_journal_asks_and_has_its_fonts_in_it(flight, name, style, tmp_path):
    data = save(drawn(flight, name, style), tmp_path / "figure.pdf").read_bytes()
    (box,) = re.findall(rb"/MediaBox \[ ([\d. ]+) \]", data)
    left, bottom, width, height = map(float, box.split())
    assert (left, bottom) == (0.0, 0.0)
    assert any(width == pytest.approx(asked, abs=0.01) for asked in POINTS[style])
    if style == "slides":
        assert width / height == pytest.approx(16.0 / 9.0, rel=1e-4)
    named = re.findall(rb"/FontName /(?:[A-Z]{6}\+)?([\w-]+)", data)
    assert named
    assert all(font.decode().startswith(FONTS[style]) for font in named)
    assert data.count(b"/FontFile2") == data.count(b"/Type /FontDescriptor") > 0, "all embedded, as TrueType"
    assert b"/Subtype /Type3" not in data
    assert b"/Subtype /Image" not in data, "lines, not dots"


def test_a_slide_fills_a_screen_and_a_figure_with_many_rows_is_a_larger_slide(flight, tmp_path):
    few, many = drawn(flight, "interaction", "slides"), drawn(flight, "tracking", "slides")
    assert many.get_figwidth() > few.get_figwidth() == pytest.approx(160.0 / 25.4)
    assert many.get_figwidth() / many.get_figheight() == pytest.approx(16.0 / 9.0)
    assert many.style.dots(many.get_figwidth()) * many.get_figwidth() == pytest.approx(1920.0)
    data = save(few, tmp_path / "slide.png").read_bytes()
    assert struct.unpack(">II", data[16:24]) == (1920, 1080)


def test_a_notebook_shows_a_figure_with_the_dots_of_a_file_and_as_large_as_in_print(flight, tmp_path):
    figure = drawn(flight, "interaction", "ieee")
    shown, look = DisplayFormatter().format(figure)
    assert shown["image/png"] == save(figure, tmp_path / "figure.png").read_bytes()
    assert look["image/png"]["width"] == 336  # pixels of a page, 96 in each of 3.5 inches


def test_the_dark_style_is_drawn_on_dark_paper_and_nothing_is_black_or_white(flight, tmp_path):
    path = save(drawn(flight, "path", "dark"), tmp_path / "dark.png")
    with Image.open(path) as image:
        dots = np.asarray(image.convert("RGB")).reshape(-1, 3)
    paper = np.round(255.0 * np.array(to_rgb(DARK.paper)))
    assert (dots[0] == paper).all()
    assert np.mean(np.abs(dots - paper).max(axis=1) < 40) > 0.8
    assert dots.min() >= paper.min()
    assert dots.min(axis=1).max() < 245, "no white"


@pytest.mark.parametrize("style", ["ieee", "dark"])
@pytest.mark.parametrize(
    "size", [(0.7, 2.7, 1.8), (0.9, 0.9, 0.9), (3.0, 0.8, 0.9), (40.0, 90.0, 3.0), (6.0, 6.0, 45.0)]
)
def test_numbers_on_the_edges_of_a_scene_do_not_overlap(style, size):
    with figure_style(style):
        figure = Scene3D(np.array([-np.array(size) / 2.0, np.array(size) / 2.0])).figure
    renderer = FigureCanvasAgg(figure).get_renderer()
    numbers = [text for text in figure.axes[0].texts if re.fullmatch(r"[−\d.]+", text.get_text())]
    boxes = [text.get_window_extent(renderer) for text in numbers]
    assert len(boxes) >= 6
    close = [
        (a.get_text(), b.get_text())
        for (a, p), (b, q) in combinations(zip(numbers, boxes, strict=True), 2)
        if p.overlaps(q)
    ]
    assert close == []


@pytest.mark.parametrize("palette", [IEEE.palette, DARK], ids=["light", "dark"])
def test_lines_and_text_stand_out_from_the_paper(palette):
    assert contrast(palette.ink, palette.paper) >= 7.0
    text = ("blue", "vermillion")  # of axes and of pushes
    assert min(contrast(getattr(palette, name), palette.paper) for name in text) >= 3.8
    strong = STRONG if palette is DARK else [name for name in STRONG if name not in ("orange", "purple")]
    assert {name for name in strong if contrast(getattr(palette, name), palette.paper) < 3.0} == set()
    assert contrast(palette.ink, palette.pale) >= 4.5, "what is written or drawn on a shaded area"


def test_a_style_holds_as_long_as_its_context_and_what_was_drawn_keeps_it(flight, tmp_path):
    with figure_style("elsevier"), figure_style(None):
        assert current_style().name == "elsevier"
        figure = figures()["interaction"].draw(flight)
    assert current_style() is IEEE
    late = save(figure, tmp_path / "late.pdf").read_bytes()
    assert b"/MediaBox [ 0 0 255.118" in late, "90 mm"


def test_a_style_that_is_none_is_refused_before_anything_is_drawn(flight, tmp_path):
    with pytest.raises(InputError, match=r"style of figures 'elsevir'; there are ieee, .*\. Did you mean 'elsevier'"):
        save_figures(flight, tmp_path / "new", style="elsevir")
    assert list(tmp_path.iterdir()) == []
