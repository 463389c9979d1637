"""The folder of a flight's results: made before the flight; only our own files in it are replaced."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from tandemlift.apps.cli.terminal.console import progress_bar
from tandemlift.core.errors import InputError
from tandemlift.core.files import atomic_write

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight

FILES = ("mission.toml", "flight.npz", "metrics.json", "metrics.csv", "metrics.tex", "findings.json", "report.html")
FIGURES = "figures"  # folder of the figures


@contextmanager
def results_folder(out: str | None, default: Path, files: Sequence[str] = FILES) -> Iterator[Path]:
    """Make the folder for the results before the flight, and remove it again if the flight fails.

    Args:
        out: the folder that the user named; None for the default.
        default: the folder if none is named.
        files: names of the files that will be written.

    Raises:
        InputError: the folder cannot be made or written to.
    """
    folder = default if out is None else Path(out)
    made: list[Path] = []
    try:
        _make(folder, made)
        _check_writable(folder, files)
        yield folder
    except BaseException:
        for path in reversed(made):
            with suppress(OSError):
                path.rmdir()
        raise


def _make(folder: Path, made: list[Path]) -> None:
    """Make a folder and its parents; `made` receives those that are new."""
    try:
        for path in reversed((folder, *folder.parents)):
            if not path.is_dir():
                path.mkdir()
                made.append(path)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"--out {folder}: {path} is a file, not a folder") from None
    except (OSError, ValueError) as error:
        raise InputError(f"--out {folder}: cannot be made: {getattr(error, 'strerror', error)}") from None


def _check_writable(folder: Path, files: Sequence[str]) -> None:
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"--out {folder}: the folder cannot be written to")
    figures = folder / FIGURES
    in_the_way = [path for path in (folder / name for name in files) if path.is_dir()]
    if figures.exists() and not figures.is_dir():
        in_the_way.append(figures)
    if in_the_way:
        raise InputError(f"--out {folder}: {in_the_way[0]} is in the way of a file or folder of that name")


def write_flight(flight: Flight, folder: Path, *, figures: bool, photographs: Sequence[tuple[str, bytes]] = ()) -> None:
    """Write the files of a flight into the folder, with a progress bar for the figures."""
    from tandemlift.pictures.report.flight_report import write_flight_files

    with progress_bar("Drawing", "figures", shown=figures and sys.stderr.isatty()) as progress:
        write_flight_files(flight, folder, figures=figures, photographs=photographs, progress=progress)


def copy_recording(path: str | None, folder: Path) -> None:
    """Copy the recording of a mission, if there is one, into the folder, so that the folder can be flown anywhere."""
    from tandemlift.missions.recording import recording_bytes

    if path is None:
        return
    with atomic_write(folder / Path(path).name) as partial:
        partial.write_bytes(recording_bytes(path))


def flight_file(given: str) -> tuple[Path, Path | None]:
    """The folder of a flight's results and the file of the saved flight; the file is None if `given` is a mission."""
    path = Path(given)
    if path.is_dir() and (path / "flight.npz").exists():
        return path, path / "flight.npz"
    if path.suffix == ".npz":
        return path.parent, path
    return Path("out") / path.stem, None


def html_path(option: str, name: str) -> Path:
    """The path of a page that an option names.

    Raises:
        InputError: no page can be written there.
    """
    path = Path(name)
    if path.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{option} {path}: the name of a page must end in .html")
    if path.is_dir():
        raise InputError(f"{option} {path}: is a folder, not a file")
    return path
