"""The house keeps its measures: few rooms, floors and arrows, no circle, and small folders, files and functions."""

import ast
import subprocess
import tomllib
from pathlib import Path

import pytest
import rooms
from house import PACKAGE, TESTS, assert_none, python_files
from repository import ROOT

LIMITS = Path(__file__).with_name("limits.toml")
MOST_FILES, MOST_LINES = 15, 2500  # of Python in a folder, `__init__.py` included, folders within it apart
LONGEST_FILE = {PACKAGE: 300, TESTS: 400}  # lines
LONGEST_FUNCTION = 60  # lines


def limits_in(text):
    """The most that each count may be, by table, and the arrows that each new folder brings."""
    tables = tomllib.loads(text)
    folders = tables.pop("folders", {})
    return tables, folders


def limits():
    """The most that each count may be, by table, with what new folders bring."""
    tables, folders = limits_in(LIMITS.read_text("utf-8"))
    tables["rooms"]["rooms"] += len(folders)
    tables["rooms"]["arrows"] += sum(folders.values())
    return tables


@pytest.mark.parametrize(("table", "draw"), [("doors", rooms.draw_doors), ("rooms", rooms.draw)])
def test_the_house_has_no_more_than_its_limits(table, draw):
    counts = {name: len(getattr(draw(PACKAGE), name)) for name in limits()[table]}
    over = [name for name, most in limits()[table].items() if counts[name] > most]
    assert_none(over, f"{counts}, at most {limits()[table]}: see `python tools/rooms.py -v`, and cut an arrow")


def test_no_limit_was_ever_lower():
    def git(*words):
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout

    today, _ = limits_in(LIMITS.read_text("utf-8"))
    for commit in git("log", "--format=%H", "--", str(LIMITS)).split():  # none without a history
        earlier, _ = limits_in(git("show", f"{commit}:{LIMITS.relative_to(ROOT).as_posix()}"))
        raised = [(t, n) for t, table in earlier.items() for n, most in table.items() if today[t][n] > most]
        assert raised == [], f"lower in {commit[:8]}: cut an arrow instead"


def test_a_new_folder_stands_behind_a_door_and_brings_at_most_three_arrows():
    _, folders = limits_in(LIMITS.read_text("utf-8"))
    elsewhere = [name for name in folders if not (PACKAGE / name).is_dir() or "/" not in name]
    assert_none(elsewhere, 'a line `"door/folder" = arrows` of [folders] is for a folder that exists')
    assert_none([name for name, arrows in folders.items() if arrows > 3], "a new folder brings at most 3 arrows")


def test_no_files_import_each_other_be_it_for_types_alone():
    circles = [" ".join(circle) for circle in rooms.draw_files(PACKAGE).circles]
    assert_none(circles, "put what both need into a file below them, or name what one needs of the other by a Protocol")


def test_no_folder_is_larger_than_it_may_be():
    folders = {}
    for name, (lines, _) in python_files(PACKAGE).items():
        folders.setdefault(str(Path(name).parent), []).append(lines)
    large = [name for name, sizes in folders.items() if len(sizes) > MOST_FILES or sum(sizes) > MOST_LINES]
    advice = f"at most {MOST_FILES} files and {MOST_LINES} lines in a folder: move a topic to where it belongs"
    assert_none(large, advice)


def test_no_file_is_longer_than_it_may_be():
    long = [name for folder, most in LONGEST_FILE.items() for name, (n, _) in python_files(folder).items() if n > most]
    advice = f"at most {list(LONGEST_FILE.values())} lines in a file of src and tests: split it by topic"
    assert_none(long, advice)


def test_no_function_is_longer_than_it_may_be():
    long = [
        f"{name}: {node.name}"
        for folder in (PACKAGE, TESTS)
        for name, (_, tree) in python_files(folder).items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        and node.end_lineno - node.lineno >= LONGEST_FUNCTION
    ]
    assert_none(long, f"at most {LONGEST_FUNCTION} lines in a function: give its parts names")


# ---- The drawing itself

SMALL_PACKAGE = {
    "__init__.py": "from small.top import show",  # its face is no room
    "alone.py": "def f():\n    from small.base import NUMBER",
    "base/__init__.py": "from small.base.numbers import NUMBER",
    "base/numbers.py": "NUMBER = 1",
    "top/__init__.py": "",
    "top/show.py": "from .. import alone\nfrom ..base.numbers import NUMBER\nimport os",
    "top/inner/__init__.py": "import small.base.numbers",
    "top/inner/part.py": "from small.base import numbers",
    "empty/__init__.py": '"""Holds folders only."""',
}


@pytest.fixture
def small(tmp_path):
    """The drawing of a small package, with files changed."""

    def drawn(changed):
        for name, text in {**SMALL_PACKAGE, **changed}.items():
            path = tmp_path / "small" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, "utf-8")
        return rooms.draw(tmp_path / "small")

    return drawn


def test_rooms_floors_and_arrows_of_a_small_package_are_found(small):
    drawing = small({})
    assert drawing.rooms == ("alone", "base", "top", "top.inner")
    assert set(drawing.arrows) == {("alone", "base"), ("top", "alone"), ("top", "base"), ("top.inner", "base")}
    assert drawing.floors == [["base"], ["alone", "top.inner"], ["top"]]
    assert drawing.circles == []
    assert [str(one) for one in drawing.arrows["top", "base"]] == ["small.top.show imports small.base.numbers: NUMBER"]
    assert [one.importer for one in drawing.arrows["top.inner", "base"]] == ["small.top.inner", "small.top.inner.part"]


def test_rooms_that_import_each_other_by_others_are_a_circle_on_one_floor(small):
    drawing = small({"base/numbers.py": "if TYPE_CHECKING:\n    from small.top import show"})
    assert drawing.circles == [["alone", "base", "top"]]
    assert drawing.floors == [["alone", "base", "top"], ["top.inner"]]
