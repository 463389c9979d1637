"""The map of the equations and the list of errata are complete, and true of the code and of the tests."""

from __future__ import annotations

import ast
import functools
import hashlib
import re
from collections import Counter
from pathlib import Path

from for_all import for_all
from repository import ROOT

from tandemlift.pictures.report.paper_figures import errata

SOURCE, TESTS = ROOT / "src" / "tandemlift", ROOT / "tests"

# The labels of the paper's numbered equations in its order, one a line, as its LaTeX source has them, and
# their SHA-256 when they were read: neither can be changed without the other.
LABELS = (TESTS / "support" / "paper_labels.txt").read_text("utf-8").split()
DIGEST = "f36d73a9673008fc6f276a9e8a9f08c67f582dbba701c6cc0a55f7f4299583e3"
STEPS = {"vdot_tr_equ", "equ_dt", "equ_dt_int", "equ_integral"}  # of a derivation: no law needs them
ERRATA = {
    "equ_des_orient", "equ4", "kinematic_equ", "trans_rot_payload_equ", "input_vector_equ", "b_matrix_equ",
    "cost_fun_equ", "pos_cont_equ", "sat_equ", "control_final_equ", "u_hat_equ", "vsdot_f_equ", "lyap_fun_equ",
    "xsi_seprate_equ", "reach_time_equ", "sliding_surface_equ", "Theorem 1", "Assumption 4", "Table II", "Table III",
    "thrus_z_equ", "F_ext", "One sensor", "Assumption 3", "Section IV", "Payload inertia",
    "Payload density", "Point of the push",
}  # fmt: skip
LABEL = re.compile(r"\b(?:[A-Za-z]\w*equ|equ_\w+|equ\d|u_inputs)\b")
SPAN = re.compile(r"`([^`]+)`")


def rows() -> list[list[str]]:
    """The cells of the map's rows."""
    lines = (ROOT / "docs" / "reference" / "equation-map.md").read_text("utf-8").splitlines()
    cells = [re.split(r"(?<!\\)\|", line)[1:-1] for line in lines if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in cells[2:]]


def labelled() -> list[tuple[str, str, str]]:
    """(label, function cell, proof cell) of the rows with a label."""
    return [(row[0].strip("`"), row[2], row[3]) for row in rows() if row[0].startswith("`")]


@functools.cache
def definitions(path: Path) -> dict[str, str]:
    """The source of every function of a file, methods as Class.method."""
    text = path.read_text("utf-8")
    found = {}
    for node in ast.parse(text).body:
        inside = node.body if isinstance(node, ast.ClassDef) else [node]
        prefix = f"{node.name}." if isinstance(node, ast.ClassDef) else ""
        for part in inside:
            if isinstance(part, ast.FunctionDef):
                found[prefix + part.name] = ast.get_source_segment(text, part) or ""
    return found


def named(cell: str, root: Path) -> list[tuple[Path, str]]:
    """(file, name) of every `file::name` in a cell."""
    spans = [span for span in SPAN.findall(cell) if "::" in span]
    return [(root / file, name) for file, _, name in (span.partition("::") for span in spans)]


def labels_beside(source: str) -> list[str]:
    """The labels in the `# paper:` comments of a piece of source."""
    return [label for line in re.findall(r"#\s*paper:(.*)", source) for label in LABEL.findall(line)]


def test_every_numbered_equation_has_exactly_one_row():
    assert [label for label, _, _ in labelled()] == LABELS  # in the paper's order


def test_the_list_of_labels_is_that_which_was_read_from_the_papers_source():
    assert hashlib.sha256("".join(f"{label}\n" for label in LABELS).encode()).hexdigest() == DIGEST
    assert len(LABELS) == 42


@for_all([(label, cell) for label, cell, _ in labelled()])
def test_the_named_functions_exist_and_carry_the_label(row):
    label, cell = row
    functions = named(cell, SOURCE)
    assert bool(functions) != (label in STEPS)
    for file, name in functions:
        assert name in definitions(file), f"{file} has no {name}"
        assert label in labels_beside(definitions(file)[name])


@for_all(rows(), lambda row: row[0])
def test_every_row_is_proven_by_a_test_that_exists(row):
    proofs = named(row[3], TESTS)
    assert proofs
    for file, name in proofs:
        assert name.startswith("test_")
        assert name in definitions(file), f"{file} has no {name}"


def test_every_label_in_the_source_is_in_the_map():
    mapped = {(file, label) for label, cell, _ in labelled() for file, _ in named(cell, SOURCE)}
    for file in SOURCE.rglob("*.py"):
        for comment in re.findall(r"#\s*paper:(.*)", file.read_text("utf-8")):
            labels = LABEL.findall(comment)
            assert labels or re.match(r"\s*(fig|tab)", comment), f"{file}: '# paper:{comment}' names no label"
            for label in labels:
                assert (file, label) in mapped, f"{file} carries {label}, which the map does not place there"


def test_every_erratum_has_one_entry():
    assert Counter(erratum.about for erratum in errata()) == Counter(ERRATA)


@for_all(errata(), lambda erratum: erratum.about)
def test_an_erratum_says_what_is_printed_what_is_right_how_it_shows_and_where_it_is_tested(erratum):
    assert erratum.printed
    assert erratum.right
    assert re.search(r"\d", erratum.shows), "no number"
    assert erratum.evidence
    for file, name in named(" ".join(f"`{test}`" for test in erratum.evidence), TESTS):
        assert name in definitions(file), f"{file} has no {name}"
