"""The documents tell the truth: their code runs, their tables are complete, their links lead somewhere."""

import importlib
import re
import shlex
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from click.testing import CliRunner
from for_all import for_all
from repository import ROOT

from tandemlift.apps.cli.main import cli
from tandemlift.core.files import __version__
from tandemlift.flight.channels import OTHER, channel_of

DOCUMENTS = sorted(ROOT.glob("*.md"))  # the links of docs/ are checked when the site is built
PAGES = sorted((ROOT / "docs" / "how-to").glob("*.md"))
PAGES += [
    ROOT / "docs" / "reference" / f"{name}.md" for name in ("checks", "flights", "linearize", "missions", "studies")
]
# these need other programs or a minute, and have tests of their own
ELSEWHERE = ("ros", "scaling", "certify", "excite-a-vehicle")
CODE = [page for page in PAGES if page.stem not in ELSEWHERE and "\n```python\n" in page.read_text("utf-8")]
# reference/controllers.md has tests of its own; the site's build runs the tutorials
QUIET = pytest.mark.filterwarnings("error::tandemlift.core.errors.FlightWarning")
CODE.append(pytest.param(ROOT / "README.md", marks=QUIET, id="README"))
FILE = re.compile(r"^<!-- (\S+\.\w+) -->\n```\w+\n(.*?)^```", flags=re.M | re.S)
PYTHON = re.compile(r"^```python\n(.*?)^```$(?:\n\n```text\n(.*?)^```)?", flags=re.M | re.S)


@pytest.mark.parametrize("path", CODE, ids=lambda p: p.stem)
def test_every_block_of_python_runs_and_prints_the_text_below_it(path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = path.read_text("utf-8")
    for name, content in FILE.findall(text):
        Path(name).write_text(content, "utf-8")
    for block, printed in PYTHON.findall(text):
        if "import torch" in block:
            continue  # `make test-learning` runs it
        capsys.readouterr()
        exec(compile(block, path.name, "exec"), {})
        assert not printed or capsys.readouterr().out == printed


@for_all(sorted((ROOT / "docs" / "how-to").glob("coming-from-*.md")))
def test_keys_and_channels_that_tables_for_users_of_others_name_exist(page):
    rows = re.findall(r"^\| [^|\n]* \| ([^|\n]*) \|$", page.read_text("utf-8"), re.M)
    for name in {name for row in rows for name in re.findall(r"`([a-z]+(?:[._][a-z_0-9*]+)+)`", row)}:
        if "." not in name or channel_of(name.split(".")[0]) != OTHER:
            assert channel_of(name.split(".")[0]) != OTHER, name
        elif not name.startswith("tl."):
            key = name.removesuffix(".*").replace("*", "0")
            assert CliRunner().invoke(cli, ["explain", key]).exit_code == 0, name


def test_the_commands_of_the_readme_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "README.md").read_text("utf-8")
    commands = [shlex.split(command) for command in re.findall(r"`(tandemlift [^`]+)`", text)]
    assert commands
    # which go on until they are stopped, take minutes, or are run by the tutorials and by tests of their own
    elsewhere = {"live", "ros", "mavlink", "tune", "study", "feel", "paper", "linearize", "render"}
    elsewhere |= {"certify", "grade", "benchmark", "check"}
    quicker = {"run": ["--no-figures", "--set", "mission.duration=5"], "shadow": ["--no-figures"]}
    for _, *arguments in commands:
        if arguments[0] not in elsewhere:
            result = CliRunner().invoke(cli, [*arguments, *quicker.get(arguments[0], [])])
            assert result.exit_code == 0, result.output


def anchors(path):
    """The anchors of a document's headings, as GitHub makes them."""
    text, found = re.sub(r"^```.*?^```", "", path.read_text("utf-8"), flags=re.M | re.S), []
    for heading in re.findall(r"^#+ (.*)", text, flags=re.M):
        plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        anchor = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        found.append(anchor)
    return {anchor + (f"-{before}" if (before := found[:i].count(anchor)) else "") for i, anchor in enumerate(found)}


