"""The house keeps its measures: few doors, no circle, modules beside what they work with, wings of limited size."""

import ast
import subprocess
import tomllib
from collections import Counter
from pathlib import Path

import pytest
import rooms
from house import PACKAGE, TESTS, assert_none, python_files
from repository import ROOT

LIMITS = Path(__file__).with_name("limits.toml")
LONGEST_FILE = {PACKAGE: 500, TESTS: 500}  # lines: a topic stays whole
LONGEST_FUNCTION = 60  # lines


def limits(text=None):
    """The most that each count may be, by table."""
    return tomllib.loads(LIMITS.read_text("utf-8") if text is None else text)


def history():
    """The limits of earlier commits, by commit; none without a history."""

    def git(*words):
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False).stdout

    place = LIMITS.relative_to(ROOT).as_posix()
    return {c: limits(git("show", f"{c}:{place}")) for c in git("log", "--format=%H", "--", place).split()}


@pytest.mark.parametrize(("table", "draw"), [("doors", rooms.draw_doors), ("rooms", rooms.draw)])
def test_the_house_has_no_more_than_its_limits(table, draw):
    counts = {name: len(getattr(draw(PACKAGE), name)) for name in limits()[table]}
    over = [name for name, most in limits()[table].items() if counts[name] > most]
    assert_none(over, f"{counts}, at most {limits()[table]}: see `python tools/rooms.py -v`, and cut an arrow")


def test_other_doors_use_the_nucleus_by_its_fronts():
    used, most = rooms.uses(PACKAGE, limits()["wings"]["nucleus"]["of"]), limits()["fronts"]
    counts = {"modules": len(used), "names": sum(map(len, used.values()))}
    advice = f"{counts}, at most {most}: ask one front for a whole, or move what only others use"
    assert_none([name for name in most if counts[name] > most[name]], advice)
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]["contracts"]
    named = {line.split()[-1] for one in settings for line in one.get("ignore_imports", ())}
    assert named == set(used), "the contracts of pyproject.toml name the fronts"


def lines_of_wings():
    """Lines of Python of each wing: a folder belongs to the wing that names it, or the nearest folder above it."""
    wings = limits()["wings"]
    wing_of = {folder: wing for wing, limit in wings.items() for folder in limit["of"]}
    lines = dict.fromkeys(wings, 0)
    for name, (n, _) in python_files(PACKAGE).items():
        above = [p.as_posix() for p in Path(name).relative_to(PACKAGE.relative_to(ROOT)).parents]
        if wing := next((wing_of[folder] for folder in above if folder in wing_of), None):
            lines[wing] += n
    return lines


def test_each_wing_has_no_more_lines_than_it_may_have():
    wings = limits()["wings"]
    named = {folder.partition("/")[0] for limit in wings.values() for folder in limit["of"]}
    assert named == {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    most = {wing: limit["lines"] + sum(limit.get("grown", {}).values()) for wing, limit in wings.items()}
    found = lines_of_wings()
    assert_none([w for w in found if found[w] > most[w]], f"{found}, at most {most}: delete what this replaces")


def test_no_limit_was_ever_lower():
    today = limits()
    for commit, earlier in history().items():
        for name, most in earlier["doors"].items():
            assert today["doors"][name] <= most, f"doors, {name}: lower in {commit[:8]}: cut an arrow instead"
        for wing, before in earlier.get("wings", {}).items():
            assert today["wings"][wing]["lines"] <= before["lines"], f"{wing}: lower in {commit[:8]}"
        for name, most in earlier.get("fronts", {}).items():
            assert today["fronts"][name] <= most, f"fronts, {name}: lower in {commit[:8]}"
        for name, before in earlier.get("exceptions", {}).items():
            assert_none(set(today["exceptions"][name]) - set(before), f"{name}: not there in {commit[:8]}")


def test_every_module_has_a_neighbour_that_it_works_with():
    alone = modules_without_neighbours(PACKAGE)
    known = limits()["exceptions"]["alone"]
    assert_none(set(alone) - set(known), "no neighbour in its folder imports it, nor does it import one: move it")
    assert_none(set(known) - set(alone), "has a neighbour now, or is gone: strike it out of limits.toml")


def modules_without_neighbours(package):
    """Modules, without the package's name, that share no import with another module of their folder; not of `core`."""
    files = rooms.draw_files(package)
    folder = {name: name.rpartition(".")[0] for name in files.rooms}
    linked = {end for a, b in files.arrows if folder[a] == folder[b] for end in (a, b)}
    shared = {f for f, n in Counter(folder.values()).items() if n > 1 and "." in f and not f.endswith(".core")}
    return [name.partition(".")[2] for name in files.rooms if folder[name] in shared and name not in linked]


def test_a_table_stands_beside_its_law_in_one_file_where_both_fit():
    files, split = python_files(PACKAGE), []
    for name, (lines, _) in files.items():
        law = name.replace("_table.py", ".py")
        if law != name and law in files and lines + files[law][0] <= LONGEST_FILE[PACKAGE]:
            split.append(Path(name).relative_to(PACKAGE.relative_to(ROOT)).as_posix())
    known = limits()["exceptions"]["apart"]
    assert_none(set(split) - set(known), "a table and its law, which fit into one file: join them")
    assert_none(set(known) - set(split), "joined, or gone: strike it out of limits.toml")


def test_no_files_import_each_other_be_it_for_types_alone():
    circles = [" ".join(circle) for circle in rooms.draw_files(PACKAGE).circles]
    assert_none(circles, "put what both need into a file below them, or name what one needs of the other by a Protocol")


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


def test_what_other_doors_use_is_counted_by_name_and_by_attribute_of_a_whole_module(small, tmp_path):
    small({"top/whole.py": "from small.base import numbers\nprint(numbers.NUMBER, numbers.MORE)"})
    assert rooms.uses(tmp_path / "small", ["base"]) == {
        "small.base": {"NUMBER"},
        "small.base.numbers": {"NUMBER", "MORE"},
    }


def test_a_module_without_a_neighbour_is_found(small, tmp_path):
    small({"base/lonely.py": "import os", "base/sums.py": "from .numbers import NUMBER"})
    assert modules_without_neighbours(tmp_path / "small") == ["base.lonely"]
