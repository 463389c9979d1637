"""The report: one file that needs nothing else, says what the metrics say, and trusts no text."""

import dataclasses
import errno
import html
import math
import re
import tomllib

import markupsafe
import numpy as np
import pytest
from html_page import check_page
from PIL import Image

import tandemlift as tl
from tandemlift.core.findings import Finding
from tandemlift.flight.record import Ending, Flight
from tandemlift.missions import tables_of
from tandemlift.pictures.figures.registry import captions, figures_for
from tandemlift.pictures.report.flight_report import write_flight_files, write_report
from tandemlift.pictures.report.page import number, split_unit

HOSTILE = "<script>alert('x')</script>\"&<img src=http://evil.example/x.png>"


@pytest.fixture(scope="module")
def paper():
    return tl.fly(tl.load_mission("paper"))


@pytest.fixture(scope="module")
def windy():
    """A mission with sensors, real rotors, a fault, wind and floor, as if it had been flown."""
    changes = {
        "wind.model": "air",
        "wind.velocity": [2.0, -1.0, 0.0],
        "wind.turbulence": 6.0,
        "plant.mass_scale": 3.8 / 3.5,
        "estimator.tare": "hover",
        "faults": [{"quadrotor": 2, "rotor": 3, "time": 15.0, "efficiency": 0.25, "known_after": 0.05}],
        "walls": [{"start": [0.0, 3.0], "end": [9.0, 3.0]}],
    }
    mission = tables_of(tl.load_mission("iris", changes))
    return Flight(np.zeros(0), {}, mission, {}, version={"tandemlift": "1", "engine": "mujoco"})


@pytest.fixture(scope="module")
def figures(paper, tmp_path_factory):
    """Blank pictures of the size of the flight's figures, and one of a figure that only an earlier flight had."""
    folder = tmp_path_factory.mktemp("figures")
    for name in (*figures_for(paper), "push"):
        Image.new("RGB", (2100, 1200)).save(folder / f"{name}.png")
    return folder


@pytest.fixture(scope="module")
def page(paper, figures, tmp_path_factory):
    return check_page(write_report(paper, figures, tmp_path_factory.mktemp("report") / "report.html"))


@pytest.fixture
def write(tmp_path):
    return lambda flight, figures=(): check_page(write_report(flight, figures, tmp_path / "report.html"))


