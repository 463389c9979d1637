"""Whatever a class hands in, each of it has a row or a line, and none of it reaches another or outlives its grade."""

import csv
import os
import pickle
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from classroom import graded, handed_in
from patience import until

from tandemlift.apps.teaching.hand_ins import notebooks_in
from tandemlift.apps.teaching.running import MAX_MEMORY, MIN_MEMORY, shares

pytestmark = pytest.mark.skipif(os.name != "posix", reason="processes of POSIX")
CHECKS = '''
def check_weight(weight, points=2):
    """The weight of a mass."""
    assert abs(weight(2.0) - 19.62) < 0.01, "multiply by 9.81 m/s²."
'''
RIGHT, WRONG = "def weight(mass):\n    return 9.81 * mass", "def weight(mass):\n    return mass"
NAME = "1-weight"


@pytest.fixture
def exercises(tmp_path):
    (tmp_path / "exercises" / NAME).mkdir(parents=True)
    (tmp_path / "exercises" / NAME / "checks.py").write_text(CHECKS, "utf-8")
    return tmp_path / "exercises"


def rows_in(path):
    return list(csv.reader(path.read_text("utf-8").splitlines()))


def run(exercises, *more):
    """The command, with the notebooks of a folder beside the exercises; no notebook is late."""
    return graded(exercises.parent / "in", "--exercises", str(exercises), "--seconds", "3600", *more)


def is_there(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_every_entry_of_the_folder_is_graded_or_has_a_line_with_the_reason(exercises, tmp_path):
    folder = tmp_path / "in"
    handed_in(folder / "anna.ipynb", "mine", NAME, RIGHT)  # a folder of this name
    (folder / f"{NAME}.py").write_text(RIGHT, "utf-8")
    (folder / "ben").mkdir()
    (folder / "ben" / f"{NAME}.py").write_text(WRONG, "utf-8")
    (folder / "ben" / "checks.py").write_text(CHECKS, "utf-8")
    (folder / "cleo.ipynb").mkdir()
    (folder / "dan.zip").write_bytes(b"PK")
    (folder / "eve").mkdir()
    (folder / "eve" / "all.tar.gz").write_bytes(b"")
    os.mkfifo(folder / "finn.ipynb")
    (folder / "gus.ipynb").symlink_to("/dev/zero")
    (folder / "hal").symlink_to("anna.ipynb")
    (folder / "ida.txt").write_text("my answers")
    (folder / "jo.py").write_text(RIGHT, "utf-8")
    with (folder / "kai.ipynb").open("wb") as large:
        large.truncate((64 << 20) + 1)
    found, skipped = notebooks_in(folder, exercises)
    assert {(one.name, one.path.name) for one in found} == {
        *((NAME, f"{NAME}.py"), ("anna", "mine.ipynb"), ("ben", f"{NAME}.py")),
    }
    assert [str(one).removesuffix(", and was skipped") for one in skipped] == [
        "cleo.ipynb: holds no notebook",
        "dan.zip: is an archive: unpack it into a folder",
        "eve: holds no notebook, but an archive, all.tar.gz: unpack it",
        "finn.ipynb: is no file",
        "gus.ipynb: is no file",
        "hal: is a link to a folder, which is not followed",
        "ida.txt: is no notebook",
        "jo.py: is a script that is not called as an exercise",
        "kai.ipynb: has more than 64 MiB",
    ]
    code, said = run(exercises, "--out", str(tmp_path / "points.csv"))
    assert code == 0
    assert "ben, 1-weight: The weight of a mass. multiply by 9.81 m/s²." in said
    names = [*(NAME, "anna", "ben", "cleo", "dan", "eve", "finn", "gus", "hal", "ida", "jo", "kai")]
    rows = {name: (points, remark) for name, _, points, remark in rows_in(tmp_path / "points.csv")[1:]}
    assert list(rows) == [*names[:3], *names[3:]]
    assert [rows[name][0] for name in names] == ["2", "2", "0", *["0"] * 9]
    assert rows["dan"][1] == "dan.zip: is an archive: unpack it into a folder, and was skipped"


@pytest.mark.parametrize(
    ("cells", "reason"),
    [
        ("{}", "cell 1 is not as in a notebook"),
        ("7", "it has no list of cells"),
        ("[3]", "cell 1 is not as in a notebook"),
        ('[{"cell_type": "code"}]', "cell 1 is not as in a notebook"),
        ('[{"cell_type": "raw", "source": ""}, {"cell_type": "code", "source": 7}]', "cell 2 is not as in a notebook"),
        ('[{"cell_type": "code", "source": "", "metadata": 7}]', "cell 1 is not as in a notebook"),
        ('[{"cell_type": "code", "source": [7]}]', "cell 1 is not as in a notebook"),
    ],
)
def test_a_notebook_of_damaged_structure_has_a_line_that_names_the_cell(cells, reason, exercises, tmp_path):
    text = f'{{"metadata": {{"tandemlift": {{"exercise": "{NAME}"}}}}, "cells": {cells}}}'
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "anna.ipynb").write_text(text)
    found, skipped = notebooks_in(tmp_path / "in", exercises)
    if cells == "{}":  # no cell at all: nothing is answered
        assert (len(found), skipped) == (1, [])
    else:
        assert (found, [one.reason for one in skipped]) == ([], [f"is damaged: {reason}"])


