"""`tandemlift paper`: the paper's figures and tables beside ours, as one PDF."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli.terminal.console import echo, progress_bar
from tandemlift.apps.cli.terminal.mission_options import kept_style_option
from tandemlift.apps.cli.terminal.results import results_folder
from tandemlift.core.errors import InputError

if TYPE_CHECKING:
    from tandemlift.pictures.report.paper.document import PaperFlights

OUT = "out/paper.pdf"


@click.command()
@click.option("--out", metavar="FILE", default=OUT, show_default=True, help="FILE.pdf.")
@kept_style_option
@click.option("--no-pdf", is_flag=True, help="Write figures, tables and source only.")
def paper(out: str, style: str | None, no_pdf: bool) -> None:
    """Put the figures and tables of the paper beside ours, in one PDF.

    The missions `paper` and `zigzag` are flown, and `paper` once more for each setting that the paper leaves open, with
    another choice. The PDF needs the package typst: pip install 'tandemlift[paper]'. Without it, all else is written.

    \b
    Examples:
      tandemlift paper
      tandemlift paper --out reproduction.pdf --style elsevier
      tandemlift paper --no-pdf

    \b
    Files, for FILE.pdf:
      FILE.pdf                 claims, tables, figures, open settings and errata; fonts embedded, figures as vectors
      FILE-files/figures/      the figures, one PDF each; diagrams as SVG, in colours of their own
      FILE-files/tables/       Tables II and III beside our numbers, as CSV and LaTeX
      FILE-files/report.typ    the source of the PDF, with its text and numbers in report.json

    \b
    Exit code:
      0   all was written
      2   bad input, or no typst: one message
    """
    from tandemlift.pictures.report.paper.files import typeset, write_paper_files

    path = _pdf_path(out)
    with results_folder(str(path.parent), path.parent, (path.name,)):
        flights = fly_paper()
        folder = path.with_name(f"{path.stem}-files")
        with progress_bar("Drawing", "figures") as progress:
            write_paper_files(flights, folder, _command(out, style, no_pdf), gazebo_sentence(), progress)
        echo(f"figures, tables and source: {folder}")
        if not no_pdf:
            typeset(folder, path)
            echo(f"report: {path}")


def _pdf_path(out: str) -> Path:
    """The path of the PDF.

    Raises:
        InputError: it does not end in .pdf, or is a folder.
    """
    path = Path(out)
    if path.suffix.lower() != ".pdf":
        raise InputError(f"--out {out}: must end in .pdf")
    if path.is_dir():
        raise InputError(f"--out {out}: is a folder, not a file")
    return path


def _command(out: str, style: str | None, no_pdf: bool) -> str:
    """The command as it was given."""
    parts = [f"--out {out}" if out != OUT else "", f"--style {style}" if style else "", "--no-pdf" if no_pdf else ""]
    return " ".join(["tandemlift paper", *filter(None, parts)])


def fly_paper() -> PaperFlights:
    """Fly what the report shows, with a progress bar."""
    from tandemlift.missions import load_mission
    from tandemlift.pictures.report.paper.contents import open_settings
    from tandemlift.pictures.report.paper.document import PaperFlights
    from tandemlift.simulation.fly import fly

    changes = [setting.changes for setting in open_settings()]
    total = 2 + len(changes)
    with progress_bar("Flying", "flights") as progress:

        def count(done: int) -> None:
            if progress:
                progress(done, total)

        flown = fly(load_mission("paper"))
        count(1)
        corridor = fly(load_mission("zigzag"))
        count(2)
        choices = []
        for done, change in enumerate(changes, 3):
            choices.append(fly(load_mission("paper", change)).metrics())
            count(done)
    return PaperFlights(flown, corridor, choices)


def gazebo_sentence() -> str:
    """Whether Gazebo can fly the corridor on this machine."""
    from tandemlift.engines.gazebo_server import root

    how = "`tandemlift gazebo zigzag --fast --pictures` flies this corridor in Gazebo 11 and photographs it"
    try:
        root()
    except InputError:
        return f"{how}. Gazebo is not installed on the machine that made this report."
    return f"{how}. Gazebo is installed on the machine that made this report, which flew the compiled engine."
