"""Files that belong together, such as those of a flight: all are written, or none."""

from __future__ import annotations

import errno
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from tandemlift.core.files import aside, write_file


@contextmanager
def write_together(folder: Path) -> Iterator[Path]:
    """A temporary folder to write to; its files are moved to `folder` at the end: all, or none if writing fails."""
    with aside(folder, folder / "files") as partial:
        partial.mkdir(parents=True)
        yield partial
        _move({path: folder / path.relative_to(partial) for path in partial.rglob("*") if path.is_file()})


def write_files(folder: Path, contents: Mapping[str, str | bytes]) -> list[Path]:
    """Write whole files, by their names, into a folder: all, or none if writing fails; their paths."""
    with write_together(folder) as partial:
        for name, content in contents.items():
            write_file(partial / name, content)
    return [folder / name for name in contents]


def _move(files: Mapping[Path, Path]) -> None:
    """Move all files to their places, or none if a folder is in one; an interrupt is raised after the last."""
    for path in files.values():
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder", str(path))
    try:
        for partial, path in files.items():
            if partial.exists():  # not moved yet
                path.parent.mkdir(parents=True, exist_ok=True)
                partial.replace(path)
    except KeyboardInterrupt:
        _move(files)
        raise
