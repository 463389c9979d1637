"""`tandemlift paper`: each figure and table of the paper has its place, with numbers of the mission and of flights."""

import json
import re
import sys
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from repository import ROOT

import tandemlift as tl
from tandemlift.apps.cli import report as command
from tandemlift.apps.cli.main import cli
from tandemlift.apps.export.csv_file import write_csv
from tandemlift.apps.export.results import read_curves
from tandemlift.missions import tables_of
from tandemlift.pictures.report import paper_report
from tandemlift.pictures.report.paper_claims import claims, gaussian_displacement
from tandemlift.pictures.report.paper_figures import DATA, curve_channels, errata, open_settings, write_drawing
from tandemlift.pictures.report.paper_report import PaperFlights, document, typeset
from tandemlift.pictures.report.paper_tables import agrees, nomenclature, paper_tables, value_at

SHORT = {"mission.duration": 16.0, "mission.log_interval": 0.05}
SLOW = ("reference", "tracking", "inputs", "interaction")  # have tests of their own; another stands for them
TABLES = ["I", "II", "III"]


def nested_tables(name, changes=None):
    """A mission as a flight has it."""
    return tables_of(tl.load_mission(name, changes or {}))


@pytest.fixture(scope="module")
def flights():
    """A short flight of `paper`, a short one among walls, and the same metrics for every choice."""
    paper = tl.fly(tl.load_mission("paper", SHORT))
    corridor = tl.fly(tl.load_mission("zigzag", SHORT))
    return PaperFlights(paper, corridor, [paper.metrics()] * len(open_settings()))


@pytest.fixture(scope="module")
def folder(flights, tmp_path_factory):
    """The report's files without its PDF, with a reader's curves: those of the flight, moved by 1 m along x."""
    out = tmp_path_factory.mktemp("paper") / "a.pdf"
    write_csv(replace(flights.paper, channels={**flights.paper.channels, "position": flights.paper["position"] + 1.0}),
              out.with_name("mine.csv"))  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "typst", None)
        patch.setattr(command, "fly_paper", lambda *_: flights)
        patch.setattr(
            paper_report, "write_drawing", lambda name, *to: write_drawing("path" if name in SLOW else name, *to)
        )
        given = ["paper", "--out", str(out), "--no-pdf", "--curves", str(out.with_name("mine.csv"))]
        result = CliRunner().invoke(cli, given)
    assert result.exit_code == 0, result.output
    assert "left out: attitude[1].w, " in result.output
    return out.with_name("a-files")


@pytest.fixture(scope="module")
def pdf(folder):
    """The report as PDF."""
    typeset(folder, folder / "paper.pdf")
    return folder / "paper.pdf"


def test_the_numbers_of_the_tables_are_those_of_the_mission():
    mission = nested_tables("paper")
    marks = {row.symbol: row.mark for table in paper_tables(mission) for row in table.rows if row.mark}
    assert marks == {"k_r": "unit", "K": "unit"}
    other = nested_tables("paper", {"vehicle.payload.mass": 0.6, "controller.gains.a": 2.0})
    changed = {row.symbol: row.ours for table in paper_tables(other) for row in table.rows if "value" in row.mark}
    assert changed["m_L"] == "0.6"
    assert changed["a"] == "2"
    assert set(changed) == {"m_L", "m_t", "a", "J_Lx, J_Ly, J_Lz", "J_tx, J_ty, J_tz"}


@pytest.mark.parametrize(("printed", "value", "same"), [("0.061286", 0.0612857, True), ("2.9125e-2", 0.02913, False)])
def test_a_number_agrees_if_it_rounds_to_the_printed_digits(printed, value, same):
    assert agrees(printed, value) is same


def test_every_name_in_the_nomenclature_is_there(flights):
    named = [name for row in nomenclature()["rows"] for name in re.split("[,;] ", row[2]) if " " not in name]
    assert named
    for name in named:
        file, _, function = name.partition("::")
        if function:
            source = (ROOT / "src" / "tandemlift" / file).read_text("utf-8")
            assert re.search(rf"(def |^|\n){function.rpartition('.')[2]}\b", source), name
        elif "." in name:
            assert value_at(flights.paper.mission, name) is not None
        else:
            assert len(flights.paper[name]) == len(flights.paper.time), name


