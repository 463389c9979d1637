"""The files of the report: its figures, tables and source in a folder, and the PDF that Typst sets from them."""

from __future__ import annotations

import csv
import io
import json
import re
from pathlib import Path

from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Progress
from tandemlift.pictures.report.latex import latex_table, latex_text
from tandemlift.pictures.report.paper.contents import paper_figures
from tandemlift.pictures.report.paper.document import PaperFlights, document
from tandemlift.pictures.report.paper.drawings import file_of, write_drawing
from tandemlift.pictures.report.paper.errata import DATA
from tandemlift.pictures.report.paper.tables import PaperTable, paper_tables

HEADINGS = ("symbol", "meaning", "printed", "unit", "here", "unit here", "from", "agrees")
GREEK = {"ξ": "xi", "η": "eta", "λ": "lambda", "φ": "phi", "θ": "theta", "ψ": "psi"}
INDEX = str.maketrans({"₁": "_1", "₂": "_2"})
POWER = str.maketrans({"²": "^2"})
WORD = re.compile(r"[a-z]{2,}")


def as_csv(table: PaperTable) -> str:
    """A table as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADINGS)
    writer.writerows([*row[:-1], row.mark or "yes"] for row in table.rows)
    return text.getvalue().replace("`", "")


def as_latex(table: PaperTable) -> str:
    """A table as LaTeX, without the column of our numbers' sources."""
    rows = []
    for row in table.rows:
        cells = [latex_text(row.meaning), row.printed, _unit(row.unit), row.ours, _unit(row.right), row.mark or "yes"]
        rows.append([_symbols(row.symbol), *cells])
    head = [heading for heading in HEADINGS if heading != "from"]
    return latex_table("l" * len(head), head, rows, f"Table {table.number} of the paper beside the mission paper")


def _symbols(text: str) -> str:
    """Symbols such as ξ_φ or J_tx as mathematics; words stay words."""
    parts = text.translate(INDEX).split(", ")
    return ", ".join(part if WORD.fullmatch(part) else f"${_symbol(part)}$" for part in parts)


def _symbol(text: str) -> str:
    named = "".join(f"\\{GREEK[c]} " if c in GREEK else c for c in text)
    return re.sub(r"_(.+)", lambda index: f"_{{{index[1].strip()}}}", named)


def _unit(text: str) -> str:
    """A unit with its powers."""
    return re.sub(r"\^\d", lambda power: f"${power[0]}$", text.translate(POWER))


SOURCE = "report.typ"


def write_paper_files(
    flights: PaperFlights, folder: Path, command: str, gazebo: str, progress: Progress | None = None
) -> None:
    """Write figures (PDF, SVG), tables (CSV, LaTeX), report.json and report.typ into a folder.

    Args:
        flights: those of the report.
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
