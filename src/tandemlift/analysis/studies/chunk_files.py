"""The Parquet files of a study as one table: chosen columns, file by file, so that memory holds these alone."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tandemlift.analysis.studies.execution.checked_file import PREFIX, CheckedFile, DamagedFile
from tandemlift.core.errors import extra, unknown
from tandemlift.core.types import Array

if TYPE_CHECKING:
    import pyarrow

CODED = ("mission", "controller", "engine", "case", "outcome", "finding_kinds")  # few different texts in many rows
THREADS = 4  # that read files; PyArrow reads without Python


class ChunkFile(NamedTuple):
    """A file of results, and its rows: first ≤ row < last."""

    path: Path
    first: int
    last: int


def _opened(file: ChunkFile, coded: Collection[str] = ()) -> CheckedFile:
    """A file, with some columns as codes of their texts."""
    try:
        return CheckedFile(file.path, coded)
    except OSError as error:
        raise DamagedFile(file.path, error) from None


def floats_of(column: pyarrow.ChunkedArray) -> Array:
    """A column of numbers or truths as floats; NaN for null."""
    return np.asarray(column.cast("float64").to_numpy(zero_copy_only=False), np.float64)


def columns_in(files: Iterable[ChunkFile]) -> tuple[str, ...]:
    """The columns of all files together, in the order in which they first come."""
    with ThreadPoolExecutor(THREADS) as pool:
        names = pool.map(lambda file: _opened(file).names, files)
        return tuple(dict.fromkeys(itertools.chain.from_iterable(names)))


def about(file: ChunkFile) -> dict[str, str]:
    """The metadata of a file: study, chunk, sources and version of tandemlift."""
    said = {key.decode(): value.decode() for key, value in _opened(file).about.items()}
    return {key.removeprefix(PREFIX): value for key, value in said.items() if key.startswith(PREFIX)}


def _read_file(file: ChunkFile, names: Sequence[str], coded: Collection[str]) -> pyarrow.Table:
    """Chosen columns of a file, of those that it has."""
    opened = _opened(file, coded)
    table: pyarrow.Table = opened.read(names)
    if opened.rows != file.last - file.first:
        raise DamagedFile(file.path, f"it has {opened.rows} rows in place of {file.last - file.first}")
    return table


def read(
    files: Sequence[ChunkFile], names: Sequence[str], *, coded: bool = False, known: Collection[str] = ()
) -> pyarrow.Table:
    """Chosen columns of all files as one table, in the order of the rows.

    Args:
        files: of a study, in the order of their rows.
        names: of columns; null in rows of a file that lacks one.
        coded: whether columns with few different texts hold codes of them, which takes less memory.
        known: columns of other files of the study, which these may lack.

    Raises:
        InputError: there is no such column, a file is damaged, or PyArrow is not installed (extra: study).
    """
    codes = [name for name in names if name in CODED] if coded else []
    with ThreadPoolExecutor(THREADS) as pool:
        parts = list(pool.map(lambda file: _read_file(file, names, codes), files))
    here = {name for part in parts for name in part.column_names}.union(known)
    if files and (missing := [name for name in names if name not in here]):
        raise unknown("column", missing[0], known or columns_in(files))
    with extra("study", "load_study"):
        import pyarrow
    columns = {name: _joined(parts, name) for name in names}
    return pyarrow.table(columns).unify_dictionaries()


def _joined(parts: Sequence[pyarrow.Table], name: str) -> pyarrow.ChunkedArray:
    """A column of all files; of one type, although a file in which it is empty has another one."""
    import pyarrow

    found = [part[name] if name in part.column_names else None for part in parts]
    kinds = {column.type for column in found if column is not None and column.null_count < len(column)}
    kind = kinds.pop() if len(kinds) == 1 else _common_type(kinds)
    chunks = list[Any]()
    for part, column in zip(parts, found, strict=True):
        if column is None or column.null_count == len(column):
            chunks.append(pyarrow.nulls(part.num_rows, kind))
        else:
            chunks += column.cast(kind).chunks
    return pyarrow.chunked_array(chunks, kind)


def _common_type(kinds: Iterable[pyarrow.DataType]) -> pyarrow.DataType:
    """The common type of several types: numbers if all are, else texts; numbers for none."""
    import pyarrow

    numbers = all(pyarrow.types.is_integer(kind) or pyarrow.types.is_floating(kind) for kind in kinds)
    return pyarrow.float64() if numbers else pyarrow.string()
