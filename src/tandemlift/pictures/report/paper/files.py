"""The files of the report: its figures, tables and source in a folder, and the PDF that Typst sets from them."""

from __future__ import annotations

import json
from pathlib import Path

from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Progress
from tandemlift.pictures.report.paper.contents import paper_figures
from tandemlift.pictures.report.paper.document import PaperFlights, document
from tandemlift.pictures.report.paper.drawings import file_of, write_drawing
from tandemlift.pictures.report.paper.errata import DATA
from tandemlift.pictures.report.paper.table_files import as_csv, as_latex
from tandemlift.pictures.report.paper.tables import paper_tables

SOURCE = "report.typ"


def write_paper_files(
    flights: PaperFlights, folder: Path, command: str, gazebo: str, progress: Progress | None = None
) -> None:
    """Write figures (PDF, SVG), tables (CSV, LaTeX), report.json and report.typ into a folder.

    Args:
        flights: what the report shows.
        folder: where to; made if it does not exist.
        command: the command that made the report.
        gazebo: whether Gazebo can fly the corridor on this machine, as a sentence.
        progress: called after each drawing with (drawings done, drawings in all).
    """
    given = {"mission": None, "paper flight": flights.paper, "zigzag flight": flights.corridor}
    parts = [(figure, name, of) for figure in paper_figures() for name, of, _ in figure.parts]
    for done, (figure, name, of) in enumerate(parts, 1):
        write_drawing(name, given[of], folder / file_of(figure, name))
        if progress:
            progress(done, len(parts))
    for table in paper_tables(flights.paper.mission):
        for suffix, written in (("csv", as_csv), ("tex", as_latex)):
            _write(folder / "tables" / f"table-{table.number}.{suffix}", written(table))
    text = json.dumps(document(flights, command, gazebo), indent=1, ensure_ascii=False, allow_nan=False)
    _write(folder / "report.json", text + "\n")
    _write(folder / SOURCE, (DATA / SOURCE).read_text("utf-8"))


def _write(path: Path, text: str) -> None:
    with atomic_write(path) as partial:
        partial.write_text(text, "utf-8")


def check_typesetting() -> None:
    """Find out whether the PDF can be set.

    Raises:
        InputError: the package that sets it is not installed.
    """
    with extra("paper", "the PDF of the paper's report"):
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