def test_open_settings_are_what_the_mission_says_and_are_flown_otherwise():
    mission = nested_tables("paper")
    for setting in open_settings():
        other = nested_tables("paper", setting.changes)
        assert value_at(other, setting.key) != value_at(mission, setting.key)


def test_the_closed_form_of_a_push_is_the_impulse_that_passes_the_gate():
    push, admittance = {"force": [3.0, 0.0, 0.0], "sigma": 0.6}, {"threshold": [0.3] * 3, "damping": [1.6] * 3}
    t = np.linspace(-5.0, 5.0, 200_001)
    force = 3.0 * np.exp(-(t**2) / (2.0 * 0.6**2))
    passed = np.trapezoid(np.where(force > 0.3, force, 0.0), t) / 1.6
    assert gaussian_displacement(push, admittance, 0) == pytest.approx(passed, rel=1e-4)
    assert gaussian_displacement(push, admittance, 1) == 0.0


def test_the_numbers_in_the_diagrams_are_those_of_the_mission(flights):
    drawn = [DATA / "diagrams" / f"{name}.svg" for name in ("vehicle_sizes", "mass_damper_spring")]
    said = re.findall(r"<!-- (.*?) -->", "".join(file.read_text("utf-8") for file in drawn))  # each text that is drawn
    mission = flights.paper.mission
    payload, quadrotor = mission["vehicle"]["payload"], mission["vehicle"]["quadrotors"][0]
    beam = f"beam: {payload['mass']:g} kg, length {payload['length']:g} m, radius {payload['radius']:g} m"
    for text in (beam, f"quadrotor 1: {quadrotor['mass']:g} kg,"):
        assert text in said
    assert [text for text in said if f"= {mission['admittance']['damping'][0]:g} N s/m" in text]


def test_claims_are_numbers_of_the_flights_over_all_of_it_and_after_the_start(flights):
    found = {claim.says: claim for claim in claims(flights.paper, flights.corridor)}
    late = flights.paper.time >= 10.0
    error = 1e3 * np.abs(flights.paper["position_error"])
    tracked = found["Position errors go to zero and stay there for the whole mission."]
    for values, digits in ((error[late].max(axis=0), 2), (error.max(axis=0), 0)):
        assert ", ".join(f"{value:.{digits}f}" for value in values) in tracked.ours
    tilt = np.degrees(np.abs(flights.paper["euler"])).max(axis=0)[:2]
    small = found["The vehicle flies near hover, with small angles."]
    assert f"{tilt[0]:.1f}°, {tilt[1]:.1f}° over the flight" in small.ours
    assert found["Pushed through a zigzag corridor, the vehicle lands at its end."].verdict == "does not"  # it flies on
    assert found["It does so in ROS and Gazebo."].verdict == "not tested"


def test_every_claim_has_a_comparison_and_one_of_three_verdicts(flights):
    found = claims(flights.paper, flights.corridor)
    assert {claim.verdict for claim in found} == {"holds", "does not", "not tested"}
    assert all(claim.ours and claim.against for claim in found)


def test_workload_is_compared_with_the_payload_that_the_person_would_carry():
    """m g h to lift it, and m g over the time that it is up; the vehicle's weight is nobody's load."""
    paper = tl.fly("paper")
    found = {claim.says: claim for claim in claims(paper, tl.fly(tl.load_mission("zigzag", SHORT)))}
    work, held = (found[f"The person's workload is reduced, as {what}."] for what in ("work", "force over time"))
    height = paper["position"][:, 2].max() - paper["position"][0, 2]
    assert f"{0.5 * 9.81 * height:.1f} J" in work.against
    assert f"{paper.metrics()['human_work_j']:.1f} J" in work.ours
    assert (work.verdict, held.verdict) == ("does not", "holds")
    assert (
        "456, 334, 0 mm/s over the flight"
        in found["Velocity errors go to zero and stay there for the whole mission."].ours
    )
    iris = found["A vehicle of two IRIS quadrotors makes these inputs."]
    assert "1,066 N m of roll" in iris.ours
    assert "23.0 N m of roll and 1.33 N m of yaw" in iris.against


