"""The Parquet files of a study as one table: chosen columns, file by file, so that memory holds these alone."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tandemlift.common.errors import InputError, unknown
from tandemlift.common.extras import extra

if TYPE_CHECKING:
    import pyarrow

CHANNEL = "flight."  # how the name of a kept channel's column begins
CODED = ("mission", "controller", "engine", "case", "outcome", "finding_kinds")  # few different texts in many rows
MARK = b"PAR1"  # with which a whole Parquet file begins and ends


class UnitFile(NamedTuple):
    """A file of results, and its rows: first ≤ row < last."""

    path: Path
    first: int
    last: int


def check_whole(path: Path) -> None:
    """Check that a file begins and ends as a Parquet file does.

    Raises:
        InputError: it does not, or cannot be read.
    """
    try:
        with path.open("rb") as file:
            begin = file.read(len(MARK))
            file.seek(-min(len(MARK), file.seek(0, 2)), 2)
            end = file.read()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}") from None
    if (begin, end) != (MARK, MARK):
        raise _damaged(path, "it is cut short, or no Parquet file")


def _damaged(path: Path, why: object) -> InputError:
    return InputError(f"{path} is damaged: {why}. Run the study again: it makes this file anew, and keeps the others")


def schema_of(files: Sequence[UnitFile]) -> pyarrow.Schema:
    """The columns of all files together; of the first and the last, which have those of the first and last mission."""
    with extra("study", "load_study"):
        import pyarrow
    found = [_opened(file, ()).schema_arrow for file in (files[:1] + files[-1:])]
    return pyarrow.unify_schemas(found, promote_options="permissive") if found else pyarrow.schema([])


def _opened(file: UnitFile, coded: Collection[str]) -> Any:
    """A file as PyArrow opens it, with some columns as codes of their texts."""
    with extra("study", "load_study"):
        import pyarrow
        from pyarrow import parquet
    try:
        return parquet.ParquetFile(file.path, read_dictionary=list(coded))
    except (OSError, pyarrow.ArrowInvalid) as error:
        raise _damaged(file.path, error) from None


def _read(file: UnitFile, names: Sequence[str], coded: Collection[str]) -> pyarrow.Table:
    """Chosen columns of a file, of those that it has."""
    with extra("study", "load_study"):
        import pyarrow
    opened = _opened(file, coded)
    here = [name for name in names if name in opened.schema_arrow.names]
    try:
        table = opened.read(columns=here, use_threads=False)
    except (OSError, pyarrow.ArrowInvalid) as error:
        raise _damaged(file.path, error) from None
    if len(table) != file.last - file.first:
        raise _damaged(file.path, f"it has {len(table)} rows in place of {file.last - file.first}")
    return table


def tables(files: Sequence[UnitFile], names: Sequence[str], coded: Collection[str] = ()) -> Iterator[pyarrow.Table]:
    """Chosen columns, a table for each file, in the order of the rows."""
    return (_read(file, names, coded) for file in files)


def read(files: Sequence[UnitFile], names: Sequence[str], *, coded: bool = False) -> pyarrow.Table:
    """Chosen columns of all files as one table, in the order of the rows.

    Args:
        files: of a study, in the order of their rows.
        names: of columns; null in rows of a file that lacks one.
        coded: whether columns with few different texts hold codes of them, which takes little memory.

    Raises:
        InputError: there is no such column, a file is damaged, or PyArrow is not installed (extra: study).
    """
    with extra("study", "load_study"):
        import pyarrow
    schema = schema_of(files)
    for name in names:
        if name not in schema.names:
            raise unknown("column", name, schema.names)
    codes = [name for name in names if name in CODED] if coded else []
    parts = list(tables(files, names, codes))
    whole = pyarrow.concat_tables(parts, promote_options="permissive") if parts else schema.empty_table()
    return whole.select(list(names)).unify_dictionaries()
