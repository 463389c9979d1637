"""The report: one file that needs nothing else, says what the metrics say, and trusts no text."""

import dataclasses
import html
import math
import re
import shutil
import subprocess
import tomllib
from html.parser import HTMLParser

import pytest

import tandemlift as tl
from tandemlift.figures import FIGURES, save_figures
from tandemlift.figures.captions import CAPTIONS
from tandemlift.flight import Divergence
from tandemlift.report import number, split_unit, write_report

HOSTILE = "<script>alert('x')</script>\"&<img src=http://evil.example/x.png>"
VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """A parsed page: its elements with their attributes, the rows of its tables, and whether every tag is closed."""

    def __init__(self, path):
        super().__init__()
        self.elements, self.rows, self.open = [], [], []
        self.text = path.read_text("utf-8")
        self.feed(self.text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        if tag == "sup":
            self.rows[-1][-1] += "^"
        if tag == "br" and self.rows:
            self.rows[-1][-1] += "\n"
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if {"td", "th"} & set(self.open):
            self.rows[-1][-1] += data

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture(scope="module")
def paper():
    return tl.fly(tl.load_mission("paper"))


@pytest.fixture(scope="module")
def figures(paper, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    save_figures(paper, folder)
    return folder


@pytest.fixture(scope="module")
def report(paper, figures, tmp_path_factory):
    return write_report(paper, figures, tmp_path_factory.mktemp("report") / "report.html")


@pytest.fixture(scope="module")
def page(report):
    return Page(report)


@pytest.fixture
def write(tmp_path):
    return lambda flight, figures=(): Page(write_report(flight, figures, tmp_path / "report.html"))


def value_of(text):
    """The number in a cell, as it was printed."""
    text = text.split("\n")[0].replace("−", "-").replace("\u202f", "")
    return float(text.replace(" × 10^", "e"))


def test_the_report_needs_nothing_but_itself(page, report):
    outside = [(tag, k, v) for tag, a in page.elements for k, v in a.items() if k in ("src", "href", "srcset", "data")]
    assert all(value.startswith("data:image/png;base64,") for _, _, value in outside)
    assert not re.search(r"https?:|@import|url\(|<script|<link|<iframe", page.text, re.IGNORECASE)
    assert report.stat().st_size < 3_000_000


def test_the_page_says_its_language_its_title_and_fits_a_phone(page):
    assert page.all("html") == [{"lang": "en"}]
    assert "<title>paper: flight report</title>" in page.text
    assert {"name": "viewport", "content": "width=device-width, initial-scale=1"} in page.all("meta")


def test_every_figure_is_there_with_its_size_a_description_and_a_caption(page):
    images = page.all("img")
    assert [figure["id"] for figure in page.all("figure")] == list(FIGURES)
    assert [image["alt"] for image in images] == [caption.alt for caption in CAPTIONS.values()]
    assert all(300 < int(image["width"]) < 1100 and 200 < int(image["height"]) < 1100 for image in images)
    for caption in CAPTIONS.values():
        assert html.escape(caption.text) in page.text


def test_every_metric_is_in_the_table_with_its_value_and_unit(page, paper):
    rows = {row[0].split("\n")[1]: row for row in page.rows[1:]}
    assert list(rows) == list(paper.metrics())
    for name, value in paper.metrics().items():
        if name == "command_at_start":
            continue
        *cells, unit = rows[name][1:]
        values = value if isinstance(value, list) else [value]
        assert [value_of(cell) for cell in cells] == pytest.approx(values, rel=5.1e-3)  # three digits at least
        assert unit == split_unit(name)[1]


def test_angles_are_also_given_in_degrees(page, paper):
    (row,) = (row for row in page.rows if "attitude_rmse_rad" in row[0])
    degrees = [value_of(cell.split("\n")[1].rstrip("°")) for cell in row[1:4]]
    assert degrees == pytest.approx([math.degrees(v) for v in paper.metrics()["attitude_rmse_rad"]], rel=1e-3)


def test_the_command_at_the_start_is_named_input_by_input(page, paper):
    (row,) = (row for row in page.rows if "command_at_start" in row[0])
    printed = re.findall(r"U(.) = (\S+) (N m|N)", row[1].replace("\u00a0", " "))
    assert [(i, unit) for i, _, unit in printed] == [("₁", "N"), ("₂", "N m"), ("₃", "N m"), ("₄", "N m")]
    assert [value_of(v) for _, v, _ in printed] == pytest.approx(paper.metrics()["command_at_start"], rel=1e-3)


def test_an_arrival_is_given_against_its_reference(page, paper, write):
    assert re.search(r"<strong>Arrived</strong> at \(10\.9\d\d, −0\.0\d\d, 0\.000\) m, less than a micromet", page.text)
    ends = {"final_position_m": [1.0, 2.0, 2.0], "final_reference_m": [1.003, 2.004, 2.0]}
    moved = write(dataclasses.replace(paper, results=paper.results | ends))
    assert "at (1.000, 2.000, 2.000) m, 5.000 mm from its reference (1.003, 2.004, 2.000) m" in moved.text


def test_a_flight_that_ends_far_from_its_reference_has_not_arrived(paper, write):
    ends = {"final_position_m": [0.0, -16.0, 1.0], "final_reference_m": [0.0, 0.0, 1.0]}
    text = write(dataclasses.replace(paper, results=paper.results | ends)).text
    assert "Arrived" not in text
    assert "<strong>Ended</strong> at (0.000, −16.000, 1.000) m, 16.00 m from its reference" in text


def test_a_divergence_names_quantity_time_and_limit_and_missing_metrics_are_dashes(paper, write):
    divergence = Divergence("distance from the origin [m]", 31.231, 1000.02, "must stay below 1000 m")
    results = paper.results | {"final_reference_m": None, "position_rmse_after_10s_m": None}
    page = write(dataclasses.replace(paper, divergence=divergence, results=results))
    assert "<strong>Diverged at 31.231 s</strong>: distance from the origin [m] = 1000.02, must stay below" in page.text
    assert [row[1] for row in page.rows if "final_reference_m" in row[0]] == ["–"]
    assert [row[1] for row in page.rows if "position_rmse_after_10s_m" in row[0]] == ["–"]


def test_the_mission_can_be_taken_from_the_report(page, paper):
    (listing,) = re.findall(r"<details>.*?<code>(.*?)</code>", page.text, re.DOTALL)
    assert tomllib.loads(html.unescape(listing)) == paper.mission


def test_a_built_in_mission_is_flown_again_by_its_name_and_a_changed_one_from_its_file(page, paper, write):
    assert "<code>tandemlift run paper</code>" in page.text
    changed = paper.mission | {"mission": paper.mission["mission"] | {"duration": 89.0}}
    page = write(dataclasses.replace(paper, mission=changed))
    assert "tandemlift run paper" not in page.text
    assert "<code>tandemlift run mission.toml</code>" in page.text


def test_versions_are_named(page, paper):
    for name, version in paper.version.items():
        assert f"{name} {version}" in page.text


def test_text_from_outside_is_only_text(paper, write):
    mission = paper.mission | {"mission": paper.mission["mission"] | {"name": HOSTILE}}
    page = write(
        dataclasses.replace(
            paper,
            mission=mission,
            results=paper.results | {HOSTILE: HOSTILE, f"{HOSTILE}_m": [HOSTILE, None, float("nan")]},
            version={HOSTILE: HOSTILE},
            divergence=Divergence(HOSTILE, 1.0, 2.0, HOSTILE),
        )
    )
    assert page.all("script") == page.all("img") == []
    assert HOSTILE not in page.text
    assert html.escape(HOSTILE) in page.text


def test_a_report_without_figures_is_whole(paper, tmp_path, write):
    assert write(paper, tmp_path / "nowhere").all("figure") == []
    assert write(paper, []).all("h2") == [{}, {}, {}]


def test_figures_may_be_given_as_files(paper, figures, write):
    page = write(paper, [figures / "inputs.pdf", figures / "path.png", figures / "reference.png"])
    assert [figure["id"] for figure in page.all("figure")] == ["reference", "path"]


def test_a_failure_leaves_the_old_report(paper, tmp_path, monkeypatch):
    target = tmp_path / "report.html"
    target.write_text("old")
    monkeypatch.setattr(type(target), "replace", lambda *_: (_ for _ in ()).throw(OSError("disk full")))
    with pytest.raises(OSError, match="disk full"):
        write_report(paper, [], target)
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("report.html", "old")]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (0.0, "0"),
        (90_000, "90\u202f000"),
        (0.3, "0.3000"),
        (-1066.27, "−1066"),
        (12_345.6, "12\u202f346"),
        (3.204e-6, "3.20 × 10<sup>−6</sup>"),
        (-2.5e12, "−2.50 × 10<sup>12</sup>"),
        (float("inf"), "inf"),
        (True, "True"),
    ],
)
def test_numbers_are_printed_for_people(value, text):
    assert number(value) == text


