"""A report as PDF, which Typst sets from a source and its data in one folder."""

from __future__ import annotations

from pathlib import Path

from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write

SOURCE = "report.typ"


def check_typesetting() -> None:
    """Find out whether the PDF can be set.

    Raises:
        InputError: the package that sets it is not installed.
    """
    with extra("paper", "a report as PDF"):
        import typst  # noqa: F401


def typeset(folder: Path, path: Path) -> None:
    """Set the report in a folder as a PDF; the same files give the same bytes.

    Raises:
        InputError: the package that sets it is not installed, or is too old to place figures in PDF.
    """
    check_typesetting()
    import typst

    try:
        pdf = typst.compile(folder / SOURCE, ignore_system_fonts=True, timestamp=0)
    except typst.TypstError as error:
        raise InputError(f"{folder / SOURCE} cannot be set by typst, 0.14 or newer: {error.message}") from error
    with atomic_write(path) as partial:
        partial.write_bytes(pdf)
