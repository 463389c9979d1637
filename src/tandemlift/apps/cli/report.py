"""`tandemlift report`, `plot` and `paper`: figures and reports of saved flights, of a bag, of a study."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tandemlift.apps.cli import flying
from tandemlift.apps.cli.completion import FLIGHTS, MISSIONS
from tandemlift.apps.cli.console import echo, progress_bar
from tandemlift.apps.export.results import FIGURES, file_path, load_flight, read_curves, results_folder
from tandemlift.core.errors import InputError
from tandemlift.core.files import parse_setting

if TYPE_CHECKING:
    from tandemlift.pictures.report.paper_report import PaperFlights


@click.command()
@click.argument("flight", shell_complete=FLIGHTS)
@click.option(
    "--out",
    metavar="PATH",
    help="Folder for the results; of a study the HTML file.  [default: that of the flight; of a bag out/NAME; of a "
    "study report.html in its folder]",
)
@flying.plugin_option
@flying.figures_option
@flying.kept_style_option
@click.option(
    "--for",
    "metrics",
    multiple=True,
    metavar="METRIC",
    help="Show this metric of a study, such as position_rmse_m. Can be repeated.  [default: as suits its missions]",
)
def report(flight: str, out: str | None, no_figures: bool, style: str | None, metrics: tuple[str, ...]) -> None:
    """Write figures and report of a saved flight, a bag or a study.

    FLIGHT is flight.npz or its folder, or a bag of ROS 1 (.bag) or ROS 2 (.mcap, or its folder) with the topics of
    docs/reference/flights.md: an exported one, or one recorded during a flight by `rosbag record` or `ros2 bag record`.
    Or it is the folder of a study, which may still fly: docs/reference/studies.md describes its report.

    \b
    Examples:
      tandemlift report flight.bag
      tandemlift report out/zigzag --out out/again
      tandemlift report out/gusts --for human_work_j
      tandemlift report out/iris --style slides

    \b
    Files in the results folder: those of `tandemlift run`. Other files there are left alone. The metrics of a bag are
    computed from its samples. Beside the report of a study: outcomes.csv and outcomes.tex; with --style also its
    figures (PNG and PDF) in figures/.
    """
    from tandemlift.analysis.studies.execution.store import is_study

    if is_study(Path(flight)):
        _report_study(Path(flight), out, metrics, no_figures=no_figures, keep=style is not None)
        return
    if metrics:
        raise InputError(f"--for {metrics[0]}: {flight} is no study; the report of a flight shows all metrics")
    loaded, default = load_flight(flight)
    with results_folder(out, default, flying.FILES) as folder:
        echo(repr(loaded).strip("<>"))
        flying.write_flight(loaded, folder, figures=not no_figures)
        echo(f"  report: {folder / 'report.html'}")


def _report_study(folder: Path, out: str | None, metrics: tuple[str, ...], *, no_figures: bool, keep: bool) -> None:
    """Write the report of a study.

    Raises:
        InputError: an option does not suit a study, or the study cannot be read.
    """
    if no_figures:
        raise InputError("--no-figures: the report of a study has its figures in it")
    path = folder / "report.html" if out is None else file_path("--out", out, *flying.HTML)
    from tandemlift.analysis.studies.table import load_study
    from tandemlift.pictures.report.study.study_report import write_study_report

    loaded = load_study(folder)
    echo(repr(loaded).strip("<>"))
    echo(f"  report: {write_study_report(loaded, path, metrics, path.parent / FIGURES if keep else None)}")


@click.command()
@click.argument("figure")
@click.argument("flights", nargs=-1, required=True, shell_complete=FLIGHTS)
@click.option("--out", metavar="FILE", help="FILE.png, FILE.pdf or FILE.svg.  [default: out/FIGURE.png]")
@flying.plugin_option
@flying.style_option
def plot(figure: str, flights: tuple[str, ...], out: str | None) -> None:
    """Draw a figure of one flight, or of several over each other.

    FIGURE is the name of a figure, such as tracking, path, inputs or push, or of a channel, such as position. FLIGHTS
    are saved flights (flight.npz or its folder) or bags. Of several, each is a line with the name of its folder.

    \b
    Examples:
      tandemlift run iris --out out/light
      tandemlift run iris --out out/heavy --set admittance.mass=3
      tandemlift plot path out/light out/heavy
      tandemlift plot position_error out/light out/heavy --out errors.pdf --style elsevier
    """
    import tandemlift as tl
    from tandemlift.pictures.drawing.style import save

    path = file_path("--out", out or f"out/{figure}.png", *flying.DRAWINGS)
    loaded = [load_flight(given) for given in flights]
    names = [folder.resolve().name for _, folder in loaded]
    named = dict(zip(names if len(set(names)) == len(names) else flights, (f for f, _ in loaded), strict=True))
    drawn = tl.plot(named, figure)
    path.parent.mkdir(parents=True, exist_ok=True)
    echo(f"{figure}: {save(drawn, path)}")


OUT, MISSION = "out/paper.pdf", "paper"


@click.command()
@click.option("--out", metavar="FILE", default=OUT, show_default=True, help="FILE.pdf.")
@click.option("--mission", default=MISSION, show_default=True, shell_complete=MISSIONS, help="To be flown instead.")
@flying.set_option
@click.option("--curves", metavar="FILE.csv", help="Lay your own curves over ours, in Figures 4, 6, 7 and 8.")
@flying.kept_style_option
@click.option("--no-pdf", is_flag=True, help="Write figures, tables and source only.")
def paper(
    out: str, mission: str, settings: tuple[str, ...], curves: str | None, style: str | None, no_pdf: bool
) -> None:
    """Put the paper's figures and tables beside ours, in one PDF.

    The missions `paper` and `zigzag` are flown, and `paper` once more for each setting that the paper leaves open, with
    another choice. The PDF needs the package typst, which `make run` does not install: pip install 'tandemlift[paper]'.
    Without it, give --no-pdf: all else is written.

    \b
    Examples:
      tandemlift paper
      tandemlift paper --out reproduction.pdf --style elsevier
      tandemlift paper --mission mine.toml
      tandemlift paper --curves measured.csv
      tandemlift paper --no-pdf

    FILE.csv is as of `tandemlift export`: a line of names, such as time and position_x or position[m].x, then numbers.
    docs/how-to/figures-for-a-paper.md says which figure has which names.

    \b
    Files, for FILE.pdf:
      FILE.pdf                 claims, tables, figures, open settings and errata; fonts embedded, figures as vectors
      FILE-files/figures/      the figures, one PDF each; diagrams as SVG, in colours of their own
      FILE-files/tables/       Tables II and III beside our numbers, as CSV and LaTeX
      FILE-files/report.typ    the source of the PDF, with its text and numbers in report.json
    """
    from tandemlift.apps.cli.gazebo_flight import gazebo_sentence
    from tandemlift.missions import load_mission
    from tandemlift.pictures.report.paper_figures import curve_channels
    from tandemlift.pictures.report.paper_report import check_typesetting, typeset, write_paper_files

    path = file_path("--out", out, ".pdf")
    if not no_pdf:
        check_typesetting()
    own, left_out = read_curves(file_path("--curves", curves, ".csv"), curve_channels()) if curves else (None, [])
    if own:
        echo(f"curves: {', '.join(own)} of {curves}" + (f"; left out: {', '.join(left_out)}" if left_out else ""))
    changes = dict(map(parse_setting, settings))
    load_mission(mission, changes)
    given = [("--out", out if out != OUT else ""), ("--mission", mission if mission != MISSION else "")]
    given += [*(("--set", one) for one in settings), ("--curves", curves or ""), ("--style", style or "")]
    words = [word for option, value in given if value for word in (option, value)]
    command = shlex.join(["tandemlift", "paper", *words, *(["--no-pdf"] if no_pdf else [])])
    with results_folder(str(path.parent), path.parent, (path.name,)):
        flights = fly_paper(mission, changes)._replace(curves=own)
        folder = path.with_name(f"{path.stem}-files")
        with progress_bar("Drawing", "figures") as progress:
            write_paper_files(flights, folder, command, gazebo_sentence(), progress)
        echo(f"figures, tables and source: {folder}")
        if not no_pdf:
            typeset(folder, path)
            echo(f"report: {path}")


def fly_paper(name: str, changes: Mapping[str, Any]) -> PaperFlights:
    """Fly a mission in place of the paper's, again with each open setting chosen otherwise, and the corridor's."""
    from tandemlift.missions import load_mission
    from tandemlift.pictures.report.paper_figures import with_settings
    from tandemlift.pictures.report.paper_report import PaperFlights
    from tandemlift.simulation.fly import fly_many

    choices = with_settings(name, changes)
    with progress_bar("Flying", "flights") as progress:
        flown, corridor, *others = fly_many(
            [load_mission(name, changes), load_mission("zigzag"), *(one for one in choices if one)], progress=progress
        )
    metrics = (flight.metrics() for flight in others)
    return PaperFlights(flown, corridor, [next(metrics) if one else None for one in choices])
