"""An answer opens no file below a folder `solutions`, however deep, and its own notebook it may read."""

import json
import multiprocessing
from pathlib import Path

import pytest

from tandemlift.apps.teaching import running


def opened(own: str, path: str, pipe) -> None:
    """In a process of its own, as the guard stays: what the guard says of opening a file."""
    tried = running._guard(Path(own))
    try:
        Path(path).read_text("utf-8")
        pipe.send((tried, "read"))
    except BaseException as error:
        pipe.send((tried, type(error).__name__))


def guarded(own: Path, path: Path):
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=opened, args=(str(own), str(path), there))
    process.start()
    said = here.recv() if here.poll(60) else None
    process.kill()
    process.join()
    return said


@pytest.mark.parametrize(
    "path", ["solutions/1.py", "solutions/1.ipynb", "solutions/more/deep/1.py", "solutions/more/1.ipynb"]
)
@pytest.mark.parametrize("is_link", [False, True])
def test_solutions_and_notebooks_below_them_are_named_as_solutions(tmp_path, path, is_link):
    file = tmp_path / path
    file.parent.mkdir(parents=True)
    file.write_text("{}", "utf-8")
    asked = tmp_path / "notes.txt" if is_link else file
    if is_link:
        asked.symlink_to(file)
    tried, end = guarded(tmp_path / "own.ipynb", asked)
    assert (tried, end) == ([f"reads the solution ({file.name})"], "_Forbidden")


def test_its_own_notebook_and_a_file_called_solutions_may_be_read_but_no_other_notebook(tmp_path):
    own, other, named = tmp_path / "own.ipynb", tmp_path / "other.ipynb", tmp_path / "solutions"
    for file in (own, other, named):
        file.write_text(json.dumps({}), "utf-8")
    assert guarded(own, own) == ([], "read")
    assert guarded(own, named) == ([], "read")
    assert guarded(own, other) == (["reads another notebook (other.ipynb)"], "_Forbidden")
