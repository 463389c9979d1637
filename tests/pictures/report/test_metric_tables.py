"""Tables of metrics for a spreadsheet and for LaTeX: all numbers, aligned, with units; no text is a command."""

import csv
import io
import re
import shutil
import string

import pytest
from hypothesis import given
from hypothesis import strategies as st
from patience import completed
from small_studies import made_up

import tandemlift as tl
from tandemlift.analysis.studies.metric_descriptions import metric_of
from tandemlift.analysis.studies.study_rows import StudyRows
from tandemlift.pictures.report.metric_tables import (
    LISTS,
    latex_number,
    latex_text,
    metrics_as_csv,
    metrics_as_latex,
    write_metric_tables,
)
from tandemlift.pictures.report.study.outcome_tables import write_outcomes

HOSTILE = r"\input{/etc/passwd} 50 % & _x^2 # $y$ ~ {a} “λ”"
PAGE = r"\documentclass{article}\usepackage{booktabs}\begin{document}%s\end{document}"
CELLS = re.compile(r"(?<!\\)&")


@pytest.fixture(scope="module")
def metrics():
    flight = tl.fly(tl.load_mission("one-push", {"mission.duration": 12.0}))
    return flight.metrics() | {"wall_contact": False, "rotor_failure_detection_delay_s": None}


def read(text):
    return list(csv.DictReader(io.StringIO(text)))


def rows_of(latex):
    """The cells of a table of LaTeX, row by row, without the head."""
    body = latex.split("\\midrule\n")[1].split("\\bottomrule")[0]
    return [[cell.strip() for cell in CELLS.split(row.removesuffix(r" \\"))] for row in body.splitlines()]


def test_the_csv_has_every_number_of_the_metrics_to_the_last_digit(metrics):
    rows = read(metrics_as_csv({"value": metrics}))
    found = {}
    for row in rows:
        assert list(row) == ["metric", "component", "value", "unit", "meaning"]
        found.setdefault(row["metric"], []).append(row["value"])
        assert row["meaning"] == metric_of(row["metric"]).meaning.replace("`", "")
    assert set(found) == set(metrics) - set(LISTS)
    for name, texts in found.items():
        value = metrics[name]
        if isinstance(value, list):
            assert [float(text) for text in texts] == value
        elif isinstance(value, float):
            assert float(texts[0]) == value
    assert (found["wall_contact"], found["rotor_failure_detection_delay_s"]) == (["false"], ["NaN"])
    assert [(row["component"], row["unit"]) for row in rows if row["metric"] == "command_at_start"] == [
        *[("U1", "N"), ("U2", "N m"), ("U3", "N m"), ("U4", "N m")]
    ]


def test_every_row_of_the_latex_has_its_cells_and_the_number_on_both_sides_of_the_point(metrics):
    latex = metrics_as_latex({"value": metrics}, "Metrics")
    columns = re.search(r"begin\{tabular\}\{(.*)\}\n", latex)[1]
    assert columns == r"@{}llr@{}llp{5.4cm}@{}"
    name, found = "", {}
    for cells in rows_of(latex):
        two = [r"\multicolumn" in cell for cell in cells]
        assert len(cells) == 6 - sum(two)
        name = cells[0].removeprefix(r"\texttt{").removesuffix("}").replace(r"\_", "_") or name
        found.setdefault(name, []).append(cells)
    missing = {name for name, value in metrics.items() if value is None}
    for name in set(metrics) - set(LISTS) - {"failure", "outcome", "wall_contact"} - missing:
        values = metrics[name] if isinstance(metrics[name], list) else [metrics[name]]
        shown = [cells[2] + cells[3] for cells in found[name]]
        plain = [re.sub(r"\\times 10\^\{(-?\d+)\}", r"e\1", t).replace("$", "").replace("\\,", "") for t in shown]
        assert [float(text) for text in plain] == pytest.approx(values, rel=5e-4), name
        assert found[name][0][4].replace(r"\,", " ") == metric_of(name).unit_of(0)


