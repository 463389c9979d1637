"""`tandemlift paper`: each figure and table of the paper has its place, with numbers of the mission and of flights."""

import json
import re
import sys

import numpy as np
import pytest
from click.testing import CliRunner
from repository import ROOT

import tandemlift as tl
from tandemlift.apps.cli import report as command
from tandemlift.apps.cli.main import cli
from tandemlift.missions import tables_of
from tandemlift.pictures.report import paper_report
from tandemlift.pictures.report.paper_claims import claims, gaussian_displacement
from tandemlift.pictures.report.paper_figures import DATA, errata, open_settings, write_drawing
from tandemlift.pictures.report.paper_report import PaperFlights, typeset
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
def without_typst(flights, tmp_path_factory):
    """What the command says where typst is not installed, and the path of the PDF that it was asked for."""
    path = tmp_path_factory.mktemp("paper") / "a.pdf"
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "typst", None)
        patch.setattr(command, "fly_paper", lambda: flights)
        patch.setattr(
            paper_report, "write_drawing", lambda name, *to: write_drawing("path" if name in SLOW else name, *to)
        )
        result = CliRunner().invoke(cli, ["paper", "--out", str(path)])
    return str(result.exception), path


@pytest.fixture(scope="module")
def folder(without_typst):
    """The report's files without its PDF."""
    return without_typst[1].with_name("a-files")


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


def test_claims_are_numbers_of_the_flights(flights):
    found = {claim.says: claim for claim in claims(flights.paper, flights.corridor)}
    tracked = found["Position errors go to zero and stay there for the whole mission."].ours
    late = flights.paper.time >= 10.0
    assert f"{1e3 * np.abs(flights.paper['position_error'][late, 0]).max():.2f}" in tracked
    assert (
        found["Pushed through a zigzag corridor, the vehicle lands at its end."].verdict == "differs"
    )  # it still flies


def test_the_pdf_has_the_figures_tables_and_errata(pdf):
    pypdf = pytest.importorskip("pypdf")
    pages = pypdf.PdfReader(pdf).pages
    text = "\n".join(page.extract_text() for page in pages)
    assert 8 <= len(pages) <= 20
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


def test_the_tables_are_written_for_spreadsheets_and_papers(folder):
    assert (
        "m_t,mass of the vehicle,3.5,kg,3.5,kg,computed from the parts,yes"
        in (folder / "tables/table-II.csv").read_text()
    )
    latex = (folder / "tables/table-III.tex").read_text("utf-8")
    assert r"$\lambda _{1}$, position & linear reaching gain & 0.2, 0.1, 200 &  & 0.2, 0.1, 200 & 1/s & yes \\" in latex
    assert latex.isascii()


def test_without_typst_all_else_is_written_and_the_command_that_installs_it_is_named(without_typst, folder):
    said, path = without_typst
    assert "pip install 'tandemlift[paper]'" in said
    assert not path.exists()
    assert len(list((folder / "figures").glob("figure-*"))) == 11
    assert json.loads((folder / "report.json").read_text("utf-8"))["command"] == f"tandemlift paper --out {path}"


@pytest.mark.parametrize(("out", "said"), [("a.html", "must end in .pdf"), ("folder.pdf", "is a folder")])
def test_a_path_that_is_no_pdf_is_refused_before_anything_is_flown(out, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.pdf").mkdir()
    result = CliRunner().invoke(cli, ["paper", "--out", out])
    assert said in str(result.exception)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder.pdf"]
