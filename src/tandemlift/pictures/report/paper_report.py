"""The report on the paper: figures, tables, data and source in a folder, and the PDF that Typst sets from them.

`data/paper/report.typ` sets what `document` says, so that no text of ours is ever code of Typst.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.errors import InputError, extra
from tandemlift.core.files import atomic_write
from tandemlift.core.types import Progress
from tandemlift.flight.record import Flight
from tandemlift.pictures.report.page import versions_of
from tandemlift.pictures.report.paper_claims import claims
from tandemlift.pictures.report.paper_figures import (
    DATA,
    PaperFigure,
    caption_of,
    errata,
    file_of,
    future_work,
    open_settings,
    paper_figures,
    write_curves,
    write_drawing,
)
from tandemlift.pictures.report.paper_tables import as_csv, as_latex, nomenclature, paper_tables, value_at

SOURCE, CURVES = "report.typ", "figures/figure-{}-curves.pdf"


class PaperFlights(NamedTuple):
    """The content of the report.

    Attributes:
        paper: a flight of the mission `paper`.
        corridor: a flight through the corridor of Figure 9.
        choices: the metrics of `paper` with each of `open_settings()` chosen otherwise, in their order; None for one
            that the mission does not have.
        curves: those of a reader, laid over ours, if any.
    """

    paper: Flight
    corridor: Flight
    choices: Sequence[Mapping[str, Any] | None]
    curves: Flight | None = None


def document(flights: PaperFlights, command: str, gazebo: str) -> dict[str, Any]:
    """The report as data.

    Args:
        flights: those that it shows.
        command: the command that made it.
        gazebo: whether Gazebo can fly the corridor on this machine, as a sentence.
    """
    return {
        "command": command,
        "mission": flights.paper.name,
        "versions": versions_of(flights.paper),
        "engine": flights.paper.version.get("engine", ""),
        "claims": [claim._asdict() for claim in claims(flights.paper, flights.corridor)],
        "nomenclature": nomenclature(),
        "tables": [
            {**table._asdict(), "rows": [row._asdict() for row in table.rows]}
            for table in paper_tables(flights.paper.mission)
        ],
        "figures": [_figure(figure, gazebo, flights.curves) for figure in paper_figures()],
        "open": _open(flights),
        "errata": [erratum._asdict() for erratum in errata()],
        "future": future_work(),
    }


def _figure(figure: PaperFigure, gazebo: str, curves: Flight | None) -> dict[str, Any]:
    parts = []
    for name, _, behind in figure.parts:
        caption = caption_of(name)
        text = f"{caption.title}. {caption.text}"
        parts.append({"file": file_of(figure, name), "behind": behind, "caption": text, "alt": caption.alt})
    if curves is not None and any(channel in curves for channel in figure.curves):
        text = f"The curves of {curves.name} over those of the flight here."
        parts.append({"file": CURVES.format(figure.number), "behind": ", with yours", "caption": text, "alt": text})
    about = [{"about": e.about, "title": e.title} for e in errata() if figure.number in e.figures]
    return {**figure._asdict(), "parts": parts, "errata": about, "gazebo": gazebo if figure.number == 9 else ""}


def _open(flights: PaperFlights) -> dict[str, Any]:
    """The choices that the paper leaves open, with their effects on tracking and roll moment."""
    mission = flights.paper.mission
    rows = []
    for setting, metrics in zip(open_settings(), flights.choices, strict=True):
        if metrics is None:
            continue
        rows.append(
            {
                "key": setting.key,
                "why": setting.why,
                "chosen": _shown(value_at(mission, setting.key)),
                "other": _shown(setting.changes[setting.key]),
                **_effect(metrics),
            }
        )
    return {"paper": _effect(flights.paper.metrics()), "rows": rows}


def _effect(metrics: Mapping[str, Any]) -> dict[str, str]:
    rmse, moment = metrics["position_rmse_after_10s_m"], metrics["moment_max_abs_after_10s_n_m"]
    known = metrics["outcome"] == "landed" and rmse is not None and moment is not None
    return {
        "x": f"{1e3 * rmse[0]:.1f}" if known else str(metrics["outcome"]),
        "y": f"{1e3 * rmse[1]:.1f}" if known else "",
        "roll": f"{moment[0]:.1f}" if known else "",
    }


def _shown(value: ArrayLike) -> str:
    """A value of a mission in a few characters: one number where all of a list are equal."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    flat = np.ravel(value)
    if np.all(flat == flat[0]):
        return f"{flat[0]:g}"
    return ", ".join(f"{number:g}" for number in flat).replace("-", "−")


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
    for figure in paper_figures():
        if flights.curves is not None:
            write_curves(figure, flights.paper, flights.curves, folder / CURVES.format(figure.number))
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
    with extra("paper", "the PDF of the paper's report, which --no-pdf leaves out,"):
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
