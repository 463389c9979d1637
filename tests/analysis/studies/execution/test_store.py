"""The folder of a study when something is wrong with it: files cut short, no space, no rights, another study."""

import json
import os
import random
import shutil
import tempfile
from pathlib import Path

import pytest
from listings import LAW
from study_runs import TWELVE, assert_same_rows, files_of, fly, started

from tandemlift.analysis.studies.design.study_files import load_plan
from tandemlift.analysis.studies.execution.store import LEFT_OVER, open_folder
from tandemlift.analysis.studies.study import mission_of_row
from tandemlift.analysis.studies.table import load_study
from tandemlift.core.errors import InputError
from tandemlift.parts.controllers import CONTROLLERS


@pytest.fixture
def twelve(flown_twelve, tmp_path):
    return shutil.copytree(flown_twelve, tmp_path / "twelve")


def stamps(folder):
    return {name: path.stat().st_mtime_ns for name, path in files_of(folder).items()}


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"set": {"mission.duration": 0.6}}, r"its set.mission.duration is 0.5, here it is 0.6"),
        (
            {"study": TWELVE["study"] | {"missions": ["hover"]}},
            r'its study.missions is \["one-push"\], here it is \["hover"\]',
        ),
    ],
)
def test_the_folder_of_another_study_is_refused_and_stays(twelve, changed, said):
    before = stamps(twelve)
    with pytest.raises(InputError, match=f"holds another study: {said}; choose another --out"):
        fly(TWELVE | changed, twelve)
    assert stamps(twelve) == before


def test_the_study_file_that_is_flown_is_not_replaced(tmp_path):
    own, text = tmp_path / "study.toml", '[study]\nname = "mine"  # my comment\nmissions = ["hover"]\n'
    own.write_text(text, "utf-8")
    with pytest.raises(InputError, match=r"would replace .*study\.toml: choose another --out"):
        open_folder(load_plan(own), tmp_path)
    assert (own.read_text("utf-8"), [*tmp_path.iterdir()]) == (text, [own])


def test_a_controller_s_file_that_changed_since_is_named(tmp_path):
    path = tmp_path / "changing.py"
    path.write_text(LAW.replace("my-pd", "changing"), "utf-8")
    tables = {"study": {"name": "mine", "missions": ["hover"], "controllers": [str(path)]}}
    open_folder(load_plan(tables), tmp_path / "out")
    path.write_text(path.read_text("utf-8") + "\n# edited\n", "utf-8")
    del CONTROLLERS["changing"]  # as in a new process
    with pytest.raises(InputError, match=r"flown with another version of changing\.py: choose another --out"):
        open_folder(load_plan(tables), tmp_path / "out")
    del CONTROLLERS["changing"]


EDITS = {
    "a mission": lambda said: said["variants"][0]["tables"].update(plant={"mass_scale": 1.1}),
    "a plugin": lambda said: said["variants"][0].update(plugins=[["mine.py", "0" * 64, "raise SystemExit('ran')"]]),
    "the digest": lambda said: said.update(digest=said["digest"][::-1]),
    "a key of its own": lambda said: said.update(more=1),
}


@pytest.mark.parametrize("edit", EDITS.values(), ids=EDITS)
def test_a_plan_that_was_edited_is_refused_before_anything_of_it_is_used(twelve, edit):
    path = twelve / "study.json"
    said = json.loads(path.read_text("utf-8"))
    edit(said)
    path.write_text(json.dumps(said), "utf-8")
    for use in (load_study, lambda folder: mission_of_row(folder, 0), lambda folder: fly(TWELVE, folder)):
        with pytest.raises(InputError, match=r"study\.json is damaged, or was edited: .* Remove this file and start"):
            use(twelve)
    path.unlink()
    assert fly(TWELVE, twelve) == 0


def test_a_plan_of_which_a_bit_changed_is_refused(twelve):
    path = twelve / "study.json"
    content, drawn = path.read_bytes(), random.Random(25)
    for _ in range(40):
        bit = drawn.randrange(8 * len(content.rstrip()))
        path.write_bytes(bytes(byte ^ (1 << bit % 8) * (i == bit // 8) for i, byte in enumerate(content)))
        with pytest.raises(InputError, match=r"study\.json|made by another version"):
            load_study(twelve)


def test_a_folder_of_another_format_is_said_to_be_of_another_version(twelve):
    path = twelve / "study.json"
    path.write_text(path.read_text("utf-8").replace('"format": ', '"format": 99'), "utf-8")
    with pytest.raises(InputError, match="made by another version of tandemlift; fly it again"):
        load_study(twelve)


@pytest.fixture
def locked(flown_twelve):
    """The folder of a study that lacks one file, and to which this process may not write."""
    above = Path(tempfile.mkdtemp())
    above.chmod(0o755)
    folder = shutil.copytree(flown_twelve, above / "twelve")
    next(iter(files_of(folder).values())).unlink()
    (folder / "chunks").chmod(0o555)
    folder.chmod(0o555)
    root = os.geteuid() == 0
    if root:  # whom no mode stops
        os.seteuid(65534)
    yield folder
    if root:
        os.seteuid(0)
    for path in (folder, folder / "chunks"):
        path.chmod(0o755)
    shutil.rmtree(above)


def test_a_read_only_folder_is_one_clear_line(locked):
    there = stamps(locked)
    with pytest.raises(InputError, match=r"/twelve/chunks: cannot be written to: Permission denied$"):
        fly(TWELVE, locked, threads=1)
    with pytest.raises(InputError, match=r"/inner: cannot be made or written to: Permission denied$"):
        fly(TWELVE, locked / "inner", threads=1)
    assert stamps(locked) == there


def test_a_full_disk_is_one_clear_line_and_what_was_flown_stays(flown_twelve, tmp_path):
    limit = 12_000  # bytes of a file: fewer than one of results has, more than the study's own files have
    sizes = [path.stat().st_size for path in files_of(flown_twelve).values()]
    assert min(sizes) > limit > (flown_twelve / "study.json").stat().st_size
    process = started(TWELVE, tmp_path, largest_file=limit)
    _, errors = process.communicate(timeout=300)
    assert errors.splitlines()[-1].startswith("tandemlift.core.errors.InputError: ")
    assert errors.splitlines()[-1].endswith("cannot be written: File too large; what is done so far stays")
    assert list(tmp_path.glob("chunks/*")) == []
    assert fly(TWELVE, tmp_path) == 12
    assert_same_rows(flown_twelve, tmp_path)


def test_what_a_killed_process_left_behind_is_removed_once_it_is_old(twelve):
    chunks = twelve / "chunks"
    old, new = chunks / ".a.parquet.0123.partial", chunks / ".b.claim"
    for path in (old, new):
        path.touch()
    past = old.stat().st_mtime - 2 * LEFT_OVER
    os.utime(old, (past, past))
    open_folder(load_plan(TWELVE), twelve)
    assert not old.exists()
    assert new.exists()