@for_all(DOCUMENTS)
def test_links_within_the_project_lead_somewhere(path):
    for link in re.findall(r"\]\((?!https?:)([^)]+)", path.read_text("utf-8")):
        file, _, anchor = link.partition("#")
        target = path.parent / file if file else path
        assert target.exists(), file
        assert not anchor or anchor in anchors(target), f"{file}#{anchor}"


def test_documents_that_the_code_names_are_there_with_their_anchors():
    """In docstrings, help and messages, such as docs/how-to/gazebo.md#over-ros."""
    wrong = []
    for file in (ROOT / "src" / "tandemlift").rglob("*.py"):
        for name, anchor in re.findall(r"\b(docs/[\w/-]+\.md)(?:#([\w-]+))?", file.read_text("utf-8")):
            if not (ROOT / name).exists() or (anchor and anchor not in anchors(ROOT / name)):
                wrong.append(f"{file.name}: {name}#{anchor}")
    assert wrong == []


def test_shell_commands_of_the_site_are_those_of_the_environment_that_builds_it(monkeypatch):
    """Where it is not active, the first page showed "command not found"."""
    monkeypatch.setenv("PATH", "/usr/bin")
    monkeypatch.setattr("sys.path", [*sys.path])
    conf = ROOT / "docs" / "conf.py"
    exec(
        compile(conf.read_text("utf-8"), str(conf), "exec"),
        {"tags": type("Tags", (set,), {"has": set.__contains__})(), "__file__": str(conf)},
    )
    assert Path(shutil.which("tandemlift")).parent == Path(sys.executable).parent


def test_changelog_citation_and_ros_package_have_the_version_of_the_package_and_one_date():
    def found(name, pattern):
        return re.search(pattern, (ROOT / name).read_text("utf-8"), flags=re.M)[1]

    assert found("src/tandemlift/data/ros/package.xml", r"<version>(.*)</version>") == __version__
    assert found("CITATION.cff", "^version: (.*)") == __version__
    date = found("CITATION.cff", "^date-released: (.*)")
    assert found("CHANGELOG.md", r"^## (\[\d.*)") == f"[{__version__}] - {date}"


def test_the_modules_that_the_history_moves_imports_to_are_there():
    history = (ROOT / "docs" / "history.md").read_text("utf-8")
    last = history.partition("\n### From 0.2.0 to 1.0.0")[2].partition("\n### ")[0]
    rows = re.findall(r"^  \| `.*\| `(tandemlift\.[\w.]+)`.* \|$", last, flags=re.M)
    assert rows
    assert [name for name in rows if find_spec(name) is None] == []


TEXT = (ROOT / "docs" / "explanation" / "architecture.md").read_text("utf-8")
PACKAGE = ROOT / "src" / "tandemlift"
ROOMS = sorted(p.stem for p in PACKAGE.iterdir() if p.is_dir() or p.suffix == ".py")
DOTTED = sorted(set(re.findall(rf"`((?:{'|'.join(ROOMS)})(?:\.\w+)+)`", TEXT)))
PATHS = sorted(set(re.findall(r"`(\w+/(?:\w+/)*\w+\.py)`", TEXT)))
JOINED = re.sub(r"\n {3,}", " ", TEXT)  # an item of a list in one line
WALK = re.findall(r"^\d+\. .*: (`.*) → (.*)$", JOINED, flags=re.M)


def found(name):
    """What a dotted name below `tandemlift` names."""
    *modules, last = ["tandemlift", *name.split(".")]
    try:
        return importlib.import_module(".".join([*modules, last]))
    except ModuleNotFoundError:
        return getattr(importlib.import_module(".".join(modules)), last)


def test_names_and_files_of_the_architecture_exist():
    assert all(found(name) is not None for name in DOTTED)
    assert [path for path in PATHS if not (PACKAGE / path).is_file()] == []


def test_the_walk_of_a_push_names_a_function_and_a_type_at_each_station():
    assert WALK
    for function, handed_on in WALK:
        names = re.findall(r"`([\w.]+)`", function)
        assert names
        assert all(callable(found(name)) for name in names), function
        types = re.findall(r"`([\w.]+)`", handed_on)
        assert all(isinstance(found(name), type) for name in types), handed_on
