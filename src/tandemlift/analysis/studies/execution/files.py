"""The files of chunks: one Parquet file each, written atomically; a chunk with a file is finished."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Mapping
from pathlib import Path

from tandemlift.analysis.studies.execution.checked_file import CheckedFile, DamagedFile
from tandemlift.analysis.studies.execution.columns import Columns, write_columns
from tandemlift.core.errors import InputError
from tandemlift.core.files import __version__

LEFT_OVER = 3600.0  # s, after which a half-written file, or a claim, is abandoned


class ChunkFiles:
    """The files of chunks in a folder, by the chunks' names.

    Args:
        path: of the folder.
        about: the metadata of every file, beside its chunk and the version.
    """

    def __init__(self, path: Path, about: Mapping[str, str]) -> None:
        self.path, self._about = path, dict(about)

    def file(self, name: str) -> Path:
        """The path of a chunk's results, whether it exists or not."""
        return self.path / f"{name}.parquet"

    def is_flown(self, name: str) -> bool:
        """Whether a chunk has an intact file; a damaged one is replaced when the chunk is flown.

        Raises:
            InputError: there is a file that this process cannot read.
        """
        path = self.file(name)
        if not path.exists():
            return False
        try:
            CheckedFile(path).check()
        except (FileNotFoundError, DamagedFile):
            return False
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
        return True

    def claim(self, name: str) -> bool:
        """Claim a chunk; False if another process has claimed it, even if that was killed.

        Processes that share the folder treat each other's claims as advice: they fly other chunks first.

        Raises:
            InputError: the folder cannot be written to.
        """
        try:
            self._claim_file(name).touch(exist_ok=False)
        except FileExistsError:
            return False
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written to: {error.strerror or error}") from None
        return True

    def release(self, name: str) -> None:
        """Withdraw the claim of a chunk."""
        with contextlib.suppress(OSError):
            self._claim_file(name).unlink()

    def _claim_file(self, name: str) -> Path:
        return self.path / f".{name}.claim"

    def write(self, name: str, columns: Columns) -> None:
        """Write the results of a chunk atomically.

        Raises:
            InputError: the file cannot be written.
        """
        write_columns(columns, self.file(name), {**self._about, "chunk": name, "version": __version__})

    def clean(self) -> None:
        """Remove the half-written files and the claims of processes that were killed."""
        for path in self.path.glob(".*"):
            with contextlib.suppress(OSError):
                if time.time() - path.stat().st_mtime > LEFT_OVER:
                    path.unlink()
