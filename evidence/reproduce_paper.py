"""Put the paper's figures and tables beside ours, in one PDF.

python evidence/reproduce_paper.py [--out out/paper.pdf] [--style ieee] [--no-pdf]

The missions `paper` and `zigzag` are flown, and `paper` once more for each setting that the paper leaves open, with
another choice. For FILE.pdf, FILE-files/ has the figures (PDF, diagrams as SVG), Tables II and III (CSV, LaTeX), and
the source of the PDF, report.typ, with its text and numbers in report.json.
"""

from __future__ import annotations

import argparse

from reproduction.figures import open_settings
from reproduction.report import PaperFlights, write_paper_files

from tandemlift.apps.export.results import file_path
from tandemlift.core.errors import InputError
from tandemlift.engines.gazebo_server import root
from tandemlift.missions import load_mission
from tandemlift.pictures.drawing.figure import STYLES, figure_style
from tandemlift.pictures.report.typesetting import typeset
from tandemlift.simulation.fly import fly_many


def fly_paper() -> PaperFlights:
    """Fly the missions of the report."""
    missions = [load_mission("paper"), load_mission("zigzag")]
    missions += [load_mission("paper", setting.changes) for setting in open_settings()]
    flown, corridor, *choices = fly_many(missions)
    return PaperFlights(flown, corridor, [flight.metrics() for flight in choices])


def gazebo_sentence() -> str:
    """Whether Gazebo can fly the corridor on this machine."""
    how = "`tandemlift gazebo zigzag --fast` flies this corridor in Gazebo 11"
    try:
        root()
    except InputError:
        return f"{how}. Gazebo is not installed on the machine that made this report."
    return f"{how}. Gazebo is installed on the machine that made this report, which flew the compiled engine."


def main(arguments: list[str] | None = None) -> None:
    """Fly, draw, and set the report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default="out/paper.pdf", help="FILE.pdf (%(default)s)")
    parser.add_argument("--style", choices=STYLES, default="ieee", help="of the figures (%(default)s)")
    parser.add_argument("--no-pdf", action="store_true", help="write figures, tables and source only")
    given = parser.parse_args(arguments)
    path = file_path("--out", given.out, ".pdf")
    folder = path.with_name(f"{path.stem}-files")
    command = f"python evidence/reproduce_paper.py --out {given.out} --style {given.style}"
    with figure_style(given.style):
        write_paper_files(fly_paper(), folder, command + " --no-pdf" * given.no_pdf, gazebo_sentence())
    print(f"figures, tables and source: {folder}")
    if not given.no_pdf:
        typeset(folder, path)
        print(f"report: {path}")


if __name__ == "__main__":
    main()