@pytest.mark.thorough
def test_sources_that_python_cannot_read_and_many_lines_of_ipython_are_told_or_run(exercises, tmp_path):
    handed_in(tmp_path / "in", "anna", NAME, "!ls\n" * 1100, RIGHT)
    handed_in(tmp_path / "in", "ben", NAME, RIGHT, "a = '\0'")
    handed_in(tmp_path / "in", "cleo", NAME, RIGHT, "input()")
    code, said = run(exercises)
    assert code == 3
    assert [line.split() for line in said.splitlines()[1:4]] == [[name, "2", "2"] for name in ("anna", "ben", "cleo")]
    assert "ben, 1-weight: cell 2, SyntaxError: " in said
    assert "cleo, 1-weight: cell 2, EOFError: " in said
    assert "anna, 1-weight" not in said


def test_names_and_remarks_are_no_formulas_in_a_spreadsheet(exercises, tmp_path):
    for name in ("=cmd|' C calc'!A0", "+1", "-1", "@SUM(1)", "anna"):
        handed_in(tmp_path / "in", name, NAME, RIGHT)
    (tmp_path / "in" / "\t=1+1.txt").write_text("")
    (tmp_path / "in" / os.fsdecode(b"ren\xe9.txt")).write_text("")  # not UTF-8
    out = tmp_path / "points.csv"
    _, said = run(exercises, "--out", str(out))
    cells = [cell for row in rows_in(out) for cell in row]
    assert [cell for cell in cells if cell[:1] in tuple("=+-@\t\r")] == []
    names = {row[0] for row in rows_in(out)[1:]}
    assert names == {"'=cmd|' C calc'!A0", "'+1", "'-1", "'@SUM(1)", "anna", "'=1+1", "ren\ufffd"}
    assert "\t" not in said


def test_what_a_notebook_writes_into_its_pipe_is_never_run_in_the_process_that_grades(exercises, tmp_path):
    class Marker:
        def __reduce__(self):
            return Path.touch, (tmp_path / "ran in the grader",)

    sent = pickle.dumps(Marker())
    for number, data in enumerate((len(sent).to_bytes(4, "big") + sent, b"\xff\xff", b"[1, 2, 3]\n", b"[" * 90_000)):
        write = f"try:\n        os.write(pipe, {data!r})\n    except OSError:\n        pass"
        handed_in(tmp_path / "in", f"n{number}", NAME, RIGHT, f"import os\nfor pipe in range(3, 99):\n    {write}")
    code, said = run(exercises)
    assert code == 3
    for number in range(4):
        assert f"n{number}, 1-weight: cell 2 wrote into the pipe through which its grade comes" in said, said
    assert not (tmp_path / "ran in the grader").exists()


def test_a_check_that_a_notebook_claims_has_the_points_of_the_check(exercises, tmp_path):
    claim = 'import os\nfor pipe in range(3, 99):\n    try:\n        os.write(pipe, b\'["", [[9000, ""]]]\\n\')\n'
    handed_in(tmp_path / "in", "anna", NAME, f"{claim}    except OSError: pass")
    assert run(exercises)[1].splitlines()[1].split() == ["anna", "0", "0"]


