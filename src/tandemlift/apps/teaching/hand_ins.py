"""What a class has handed in: notebooks and scripts of exercises, and whatever else lies in its folder."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from types import CodeType
from typing import NamedTuple

from tandemlift.apps.teaching.grading import CHECKS
from tandemlift.core.errors import InputError

NOTEBOOK, SCRIPT = ".ipynb", ".py"
ARCHIVES = (".zip", ".7z", ".rar", ".tar", ".gz", ".tgz")
LEFT_OUT = {"page", "check", "look"}  # tags of cells that grading does not run
MAX_BYTES = 64 << 20  # bytes of a file


class Notebook(NamedTuple):
    """A notebook or a script that was handed in: by whom, its exercise, and its file."""

    name: str
    exercise: str
    path: Path


class Skipped(NamedTuple):
    """What was handed in and cannot be graded: by whom, the path within the folder, and the reason."""

    name: str
    path: Path
    reason: str

    def __str__(self) -> str:
        return f"{self.path}: {self.reason}, and was skipped"


def notebooks_in(folder: Path, exercises: Path) -> tuple[list[Notebook], list[Skipped]]:
    """What a class handed in: notebooks, and scripts called as an exercise; and what cannot be graded.

    Every entry of the folder is in one of the lists, apart from hidden ones.

    Raises:
        InputError: there is no such folder, or nothing in it, or none of `exercises` has checks.
    """
    names = {checks.parent.name for checks in exercises.glob(f"*/{CHECKS}")}
    if not names:
        raise InputError(f"--exercises {exercises}: must hold a folder for each exercise, with a {CHECKS}; has none")
    if not folder.is_dir():
        raise InputError(f"{folder}: {'is a file, not a folder' if folder.exists() else 'there is no such folder'}")
    found, skipped = list[Notebook](), list[Skipped]()
    for entry in sorted(path for path in folder.iterdir() if not path.name.startswith(".")):
        name, before = entry.name if entry.is_dir() else entry.stem, len(found) + len(skipped)
        name = name.removesuffix(NOTEBOOK)
        for path in _files_of(entry, names):
            try:
                exercise = exercise_of(path)
                if exercise not in names:
                    raise InputError(f"is of exercise {exercise!r}, which is not in {exercises}")
                found.append(Notebook(name, exercise, path))
            except InputError as error:
                skipped.append(Skipped(name, path.relative_to(folder), str(error)))
        if len(found) + len(skipped) == before:
            skipped.append(Skipped(name, entry.relative_to(folder), _reason(entry)))
    if not found and not skipped:
        raise InputError(f"{folder}: must hold notebooks ({NOTEBOOK}), one or a folder for each participant; has none")
    return found, skipped


def _files_of(entry: Path, names: set[str]) -> Iterator[Path]:
    """The notebooks of an entry of the folder, and the scripts that are called as an exercise."""
    within = [entry] if entry.is_symlink() or not entry.is_dir() else sorted(entry.rglob("*"))
    for path in within:
        hidden = any(part.startswith(".") for part in path.relative_to(entry).parts)
        is_script = path.suffix == SCRIPT and path.stem in names
        if not hidden and not path.is_dir() and (path.suffix.lower() == NOTEBOOK or is_script):
            yield path


def _reason(entry: Path) -> str:
    """Why there is nothing to grade in an entry of the folder."""
    if not entry.is_dir():
        what = "an archive: unpack it into a folder" if entry.suffix.lower() in ARCHIVES else "no notebook"
        return f"is {what}" if entry.suffix != SCRIPT else "is a script that is not called as an exercise"
    if entry.is_symlink():
        return "is a link to a folder, which is not followed"
    archives = [path.name for path in sorted(entry.rglob("*")) if path.suffix.lower() in ARCHIVES]
    return f"holds no notebook, but an archive, {archives[0]}: unpack it" if archives else "holds no notebook"


def exercise_of(path: Path) -> str:
    """The exercise of a notebook, from its metadata, or of a script, from its name.

    Raises:
        InputError: it cannot be read, is damaged or of no exercise; with the reason.
    """
    return _read(path)[0]


def cells_of(path: Path) -> Iterator[tuple[str, CodeType | SyntaxError]]:
    """The code cells that grading runs, with their names; a script is one.

    Raises:
        InputError: as `exercise_of`.
    """
    for name, source in _read(path)[1]:
        yield name, _compiled(source, name)


def _read(path: Path) -> tuple[str, list[tuple[str, str]]]:
    """The exercise and the cells of a file, with their names."""
    try:
        if not path.is_file():
            raise InputError("is no file")
        if path.stat().st_size > MAX_BYTES:
            raise InputError(f"has more than {MAX_BYTES >> 20} MiB")
        text = path.read_text("utf-8")
        if path.suffix == SCRIPT:
            return path.stem, [(f"file {path.name}", text)]
        whole = json.loads(text)
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror or error}") from None
    except InputError:
        raise
    except (ValueError, RecursionError):  # also of bytes that are no text
        what = "text" if path.suffix == SCRIPT else "JSON"
        raise InputError(f"is no readable {what}, as of a file that is damaged or not whole") from None
    try:
        exercise = str(whole["metadata"]["tandemlift"]["exercise"])
    except (KeyError, TypeError):
        raise InputError("is a notebook of no exercise") from None
    cells, number = list[tuple[str, str]](), 0
    try:
        for number, cell in enumerate(whole["cells"], 1):
            tags = cell.get("metadata", {}).get("tags", ())
            if cell["cell_type"] == "code" and not LEFT_OUT & set(tags):
                cells.append((f"cell {number}", "".join(cell["source"])))
    except (KeyError, TypeError, AttributeError):
        where = f"cell {number} is not as in a notebook" if number else "it has no list of cells"
        raise InputError(f"is damaged: {where}") from None
    return exercise, cells


def _compiled(source: str, name: str) -> CodeType | SyntaxError:
    """The code of a cell; a line that Python refuses and only IPython reads, with %, ! or ?, does nothing."""
    lines = source.splitlines()
    while True:
        try:
            return compile("\n".join(lines), name, "exec")
        except SyntaxError as error:
            at = (error.lineno or 0) - 1
            if not 0 <= at < len(lines) or not re.match(r"\s*([%!?]|[\w.*]+\?\??\s*$)", lines[at]):
                return error
            lines[at] = re.sub(r"\S.*", "pass", lines[at])
        except (ValueError, RecursionError, MemoryError, OverflowError) as error:  # of characters, or too deep
            return SyntaxError(str(error) or "it is nested too deeply")