def value_of(text):
    """The number in a cell, as it was printed."""
    text = text.split("\n")[0].replace("−", "-").replace("\u202f", "")
    return float(text.replace(" × 10", "e").translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")))


def test_the_report_needs_nothing_but_itself(page):
    outside = [(tag, k, v) for tag, a in page.elements for k, v in a.items() if k in ("src", "href", "srcset", "data")]
    assert all(value.startswith("data:image/png;base64,") for _, _, value in outside)
    assert not re.search(r"https?:|@import|url\(|<script|<link|<iframe", page.text, re.IGNORECASE)


def test_the_page_says_its_language_its_title_and_fits_a_phone(page):
    assert page.all("html") == [{"lang": "en"}]
    assert "<title>paper: flight report</title>" in page.text
    assert {"name": "viewport", "content": "width=device-width, initial-scale=1"} in page.all("meta")


def test_every_figure_is_there_with_its_size_a_description_and_a_caption(page, paper):
    images, names = page.all("img"), list(figures_for(paper))
    assert [figure["id"] for figure in page.all("figure")] == names
    assert [image["alt"] for image in images] == [captions()[name].alt for name in names]
    assert {(image["width"], image["height"]) for image in images} == {("945", "540")}
    for name in names:
        assert html.escape(captions()[name].text) in page.text


def test_the_engine_is_told_at_the_top(page, windy, paper, write):
    head = page.text.partition("</header>")[0]
    assert "Flown in engine <b>compiled</b>" in head
    assert "Flown in engine <b>mujoco</b>" in write(windy).text
    assert "<b>" not in write(dataclasses.replace(paper, version={})).text.partition("</header>")[0]


def test_the_set_up_is_told_with_the_mission_s_numbers(windy, write):
    told = dict(row for row in write(windy).rows if len(row) == 2)
    sensors = windy.mission["sensors"]
    pieces = {
        "Vehicle": ["2 quadrotors", "0.5 kg", "3.5 kg"],
        "Unknown to the pilot": ["3.8 kg"],
        "Pilot": ["nftsmc", "estimated state", "measured push"],
        "Guidance": ["by hand", "m/s³", "turns with a push"],
        "Disturbance": ["super-twisting"],
        "Rotors": ["0 to 7.066 N", "12.5 ms up", "25 ms down", "10 ms late", "stopped", "constrained"],
        "Fault": ["rotor 3 of quadrotor 2", "25 % of the thrust left from 15 s", "0.05 s later"],
        "Joint forces": [f"noise {sensors['joints']['force_noise']:g} N", f"±{sensors['joints']['force_range']:g} N"],
        "Accelerometer": [f"bias {sensors['accelerometer']['bias']:g} m/s²"],
        "Motion": [f"every {1e3 * sensors['motion']['interval']:g} ms"],
        "Estimate of the push": ["; tare in steady hover, for 3 s"],
        "Wind": ["mean (2, −1, 0) m/s", "turbulence of 6 m/s"],
        "Floor": ["at z = −", "friction 0.8"],
        "Walls": ["1"],
    }
    assert {what: [p for p in parts if p not in told[what]] for what, parts in pieces.items()} == {
        what: [] for what in pieces
    }


def test_the_set_up_of_a_flight_without_parts_says_so_and_an_older_mission_has_one_as_well(page, paper, write):
    told = dict(row for row in page.rows if len(row) == 2)
    assert told["Guidance"].startswith("scheduled")
    assert told["Disturbance"] == "not estimated"
    assert "Supervision" not in told
    assert told["Rotors"].startswith("ideal")
    assert told["Sensors"].startswith("none")
    assert (told["Wind"], told["Floor"]) == ("none", "none")
    assert not {"Fault", "Walls", "Unknown to the pilot"} & set(told)
    newer = ("sensors", "wind", "ground", "walls", "faults", "pilot", "estimator")
    older = {name: table for name, table in paper.mission.items() if name not in newer}
    assert dict(row for row in write(dataclasses.replace(paper, mission=older)).rows if len(row) == 2) == told


def test_a_run_removes_the_figures_that_its_flight_does_not_have(paper, tmp_path):
    for name in ("push.png", "rotors.pdf", "mine.png"):
        (tmp_path / "figures").mkdir(exist_ok=True)
        (tmp_path / "figures" / name).write_text("old")
    write_flight_files(paper, tmp_path, figures=False)
    assert [path.name for path in (tmp_path / "figures").iterdir()] == ["mine.png"]


def test_on_a_full_disk_the_files_of_an_earlier_flight_stay_together(paper, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    write_flight_files(paper, tmp_path, figures=False)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    monkeypatch.setattr(Flight, "save", full)
    other = dataclasses.replace(paper, mission=paper.mission | {"mission": {"name": "other"}})
    with pytest.raises(tl.InputError, match=f"{tmp_path}: the flight cannot be written: No space left on device"):
        write_flight_files(other, tmp_path, figures=False)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_every_metric_is_in_the_table_with_its_value_and_unit(page, paper):
    rows = {row[0].split("\n")[1]: row for row in page.rows if len(row) > 2 and "\n" in row[0]}
    metrics = paper.metrics()
    assert metrics.pop("events") == []  # in a list of their own
    assert metrics.pop("outcome") == "landed"  # the verdict
    assert metrics.pop("findings") == []  # a list of their own
    assert metrics.pop("failure") == ""
    assert list(rows) == list(metrics)
    assert metrics.pop("push_triggers_after_10s") is None  # the guidance is scheduled
    assert rows["push_triggers_after_10s"][1] == "–"
    for name, value in metrics.items():
        if name == "command_at_start":
            continue
        *cells, unit = rows[name][1:]
        values = value if isinstance(value, list) else [value]
        assert [value_of(cell) for cell in cells] == pytest.approx(values, rel=5.1e-3)  # three digits at least
        assert unit == split_unit(name)[1]


def test_events_are_told_a_line_each_and_only_where_there_are_any(page, paper, write):
    assert "Phases and alarms" not in page.text
    events = [[1.0, "lift"], [12.5, "a < b -> hold"]]
    told = write(dataclasses.replace(paper, results=paper.results | {"events": events})).text
    assert "<li>1.00 s: lift</li><li>12.50 s: a &lt; b -&gt; hold</li>" in told


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
    assert re.search(r"<strong>Landed</strong> at \(10\.9\d\d, −0\.0\d\d, 0\.000\) m, less than a micromet", page.text)
    ends = {"final_position_m": [1.0, 2.0, 2.0], "final_reference_m": [1.003, 2.004, 2.0]}
    moved = write(dataclasses.replace(paper, results=paper.results | ends))
    assert "at (1.000, 2.000, 2.000) m, 5.000 mm from its reference (1.003, 2.004, 2.000) m" in moved.text


def test_a_divergence_names_quantity_time_and_limit_and_missing_metrics_are_dashes(paper, write):
    ending = Ending("distance from the origin [m]", 31.231, 1000.02, "must stay below 1000 m")
    results = paper.results | {"final_reference_m": None, "position_rmse_after_10s_m": None}
    page = write(dataclasses.replace(paper, ending=ending, results=results))
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


def test_text_from_outside_is_only_text(paper, write):
    mission = paper.mission | {"mission": paper.mission["mission"] | {"name": HOSTILE}}
    page = write(
        dataclasses.replace(
            paper,
            mission=mission,
            results=paper.results | {HOSTILE: HOSTILE, f"{HOSTILE}_m": [HOSTILE, None, float("nan")]},
            version={HOSTILE: HOSTILE},
            ending=Ending(HOSTILE, 1.0, 2.0, HOSTILE),
        )
    )
    assert page.all("script") == page.all("img") == []
    assert HOSTILE not in page.text
    assert str(markupsafe.escape(HOSTILE)) in page.text


def test_figures_may_be_given_as_files_and_a_report_without_them_is_whole(paper, figures, tmp_path, write):
    page = write(paper, [figures / "inputs.pdf", figures / "path.png", figures / "reference.png"])
    assert [figure["id"] for figure in page.all("figure")] == ["reference", "path"]
    bare = write(paper, tmp_path / "nowhere")
    assert bare.all("figure") == []
    assert bare.all("h2") == [{}, {}, {}, {}]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (0.0, "0"),
        (90_000, "90\u202f000"),
        (-1066.27, "−1066"),
        (3.204e-6, "3.20 × 10⁻⁶"),
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
        ("moment_max_abs_after_10s_n_m", "Commanded moment max abs after 10 s", "N m"),
        ("rotor_saturated_share", "Rotor saturated share", ""),
        ("thrust_max_after_10s_n", "Commanded thrust max after 10 s", "N"),
        ("attitude_rmse_rad.0", "Attitude RMSE, roll", "rad"),
        ("command_at_start.0", "Command at start, U1", "N"),
        ("command_at_start.3", "Command at start, U4", "N m"),
    ],
)
def test_units_are_split_from_names(name, words, unit):
    assert split_unit(name) == (words, unit)


def test_findings_are_told_under_the_verdict_with_place_and_what_to_do(page, paper, write):
    assert "No findings." in page.text
    text = "tilted by 34° (promised: 29°)"
    found = Finding("off-track", 1.0, 0.5, (1.0, -2.0, 0.5), "tilt", 0.6, "rad", 0.5, text)
    told = write(dataclasses.replace(paper, findings=(found,))).text
    assert f"<strong>off-track</strong> at 1.00 s, at (1.000, −2.000, 0.500) m: {text}." in told
    assert "What to do: change what disturbs it" in told
    older = dataclasses.replace(paper, results={k: v for k, v in paper.results.items() if k != "findings"})
    assert "No findings." not in write(older).text  # it was never searched for any
