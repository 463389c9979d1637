"""The folder of a flight's results: made before the flight, and only our own files in it replaced."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.cli.notices import compile_notices
from tandemlift.common.errors import InputError
from tandemlift.common.files import atomic_write

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission

FILES = ("mission.toml", "flight.npz", "metrics.json", "report.html")


@contextmanager
def results_in(out: str | None, default: Path, files: Sequence[str] = FILES) -> Iterator[Path]:
    """The folder for the results, made before the flight; unmade if nothing comes of it. `files` will be written.

    Raises:
        InputError: it cannot be made or written to.
    """
    folder = default if out is None else Path(out)
    made: list[Path] = []
    try:
        _make(folder, made)
        _check_room(folder, files)
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


def _check_room(folder: Path, files: Sequence[str]) -> None:
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"--out {folder}: the folder cannot be written to")
    figures = folder / "figures"
    in_the_way = [path for path in (folder / name for name in files) if path.is_dir()]
    if files is FILES and figures.exists() and not figures.is_dir():
        in_the_way.append(figures)
    if in_the_way:
        raise InputError(f"--out {folder}: {in_the_way[0]} is in the way of a file or folder of that name")


def write_results(flight: Flight, folder: Path, *, figures: bool, views: Figure | None = None) -> None:
    """Write all that `tandemlift run` leaves behind, and photographs if given, replacing what an earlier run left."""
    from tandemlift.figures.drawing.style import save
    from tandemlift.figures.registry import VIEWS, captions, figures_of, save_figures
    from tandemlift.missions import format_toml
    from tandemlift.report.flight_report import write_report

    with atomic_write(folder / "mission.toml") as partial:
        partial.write_text(format_toml(flight.mission), "utf-8")
    flight.save(folder / "flight.npz")
    with atomic_write(folder / "metrics.json") as partial:
        partial.write_text(json.dumps(flight.metrics(), indent=2, allow_nan=False) + "\n", "utf-8")
    for name in captions():
        for kind in ("png", "pdf"):
            (folder / "figures" / f"{name}.{kind}").unlink(missing_ok=True)
    if figures:
        with bar("Drawing", len(figures_of(flight)), shown=sys.stderr.isatty()) as progress:
            save_figures(flight, folder / "figures", progress)
    if views:
        (folder / "figures").mkdir(exist_ok=True)
        save(views, folder / "figures" / f"{VIEWS}.png")
    write_report(flight, folder / "figures", folder / "report.html")


def keep_recording(mission: Mission, folder: Path) -> None:
    """Put the recording of a mission, if it has one, beside its file, so that the folder flies again wherever it is."""
    if mission.person.recording is None:
        return
    source = Path(mission.person.recording)
    with atomic_write(folder / source.name) as partial:
        shutil.copyfile(source, partial)


def flight_file(given: str) -> tuple[Path, Path | None]:
    """The folder of a flight's results, and the file of a saved flight, or None if a mission is given."""
    path = Path(given)
    if path.is_dir() and (path / "flight.npz").exists():
        return path, path / "flight.npz"
    if path.suffix == ".npz":
        return path.parent, path
    return Path("out") / path.stem, None


@contextmanager
def bar(label: str, length: int, *, shown: bool = True) -> Iterator[Callable[[int, int], None] | None]:
    """A progress bar on standard error as a callback of (done, total), or None."""
    if not shown:
        yield None
        return
    with compile_notices.together(), click.progressbar(length=length, label=label, file=sys.stderr) as bar:
        yield lambda done, total: bar.update(done - bar.pos)
