"""The tutorials and the examples are the same code; each example is short and runs."""

import json
import re
import sys

import pytest
from for_all import for_all
from patience import completed
from repository import ROOT

EXAMPLES, PAGES = ROOT / "examples", ROOT / "docs" / "tutorials"
ELSEWHERE = {"gazebo", "ros"}  # of a shell, executed by `make test-gazebo`
NAMES = sorted({path.stem for path in PAGES.glob("*.md")} - {"index"} - ELSEWHERE)
OWN = {path.name: path.read_text("utf-8") for path in EXAMPLES.glob("my_*.py")}  # which tutorials have readers write
FOUND = re.compile(r'str\(Path\(__file__\)\.with_name\(("my_\w+\.py")\)\)')  # so that it is found from any folder
CELL = re.compile(r"^```\{code-cell\} ipython3\n((?::[^\n]*\n)*)(.*?)^```", flags=re.M | re.S)
MOST = 40  # lines of an example


def cells(page):
    """The options and the text of the cells of a tutorial."""
    return [match.groups() for match in CELL.finditer((PAGES / f"{page}.md").read_text("utf-8"))]


def code_of_page(page):
    """The lines of all cells that a reader would type, but blank ones; a notebook's `;` hides a cell's value."""
    shown = [text for options, text in cells(page) if "remove-input" not in options and text[0] not in "!%"]
    return [line for text in shown for line in re.sub(r";\n$", "\n", text).splitlines() if line]


def code_of_script(page):
    """The lines of the example, but its docstring, blank lines, and where a figure goes, which a notebook shows."""
    text = (EXAMPLES / f"{page.replace('-', '_')}.py").read_text("utf-8")
    body = text.partition('"""\n\n')[2]
    if FOUND.search(body):
        body = FOUND.sub(r"\1", body).replace("from pathlib import Path\n", "")
    return [line for line in body.splitlines() if line and not line.startswith("figure.savefig(")]


def test_there_is_a_tutorial_of_each_example_and_an_example_of_each_tutorial():
    scripts = sorted(path.stem.replace("_", "-") for path in EXAMPLES.glob("*.py") if path.name not in OWN)
    assert scripts == NAMES


@for_all(NAMES)
def test_the_cells_of_a_tutorial_are_the_example_of_its_name(page):
    assert code_of_page(page) == code_of_script(page)


def test_the_files_that_a_tutorial_writes_are_those_of_the_examples():
    written = [text.partition("\n") for name in NAMES for _, text in cells(name) if text.startswith("%%writefile ")]
    assert {line.removeprefix("%%writefile "): text for line, _, text in written} == OWN


def test_examples_are_short():
    assert [path.name for path in EXAMPLES.glob("*.py") if len(path.read_text("utf-8").splitlines()) > MOST] == []


@for_all(NAMES)
def test_a_tutorial_says_what_else_to_try_and_how_it_goes_on_the_command_line(page):
    text = (PAGES / f"{page}.md").read_text("utf-8")
    assert re.search(r"^## On the command line\n\n```sh\ntandemlift ", text, flags=re.M)
    assert re.search(r"^## What to try next\n\n- ", text, flags=re.M)


def test_the_notebook_is_kept_without_outputs():
    cells = json.loads((EXAMPLES / "first_flight.ipynb").read_text("utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)


@pytest.mark.examples
def test_in_the_notebook_a_flight_shows_itself_and_long_work_has_a_bar(tmp_path):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    notebook = nbformat.read(EXAMPLES / "first_flight.ipynb", 4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    every = [out for cell in notebook.cells for out in cell.get("outputs", [])]
    outputs = [out.get("data", {}) for out in every]
    html = [data["text/html"] for data in outputs if "text/html" in data]
    assert [text for text in html if "<svg" in text]
    bars = [out.get("text", "") + str(out.get("data", "")) for out in every]  # of characters without ipywidgets
    bars += map(str, notebook.metadata.get("widgets", {}).values())
    assert [text for text in bars if "200/200" in text]
    assert [data for data in outputs if "image/png" in data]


@pytest.mark.examples
@pytest.mark.parametrize("page", NAMES)
def test_an_example_runs_in_any_folder_and_its_numbers_hold(page, tmp_path):
    script = EXAMPLES / f"{page.replace('-', '_')}.py"
    run = completed([sys.executable, str(script)], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert (tmp_path / f"{script.stem}.png").stat().st_size > 10_000
