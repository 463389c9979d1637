"""On a full disk and at an interrupt an error names the file, and neither half a file nor half a set is left."""

import os
import re
import resource
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

import tandemlift as tl
from tandemlift.codegen import fmu
from tandemlift.core.files import write_files

LARGEST = 4000  # bytes of a file: none of those below is smaller
COMMANDS = {
    "page": ("page", "hover", "--html", "x.html"),
    "C": ("compile", "hover", "--target", "c", "--out", "x"),
    "FMU": ("compile", "hover", "--target", "fmu", "--platforms", "none", "--out", "x"),
    "module": ("compile", "hover", "--target", "wasm32", "--out", "x"),
    "table": ("linearize", "hover", "--out", "x.json"),
    "model": ("export", "paper", "--out", "x.sdf"),
    "flight": ("run", "hover", "--set", "mission.duration=1", "--no-figures", "--out", "x"),
}


def content_of(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.thorough
@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_that_finds_no_space_names_the_file_and_leaves_nothing(name, tmp_path):
    command = [sys.executable, "-m", "tandemlift", *COMMANDS[name]]
    limited = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (LARGEST, LARGEST))
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, preexec_fn=limited)
    assert done.returncode == 2, done.stderr
    last = done.stderr.splitlines()[-1]
    where = "x" if name != "FMU" else "/"  # whose sources do not fit where they are compiled
    assert re.fullmatch(rf"error: {where}\S+: (.*cannot be written: )?File too large", last), last
    assert content_of(tmp_path) == {}


@pytest.mark.parametrize("error", [OSError(28, os.strerror(28)), KeyboardInterrupt()], ids=["full disk", "interrupt"])
def test_a_set_of_files_that_is_not_written_to_its_end_is_not_written(error, tmp_path, monkeypatch):
    written, count = Path.write_bytes, iter(range(9))

    def write_bytes(path, content):
        if next(count):
            raise error
        return written(path, content)

    monkeypatch.setattr(Path, "write_bytes", write_bytes)
    (tmp_path / "b").write_text("before")
    with pytest.raises(type(error)) as raised:
        write_files(tmp_path, {"a": "now", "b": "now"})
    assert getattr(raised.value, "filename", None) == (None if error.args == () else str(tmp_path / "b"))
    assert [path.name for path in tmp_path.iterdir()] == ["b"]
    assert (tmp_path / "b").read_text() == "before"


def test_an_interrupt_while_a_set_of_files_is_moved_waits_for_the_last(tmp_path, monkeypatch):
    replaced, interrupts = Path.replace, [KeyboardInterrupt]

    def replace(path, target):
        done = replaced(path, target)
        if target.parent == tmp_path and interrupts:
            raise interrupts.pop()
        return done

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path, {"a": "1", "b": "2", "c": "3"})
    assert content_of(tmp_path) == {"a": b"1", "b": b"2", "c": b"3"}


def test_a_folder_in_the_place_of_one_file_keeps_all_from_being_written(tmp_path):
    (tmp_path / "b").mkdir()
    with pytest.raises(IsADirectoryError, match="it is a folder") as error:
        write_files(tmp_path, {"a": "", "b": ""})
    assert error.value.filename == str(tmp_path / "b")
    assert [path.name for path in tmp_path.iterdir()] == ["b"]


@pytest.mark.thorough
def test_an_interrupt_leaves_the_fmus_that_were_there(tmp_path, monkeypatch):
    names = [f"hover_{part}.fmu" for part in ("pilot", "vehicle", "flight")]
    for name in names:
        (tmp_path / name).write_text("before")
    described, count = fmu.model_description, iter(range(99))

    def interrupted(*given):
        if next(count) == 4:  # in the third of them
            raise KeyboardInterrupt
        return described(*given)

    monkeypatch.setattr(fmu, "model_description", interrupted)
    with pytest.raises(KeyboardInterrupt):
        tl.compile_mission("hover", "fmu", tmp_path, platforms=["none"])
    assert content_of(tmp_path) == dict.fromkeys(names, b"before")