def test_of_a_flight_that_fails_no_claim_of_tracking_holds(flights):
    crashed = tl.fly(tl.load_mission("paper", {"actuators.model": "rotors"}))
    found = claims(crashed, flights.corridor)
    assert crashed.failure
    assert [claim.verdict for claim in found if claim.ours.lower().startswith(crashed.failure.lower())] == ["does not"]
    assert not [claim for claim in found if claim.where == "Figure 6"]


def test_what_a_flight_does_not_show_is_not_tested(flights):
    """An undisturbed start recovers nothing, and a push that still acts has no closed form."""
    calm = tl.fly(tl.load_mission("paper", {"initial.position": 0.0, "initial.euler": 0.0, "mission.duration": 22.0}))
    verdicts = {(claim.where, claim.says): claim.verdict for claim in claims(calm, flights.corridor)}
    untested = {says for (_, says), verdict in verdicts.items() if verdict == "not tested"}
    assert untested >= {
        "The inputs act on the disturbed start and then return to normal.",
        "The controller recovers an aggressive start.",
        "The closed loop is asymptotically stable: V falls whenever it is not zero.",
        "The reference moves in proportion to the push, with full compliance.",
    }
    assert verdicts["Figure 6", "Yaw is kept at zero."] == "holds"


def test_a_soft_gate_passes_the_closed_form_of_what_exceeds_the_threshold():
    push, admittance = {"force": [3.0, 0.0, 0.0], "sigma": 0.6}, {"threshold": [0.3] * 3, "damping": [1.6] * 3}
    t = np.linspace(-5.0, 5.0, 200_001)
    passed = np.trapezoid(np.maximum(3.0 * np.exp(-(t**2) / (2.0 * 0.6**2)) - 0.3, 0.0), t) / 1.6
    assert gaussian_displacement(push, {**admittance, "gate": "soft"}, 0) == pytest.approx(passed, rel=1e-6)


@pytest.mark.thorough
def test_the_pdf_has_the_figures_tables_and_errata(pdf):
    pypdf = pytest.importorskip("pypdf")
    pages = pypdf.PdfReader(pdf).pages
    text = "\n".join(page.extract_text() for page in pages)
    assert 8 <= len(pages) <= 24
    assert pdf.stat().st_size < 3e6
    for label in [f"Figure {n}:" for n in range(1, 10)] + [f"Table {n}:" for n in TABLES]:
        assert label in text
    for erratum in errata():
        assert erratum.about.replace("_", "") in text.replace("\u200b", "").replace("_", "").replace("\n", "")
    assert "3.227327" in text
    body = "\n".join(page.extract_text() for page in pages[1:])  # without the table of contents
    placed = re.findall(r"^Figure (\d)(:|[^.\n]* here\.)", body, re.M)  # headings and captions
    assert [number for number, _ in placed] == sorted(number for number, _ in placed)
    assert {number for number, end in placed if end != ":"} == set("123456789")


@pytest.mark.thorough
def test_the_tables_are_written_for_spreadsheets_and_papers(folder):
    assert (
        "m_t,mass of the vehicle,3.5,kg,3.5,kg,computed from the parts,yes"
        in (folder / "tables/table-II.csv").read_text()
    )
    latex = (folder / "tables/table-III.tex").read_text("utf-8")
    assert r"$\lambda _{1}$, position & linear reaching gain & 0.2, 0.1, 200 &  & 0.2, 0.1, 200 & 1/s & yes \\" in latex
    assert latex.isascii()


def test_without_typst_it_is_refused_before_anything_is_flown(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "typst", None)
    monkeypatch.setattr(command, "fly_paper", lambda *_: pytest.fail("it flies"))
    said = str(CliRunner().invoke(cli, ["paper", "--out", str(tmp_path / "a.pdf")]).exception)
    assert "--no-pdf" in said
    assert "pip install 'tandemlift[paper]'" in said
    assert list(tmp_path.iterdir()) == []


