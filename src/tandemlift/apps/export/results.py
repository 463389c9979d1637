"""The files that commands read and write: flights by their paths, and the folder of results."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from tandemlift.core.errors import InputError
from tandemlift.core.files import FLIGHT_FILE, toml_tables

if TYPE_CHECKING:
    from tandemlift.flight.record import Flight

FIGURES = "figures"  # folder of the figures among results
BAGS = (".bag", ".mcap")


def flight_file(given: str) -> tuple[Path, Path | None]:
    """The folder of a flight's results and the file of the saved flight; the file is None if `given` is a mission."""
    path = Path(given)
    if path.is_dir() and (path / FLIGHT_FILE).exists():
        return path, path / FLIGHT_FILE
    from tandemlift.flight.record import is_flight_file

    if is_flight_file(path):
        return path.parent, path
    return Path("out") / path.stem, None


def file_path(option: str, name: str, *endings: str) -> Path:
    """The path of a file that an option or an argument names, which ends in one of these endings.

    Raises:
        InputError: it has none of the endings, or is a folder.
    """
    path = Path(name)
    if path.suffix.lower() not in endings:
        raise InputError(f"{option} {path}: must end in {' or '.join(endings)}")
    if path.is_dir():
        raise InputError(f"{option} {path}: is a folder, not a file")
    return path


def load_flight(given: str) -> tuple[Flight, Path]:
    """A flight or a bag; the flight, and the default folder of its report.

    Raises:
        InputError: there is no such flight.
    """
    from tandemlift.apps.export.reading import read_bag
    from tandemlift.flight.record import Flight

    path = Path(given)
    if path.suffix.lower() in BAGS or (path / "metadata.yaml").exists():
        if not path.exists():
            raise InputError(f"{given}: there is no such file")
        return read_bag(path), Path("out") / path.stem
    folder, saved = flight_file(given)
    if saved is None:
        raise InputError(
            f"{given}: must be flight.npz, its folder, a bag (.bag, .mcap, or the folder of a ROS 2 bag), or, for a "
            "report, the folder of a study"
        )
    return Flight.load(saved), folder


@contextmanager
def results_folder(out: str | None, default: Path, files: Sequence[str], mission: str | None = None) -> Iterator[Path]:
    """Make the folder for the results before the flight, and remove it again if the flight fails.

    Args:
        out: the folder that the user named; None for the default.
        default: the folder if none is named.
        files: names of the files that will be written.
        mission: the mission that the user named.

    Raises:
        InputError: the folder cannot be made or written to, or the mission's file would be replaced.
    """
    folder = default if out is None else Path(out)
    made: list[Path] = []
    try:
        _make("--out", folder, made)
        _check_free(folder, files)
        _check_kept(folder / "mission.toml", mission)
        yield folder
    except BaseException:
        _remove(made)
        raise


def check_folder(option: str, given: str | None) -> None:
    """Refuse by an `InputError`, before a flight, a folder for its end that cannot be made or written to."""
    made: list[Path] = []
    try:
        if given:
            _make(option, Path(given), made)
    finally:
        _remove(made)


def _remove(made: Sequence[Path]) -> None:
    """Remove folders that were made, as far as they are empty."""
    for path in reversed(made):
        with suppress(OSError):
            path.rmdir()


def _make(option: str, folder: Path, made: list[Path]) -> None:
    """Make a folder that can be written to, and its parents; `made` receives those that are new."""
    try:
        for path in reversed((folder, *folder.parents)):
            if not path.is_dir():
                path.mkdir()
                made.append(path)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"{option} {folder}: {path} is a file, not a folder") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{option} {folder}: cannot be made: {getattr(error, 'strerror', error)}") from None
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{option} {folder}: the folder cannot be written to")


def _check_free(folder: Path, files: Sequence[str]) -> None:
    figures = folder / FIGURES
    in_the_way = [path for path in (folder / name for name in files) if path.is_dir()]
    if figures.exists() and not figures.is_dir():
        in_the_way.append(figures)
    if in_the_way:
        raise InputError(f"--out {folder}: {in_the_way[0]} is in the way of a file or folder of that name")


def _check_kept(written: Path, mission: str | None) -> None:
    """Check that the file of a mission is not replaced by its results, unless it is the one that an earlier run wrote.

    That one has every key, neither comments nor `extends`, and the form of all such files.
    """
    if mission is None or not (written.exists() and Path(mission).exists() and written.samefile(mission)):
        return
    from tandemlift.missions import format_toml

    text = written.read_text("utf-8-sig")
    tables = toml_tables(text)
    if "extends" in tables or text != format_toml(tables):
        raise InputError(f"--out {written.parent}: the results would replace {mission}: give another folder")


def read_curves(path: Path, wanted: Iterable[str]) -> tuple[Flight, list[str]]:
    """Curves from a table, as a flight with those channels only, and the names of the columns that were left out.

    A column has the name of `Flight.to_pandas`, such as `position_x`, or of an export to .csv, such as `position[m].x`,
    and the channel's unit. An empty cell is a gap.

    Args:
        path: of a .csv file with a line of names, `time` [s] among them.
        wanted: channels to read, and errors in `DERIVED`.

    Raises:
        InputError: it is no table of numbers, `time` does not rise, or none of the columns is a wanted one.
    """
    import numpy as np

    from tandemlift.analysis.logs.maps import TableSettings
    from tandemlift.apps.export.text_tables import read_table
    from tandemlift.flight.channels import DERIVED, channel_of, column_names
    from tandemlift.flight.record import Flight

    settings = TableSettings()
    columns = list(read_table(path, ("time", "time[s]"), settings).columns(""))
    given = {re.sub(r"\[[^]]*\]", "", name).replace(".", "_"): name for name in columns}
    if len(given) < len(columns):
        twice = next(name for name in columns if name not in given.values())
        raise InputError(f"{path}: {twice} is a column under two names; one must go")
    if "time" not in given:
        raise InputError(f"{path}: has no column time [s]; it has {', '.join(given)}")
    table = read_table(path, columns, settings)
    time, channels, read = table.column("", given["time"]), {}, {given["time"]}
    if len(time) < 2 or not (np.diff(time) > 0.0).all():
        raise InputError(f"{path}: time must rise from line to line, in two lines at least")
    names = {}
    for name in wanted:
        info = DERIVED[name][2] if name in DERIVED else channel_of(name)
        names[name] = column_names(name, info, (info.width,) if info.width > 1 else ())
        if {*names[name]} & {*given}:
            parts = [table.column("", given[n]) if n in given else np.full(len(time), np.nan) for n in names[name]]
            channels[name] = np.column_stack(parts) if info.width > 1 else parts[0]
            read |= {given[n] for n in names[name] if n in given}
    if not channels:
        known = ", ".join(name for many in names.values() for name in many)
        raise InputError(f"{path}: none of its columns is drawn; those that are: {known}")
    return Flight(time, channels, {"mission": {"name": path.stem}}, {}), [n for n in given.values() if n not in read]