@pytest.mark.parametrize(
    ("name", "words", "unit"),
    [
        ("position_rmse_after_10s_m", "Position RMSE after 10 s", "m"),
        ("velocity_max_error_after_10s_m_s", "Velocity max error after 10 s", "m/s"),
        ("moment_max_abs_after_10s_n_m", "Moment max abs after 10 s", "N m"),
        ("human_impulse_n_s", "Human impulse", "N s"),
        ("attitude_rmse_rad", "Attitude RMSE", "rad"),
        ("rotor_saturated_share", "Rotor saturated share", ""),
    ],
)
def test_units_are_split_from_names(name, words, unit):
    assert split_unit(name) == (words, unit)


def test_a_browser_without_a_network_shows_every_figure(report, tmp_path, program):
    browser = program("chromium")
    probe = "<script>onload = () => document.title = [...document.images].map(i => i.naturalWidth).join()</script>"
    copy = tmp_path / "report.html"
    copy.write_text(report.read_text("utf-8") + probe, "utf-8")
    quiet = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--dump-dom"]
    offline = ["--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={tmp_path / 'profile'}"]
    shown = subprocess.run([browser, *quiet, *offline, copy.as_uri()], capture_output=True, text=True, timeout=120)
    assert shown.returncode == 0, shown.stderr
    assert "<title>2148,2148,2148,2148,1050</title>" in shown.stdout
    shutil.rmtree(tmp_path / "profile", ignore_errors=True)
