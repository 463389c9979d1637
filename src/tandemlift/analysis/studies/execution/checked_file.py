"""The Parquet file of a chunk, with checksums: a damaged file, or one of other rows, is rejected.

Parquet's own checksums leave out the headers of pages and the footer. So each column has a checksum here, and these,
the footer and the name of the chunk have one together. They precede the footer, where readers ignore them:

    columns | checksum of each column, and their number | checksum of what is beside it, and of the name | footer
"""

from __future__ import annotations

import hashlib
import itertools
import os
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write

if TYPE_CHECKING:
    import pyarrow

SIZE = 16  # bytes of a checksum
NUMBER = 4  # bytes of the number of columns
ENDING = 8  # bytes of the length of the footer, and of the mark


class DamagedFile(InputError):
    """The error of a file whose content differs from that written for its chunk."""

    def __init__(self, path: Path, why: object) -> None:
        again = "Run the study again: it makes this file anew, and keeps the others"
        super().__init__(f"{path} is damaged: {why}. {again}")


def write_checked(table: pyarrow.Table, path: Path) -> None:
    """Write the file of a chunk atomically.

    Args:
        table: of its rows, at least one.
        path: of the file, whose name without the suffix is that of the chunk.

    Raises:
        InputError: the file cannot be written: no space left, or no right to.
    """
    from pyarrow import BufferOutputStream, parquet

    written = BufferOutputStream()
    parquet.write_table(table, written, compression="zstd", row_group_size=len(table), write_page_checksum=True)
    content = _with_checksums(written.getvalue().to_pybytes(), path.stem)
    try:
        with atomic_write(path) as partial, partial.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())  # else a power failure may leave the file's name without all of its content
    except OSError as error:
        why = os.strerror(error.errno) if error.errno else error
        raise InputError(f"{path}: cannot be written: {why}; what is done so far stays") from None


def _with_checksums(content: bytes, chunk: str) -> bytes:
    from pyarrow import BufferReader, parquet

    end = len(content) - ENDING - _footer_size(content[-ENDING:])
    metadata = parquet.read_metadata(BufferReader(content))
    sums = [_checksum(content[first:last]) for first, last in _places(metadata, end)]
    before, behind = b"".join(sums) + len(sums).to_bytes(NUMBER, "little"), content[end:]
    return content[:end] + before + _checksum(chunk.encode(), before, behind) + behind


class CheckedFile:
    """The file of a chunk, opened. Its footer is checked at once, and each column before it is read.

    Args:
        path: of the file.
        coded: columns to read as codes of their texts.

    Attributes:
        names: of the columns.
        rows: how many there are.
        about: the metadata of the file.

    Raises:
        DamagedFile: the file is not as it was written for this chunk.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path, coded: Collection[str] = ()) -> None:
        with extra("study", "a study"):
            from pyarrow import OSFile, parquet
        self._path, self._file = path, OSFile(str(path))
        end, self._sums = self._checked_end()
        self._parquet = parquet.ParquetFile(self._file, read_dictionary=list(coded), page_checksum_verification=True)
        self._places = _places(self._parquet.metadata, end)
        schema = self._parquet.schema_arrow
        self.names, self.rows, self.about = schema.names, self._parquet.metadata.num_rows, schema.metadata or {}

    def _checked_end(self) -> tuple[int, bytes]:
        """The end of the columns, and their checksums."""
        size = self._file.size()
        footer = size - ENDING - _footer_size(self._bytes(size - ENDING, size))
        number = int.from_bytes(self._bytes(footer - SIZE - NUMBER, footer - SIZE), "little")
        end = footer - SIZE - NUMBER - SIZE * number
        before, behind = self._bytes(end, footer - SIZE), self._bytes(footer, size)
        if self._bytes(footer - SIZE, footer) != _checksum(self._path.stem.encode(), before, behind):
            raise DamagedFile(self._path, "it is not as it was written, or holds other rows")
        return end, before

    def _bytes(self, first: int, last: int) -> bytes:
        if first < 0:
            raise DamagedFile(self._path, "it is cut short, or no Parquet file")
        content: bytes = self._file.read_at(last - first, first)
        return content

    def check(self, names: Collection[str] | None = None) -> None:
        """Check columns, by default all.

        Raises:
            DamagedFile: one is not as it was written.
        """
        for i, (name, place) in enumerate(zip(self.names, self._places, strict=True)):
            asked = names is None or name in names
            if asked and _checksum(self._bytes(*place)) != self._sums[i * SIZE : (i + 1) * SIZE]:
                raise DamagedFile(self._path, f"column {name} is not as it was written")

    def read(self, names: Collection[str]) -> pyarrow.Table:
        """The existing ones of these columns as a PyArrow table; errors as of `check`, and an OSError."""
        known = set(self.names)
        here = [name for name in names if name in known]
        self.check(set(here))
        return self._parquet.read(columns=here, use_threads=False)


def _checksum(*parts: bytes) -> bytes:
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part)
    return digest.digest()[:SIZE]


def _footer_size(ending: bytes) -> int:
    return int.from_bytes(ending[:4], "little")


def _places(metadata: Any, end: int) -> list[tuple[int, int]]:
    """The bytes first ≤ number < last of each column, which are all of the file up to `end`."""
    columns = [metadata.row_group(0).column(i) for i in range(metadata.num_columns)]
    starts = [c.dictionary_page_offset if c.has_dictionary_page else c.data_page_offset for c in columns]
    return list(itertools.pairwise([0, *starts[1:], end]))
