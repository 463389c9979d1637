"""Exported worlds as Gazebo's own checker reads them."""

import shutil
import tempfile
from pathlib import Path

import pytest
from patience import completed

import tandemlift as tl
from tandemlift.apps.export.write import export
from tandemlift.engines.gazebo_server import root, shell_command, with_gazebo_environment

pytestmark = pytest.mark.gazebo


@pytest.fixture
def folder():
    """A folder that Gazebo can see: its path for us, and for Gazebo."""
    inside = root()
    path = Path(tempfile.mkdtemp(prefix="tandemlift-", dir=inside / "tmp" if inside else None))
    yield path, Path("/tmp") / path.name if inside else path
    shutil.rmtree(path)


def check(seen):
    script = with_gazebo_environment("http://127.0.0.1:1", f"gz sdf -k {seen} 2>&1")
    return completed(shell_command(root(), script), capture_output=True, text=True, check=False).stdout


@pytest.mark.parametrize(("name", "plugin"), [("four", None), ("heavy-payload", 19110), ("zigzag", "ros")])
def test_gazebo_finds_no_fault_with_a_world(name, plugin, folder):
    path, seen = folder
    export(tl.load_mission(name), path / "it.sdf", plugin=plugin)
    said = check(seen / "it.sdf")
    assert "Check complete" in said
    assert "rror" not in said
    assert "arning" not in said


def test_gazebo_does_find_faults(folder):
    path, seen = folder
    text = export(tl.load_mission("paper"), path / "it.sdf").read_text("utf-8")
    (path / "it.sdf").write_text(text.replace('<model name="tandemlift">', "<model>"), "utf-8")
    assert "rror" in check(seen / "it.sdf")
