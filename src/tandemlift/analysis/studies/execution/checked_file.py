"""The Parquet file of a chunk, with Parquet's checksums of pages: a damaged file, or one of other rows, is rejected."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write

if TYPE_CHECKING:
    import pyarrow

ABOUT = "tandemlift."  # prefix of a file's metadata
CHUNK = f"{ABOUT}chunk"


class DamagedFile(InputError):
    """The error of a file whose content differs from that written for its chunk."""

    def __init__(self, path: Path, why: object) -> None:
        again = "Run the study again: it makes this file anew, and keeps the others"
        super().__init__(f"{path} is damaged: {why}. {again}")


def write_checked(table: pyarrow.Table, path: Path, about: Mapping[str, str]) -> None:
    """Write the file of a chunk atomically.

    Args:
        table: of its rows, at least one.
        path: of the file, whose name without the suffix is that of the chunk.
        about: further metadata of the file.

    Raises:
        InputError: the file cannot be written: no space left, or no right to.
    """
    from pyarrow import BufferOutputStream, parquet

    written = BufferOutputStream()
    named = table.replace_schema_metadata({f"{ABOUT}{key}": value for key, value in about.items()} | {CHUNK: path.stem})
    parquet.write_table(named, written, compression="zstd", row_group_size=len(table), write_page_checksum=True)
    try:
        with atomic_write(path) as partial, partial.open("wb") as file:
            file.write(written.getvalue())
            file.flush()
            os.fsync(file.fileno())  # else a power failure may leave the file's name without all of its content
    except OSError as error:
        why = os.strerror(error.errno) if error.errno else error
        raise InputError(f"{path}: cannot be written: {why}; what is done so far stays") from None


class CheckedFile:
    """The file of a chunk, opened. Each column is checked when it is read.

    Args:
        path: of the file.
        coded: columns to read as codes of their texts.

    Attributes:
        names: of the columns.
        rows: how many there are.
        about: the metadata of the file.

    Raises:
        DamagedFile: the file is not as it was written for this chunk.
        OSError: it cannot be opened.
    """

    def __init__(self, path: Path, coded: Collection[str] = ()) -> None:
        with extra("study", "a study"):
            from pyarrow import ArrowException, OSFile, parquet
        self._path, self._file = path, OSFile(str(path))
        try:
            self._parquet = parquet.ParquetFile(
                self._file, read_dictionary=list(coded), page_checksum_verification=True
            )
            schema = self._parquet.schema_arrow
        except (ArrowException, OSError) as error:
            raise DamagedFile(path, error) from None
        self.names, self.rows, self.about = schema.names, self._parquet.metadata.num_rows, schema.metadata or {}
        if self.about.get(CHUNK.encode()) != path.stem.encode():
            raise DamagedFile(path, "it is not as it was written, or holds other rows")

    def read(self, names: Collection[str] | None = None) -> pyarrow.Table:
        """The existing ones of these columns, by default all, as a PyArrow table.

        Raises:
            DamagedFile: one is not as it was written.
        """
        from pyarrow import ArrowException

        here = self.names if names is None else [name for name in names if name in set(self.names)]
        try:
            return self._parquet.read(columns=here, use_threads=False)
        except (ArrowException, OSError) as error:
            raise DamagedFile(self._path, error) from None