def test_flights_stand_side_by_side_and_one_that_lacks_a_metric_has_a_gap(metrics):
    walled = metrics | {"clearance_min_m": 0.25}
    rows = {row["metric"]: row for row in read(metrics_as_csv({"nftsmc": metrics, "a,b": walled}))}
    assert (rows["clearance_min_m"]["nftsmc"], rows["clearance_min_m"]["a,b"]) == ("NaN", "0.25")
    latex = metrics_as_latex({"nftsmc": metrics, HOSTILE: walled}, "two\nlines")
    assert r"@{}llr@{}lr@{}ll@{}" in latex
    assert latex.startswith("% two lines.")
    assert all(len(cells) + sum(r"\multicolumn" in cell for cell in cells) == 7 for cells in rows_of(latex))


@given(st.text(alphabet=string.printable + "λ·−Łö", max_size=40))
def test_no_character_of_a_text_is_a_command_of_latex(text):
    known = r"\\text(?:backslash|asciitilde|asciicircum|less|greater|bar)\{\}|\\texttt\{|\$(?:\\cdot|-)\$"
    known += r"|\{[\[*]\}|\\[{}$&#_%]"
    left = re.sub(known, "", latex_text(text))
    assert not set(left.replace("}", "")) & set("\\{$&#_%^~\n\r")


@pytest.mark.parametrize(
    ("value", "cells"),
    [
        (0.0, "$0$ &"),
        (-12.345, "$-12$ & $.35$"),
        (0.02, "$0$ & $.02000$"),
        (9999.6, r"$1$ & $.000\times 10^{4}$"),
        (3.19631e-6, r"$3$ & $.196\times 10^{-6}$"),
        (90000, r"$90\,000$ &"),
        (-1234567.0, r"$-1\,234\,567$ &"),
        (None, r"\multicolumn{2}{c}{--}"),
        (True, r"\multicolumn{2}{c}{true}"),
    ],
)
def test_a_number_is_cut_at_its_point(value, cells):
    assert latex_number(value) == cells


@pytest.mark.targets
@pytest.mark.skipif(not shutil.which("pdflatex"), reason="LaTeX is not installed")
def test_latex_sets_the_tables_without_an_error_or_a_missing_letter(metrics, tmp_path):
    write_metric_tables({"value": metrics}, tmp_path, "one", HOSTILE)
    write_metric_tables({"nftsmc": metrics, HOSTILE: metrics}, tmp_path, "two", "two")
    settings = {"name": "x_y", "missions": ["one-push"], "controllers": ["nftsmc", "pid"], "draws": 4}
    study = made_up(
        {"study": settings, "cases": [{"name": HOSTILE[:19]}, {"name": "[*]|<Ðđö>"}]}, tmp_path / "study", outcomes
    )
    write_outcomes(StudyRows(study), tmp_path)
    (tmp_path / "page.tex").write_text(PAGE % r"\input{one}\clearpage\input{two}\clearpage\input{outcomes}", "utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "page.tex"]
    completed(command, cwd=tmp_path, check=True, capture_output=True)
    assert "Missing character" not in (tmp_path / "page.log").read_text("latin-1")


def outcomes(rows):
    """Made-up results: one of four crashed."""
    texts = {"outcome": ["crashed" if row.number % 4 == 1 else "landed" for row in rows]}
    empty = {name: [""] * len(rows) for name in ("reason", "finding_kinds")}
    lists = {name: ["[]"] * len(rows) for name in ("findings", "events")}
    return {**texts, **empty, **lists, "steps": [1_000] * len(rows)}


def test_the_outcomes_of_a_study_are_a_table_of_counts_and_shares(tmp_path):
    settings = {"name": "walls", "missions": ["one-push"], "controllers": ["nftsmc", "pid"], "draws": 8}
    study = made_up({"study": settings}, tmp_path / "study", outcomes)
    write_outcomes(StudyRows(study), tmp_path)
    rows = {row["group"]: row for row in read((tmp_path / "outcomes.csv").read_text("utf-8"))}
    assert list(rows) == ["nftsmc", "pid", "all rows"]
    every = rows["all rows"]
    assert (every["rows"], every["bad"], every["landed"], every["crashed"]) == ("16", "4", "12", "4")
    assert float(every["bad_share_low"]) < float(every["bad_share"]) == 0.25 < float(every["bad_share_high"])
    latex = rows_of((tmp_path / "outcomes.tex").read_text("utf-8"))
    assert [cells[0] for cells in latex] == list(rows)
    assert latex[2][1:5] == ["$16$", "", "$25$", ""]