def test_without_a_pdf_all_else_is_written(folder):
    report = json.loads((folder / "report.json").read_text("utf-8"))
    assert report["command"].startswith("tandemlift paper --out ")
    assert report["command"].endswith(" --no-pdf")
    assert not folder.with_name("a.pdf").exists()
    drawn = {file.name for file in (folder / "figures").glob("figure-*")}
    assert len(drawn) == 11 + 4
    assert {f"figure-{n}-curves.pdf" for n in (4, 6, 7, 8)} < drawn
    assert [part["file"] for figure in report["figures"] for part in figure["parts"] if "yours" in part["behind"]] == [
        f"figures/figure-{n}-curves.pdf" for n in (4, 6, 7, 8)
    ]


def test_curves_are_read_by_the_names_of_channels_with_gaps(tmp_path):
    (tmp_path / "own.csv").write_text("time,position_x,thrust,mood\n0,1,34,7\n0.5,,35,8\n2,3,36,9\n")
    curves, left_out = read_curves(tmp_path / "own.csv", curve_channels())
    assert left_out == ["mood"]
    assert curves.time.tolist() == [0.0, 0.5, 2.0]
    np.testing.assert_equal(curves["position"], [[1.0, np.nan, np.nan], [np.nan] * 3, [3.0, np.nan, np.nan]])
    assert curves["thrust"].tolist() == [34.0, 35.0, 36.0]
    assert set(curves) == {"position", "thrust"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t,position_x\n0,1\n1,2\n", "has no column time [s]; it has t, position_x"),
        ("time,position_x\n0,1\n0,2\n", "time must rise"),
        ("time,place\n0,1\n1,2\n", "none of its columns is drawn; those that are: push_force_x, "),
        ("time,position_x\n0,a\n", "line 2: could not convert"),
        ("time,position_x,position[m].x\n0,1,1\n1,2,2\n", "position_x is a column under two names"),
        ("time,thrust\n0,\xff\n", "could not convert string to float: 'ÿ'"),
    ],
)
def test_curves_that_cannot_be_drawn_are_refused_before_anything_is_flown(text, said, tmp_path, monkeypatch):
    (tmp_path / "own.csv").write_bytes(text.encode("latin-1"))
    monkeypatch.setattr(command, "fly_paper", lambda *_: pytest.fail("it flies"))
    given = ["paper", "--no-pdf", "--out", str(tmp_path / "a.pdf"), "--curves", str(tmp_path / "own.csv")]
    assert said in str(CliRunner().invoke(cli, given).exception)
    assert [file.name for file in tmp_path.iterdir()] == ["own.csv"]


def test_another_mission_is_flown_in_place_of_the_papers_with_the_choices_that_it_has(tmp_path):
    (tmp_path / "mine.toml").write_text('extends = "paper"\n[mission]\nname = "mine"\nduration = 3.0\n')
    flown = command.fly_paper(str(tmp_path / "mine.toml"), {"controller.name": "pid", "mission.log_interval": 0.1})
    assert flown.paper.name == "mine"
    assert flown.paper.mission["controller"]["name"] == "pid"
    known = {setting.key: metrics for setting, metrics in zip(open_settings(), flown.choices, strict=True)}
    assert known["controller.switching"] is None  # a setting of the paper's controller
    assert known["admittance.gate"]["steps"] == 3000
    assert [row["key"] for row in document(flown, "", "")["open"]["rows"]] == [k for k, v in known.items() if v]


@pytest.mark.parametrize(("out", "said"), [("a.html", "must end in .pdf"), ("folder.pdf", "is a folder")])
def test_a_path_that_is_no_pdf_is_refused_before_anything_is_flown(out, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.pdf").mkdir()
    result = CliRunner().invoke(cli, ["paper", "--out", out])
    assert said in str(result.exception)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder.pdf"]