DAEMON = """
import os, time
if not os.fork():
    os.setsid()
    if not os.fork():
        with open({file!r} + ".new", "w") as file:
            file.write(str(os.getpid()))
        os.rename({file!r} + ".new", {file!r})
        time.sleep(3600)
    os._exit(0)
while not os.path.exists({file!r}):
    time.sleep(0.01)
"""


def test_a_folder_may_be_given_by_a_relative_path(exercises, tmp_path, monkeypatch):
    handed_in(tmp_path / "in", "anna", NAME, RIGHT)
    monkeypatch.chdir(tmp_path)
    _, said = graded(Path("in"), "--exercises", "exercises", "--seconds", "3600")
    assert said.splitlines()[1].split() == ["anna", "2", "2"]


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="orphans are found under Linux")
@pytest.mark.parametrize("end", ["", "os._exit(0)", "raise SystemExit", "os.fork()"])
def test_what_a_notebook_has_started_ends_with_it_in_whatever_session_it_is(end, exercises, tmp_path):
    handed_in(tmp_path / "in", "anna", NAME, RIGHT, DAEMON.format(file=str(tmp_path / "number")), end)
    _, said = run(exercises)
    assert said.splitlines()[1].split() == ["anna", *["0" if "_exit" in end else "2"] * 2]
    assert not is_there(int((tmp_path / "number").read_text()))


@pytest.fixture
def grading(exercises, tmp_path):
    """The command while it grades the second of two notebooks; the file for which that waits, and the table."""
    go, out, number = tmp_path / "go", tmp_path / "points.csv", tmp_path / "number"
    waits = f"while not os.path.exists({str(go)!r}):\n    time.sleep(0.01)"
    handed_in(tmp_path / "in", "anna", NAME, RIGHT)
    handed_in(tmp_path / "in", "ben", NAME, RIGHT, DAEMON.format(file=str(number)), waits)
    command = [sys.executable, "-m", "tandemlift", "grade", tmp_path / "in", "--exercises", exercises, "--out", out]
    pipe = subprocess.PIPE
    with subprocess.Popen([*command, "--seconds", "3000"], stdout=pipe, stderr=pipe, text=True) as process:
        until(lambda: number.exists() and rows_in(out)[1] == ["anna", "2", "2", ""])
        yield process, go, out, int(number.read_text())
        process.kill()


def test_the_row_of_a_name_is_written_when_its_notebooks_are_graded(grading):
    _, go, out, _ = grading
    assert rows_in(out)[1:] == [["anna", "2", "2", ""], ["ben", "not graded yet", "0", ""]]
    go.touch()
    until(lambda: rows_in(out)[2] == ["ben", "2", "2", ""])


def test_an_interrupt_leaves_the_rows_of_what_was_graded_and_no_process(grading):
    process, _, out, number = grading
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate()
    assert process.returncode == 130
    assert [line.split() for line in said.splitlines()[1:2]] == [["anna", "2", "2"]]
    assert rows_in(out)[1:] == [["anna", "2", "2", ""], ["ben", "not graded yet", "0", ""]]
    assert not is_there(number)


def test_notebooks_end_when_the_grader_is_killed(grading):
    process, _, _, number = grading
    process.kill()
    until(lambda: not is_there(number))


@pytest.mark.parametrize("processors", [1, 2, 8, 64])
@pytest.mark.parametrize("has", [256 << 20, 1 << 30, 8 << 30, 24 << 30, 1 << 40])
def test_all_notebooks_together_may_take_three_quarters_of_the_memory(has, processors):
    at_once, memory = shares(has, processors)
    assert 1 <= at_once <= processors
    assert at_once * memory <= 0.75 * has
    assert memory <= MAX_MEMORY
    assert memory >= MIN_MEMORY or at_once == 1


@pytest.mark.thorough
def test_the_memory_of_a_notebook_has_a_limit(exercises, tmp_path):
    limit = "import resource\nlimit = resource.getrlimit(resource.RLIMIT_AS)\nassert limit[0] != -1, limit"
    handed_in(tmp_path / "in", "anna", NAME, RIGHT, limit)
    assert run(exercises)[0] == 0
