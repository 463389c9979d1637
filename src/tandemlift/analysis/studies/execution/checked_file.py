"""The Parquet file of a chunk: a damaged file, or one of other rows, is rejected.

Parquet has checksums of pages, but none of the footer, which names the columns, their types and places. Its SHA-256
stands in front of it, where readers of Parquet do not look: they find everything by places in the footer.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write

if TYPE_CHECKING:
    import pyarrow

PREFIX = "tandemlift."  # prefix of a file's metadata
CHUNK, FOOTER = f"{PREFIX}chunk", f"{PREFIX}footer"
DIGEST = hashlib.sha256  # of the footer; older files have none


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
    said = {f"{PREFIX}{key}": value for key, value in about.items()} | {CHUNK: path.stem, FOOTER: DIGEST().name}
    named = table.replace_schema_metadata(said)
    parquet.write_table(named, written, compression="zstd", row_group_size=len(table), write_page_checksum=True)
    content = memoryview(written.getvalue())
    footer = content[-_footer_size(content[-8:]) :]
    try:
        with atomic_write(path) as partial, partial.open("wb") as file:
            file.write(content[: -len(footer)])
            file.write(DIGEST(footer).digest() + footer)
            file.flush()
            os.fsync(file.fileno())  # else a power failure may leave the file's name without all of its content
    except OSError as error:
        why = os.strerror(error.errno) if error.errno else error
        raise InputError(f"{path}: cannot be written: {why}; what is done so far stays") from None


def _footer_size(end: bytes | memoryview) -> int:
    """Bytes from the footer to the end of a file, by its last eight: the footer's length, and a mark."""
    return int.from_bytes(end[:4], "little") + 8


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
            self.names, self.rows, self.about = schema.names, self._parquet.metadata.num_rows, schema.metadata or {}
        except (ArrowException, OSError, ValueError) as error:  # also a column's name that is no text
            raise DamagedFile(path, error) from None
        if self.about.get(CHUNK.encode()) != path.stem.encode():
            raise DamagedFile(path, "it is not as it was written, or holds other rows")
        if FOOTER.encode() in self.about and not self._footer_is_whole():
            raise DamagedFile(path, "its footer, with the names of its columns, is not as it was written")

    def _footer_is_whole(self) -> bool:
        size, width = self._file.size(), DIGEST().digest_size
        self._file.seek(size - 8)
        footer = _footer_size(self._file.read())
        self._file.seek(size - footer - width)
        return bool(self._file.read(width) == DIGEST(self._file.read()).digest())

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
