"""The report of a study: one HTML file that needs nothing else."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tandemlift.analysis.studies.study_rows import StudyRows
from tandemlift.analysis.studies.table import Study
from tandemlift.core.errors import InputError
from tandemlift.missions import format_toml
from tandemlift.pictures.report.page import PageTable, ShownFigure, shown_figures, write_page
from tandemlift.pictures.report.study import distributions, maps, sections
from tandemlift.pictures.report.study.outcome_tables import shown_worst, write_outcomes
from tandemlift.pictures.report.study.words import command

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tandemlift.pictures.drawing.figure import Caption


def _figures(rows: StudyRows, folder: Path | None) -> list[ShownFigure]:
    """The figures, as far as there is something to draw."""
    drawn, captions = dict[str, "Figure"](), dict[str, "Caption"]()
    if rows.quantities:
        drawn["distributions"] = distributions.draw_distributions(rows)
        captions["distributions"] = distributions.caption_of(rows)
    columns = maps.map_columns(rows)
    if columns and (rows.quantities or rows.bad.any()):
        both = len(columns) == 2
        figure = maps.draw_maps(rows, columns) if both else maps.draw_curves(rows, columns[0])
        drawn["maps"], captions["maps"] = figure, maps.caption_of(rows, figure, over_two=both)
    return shown_figures(drawn, captions, folder)


def write_study_report(
    study: Study, path: str | os.PathLike[str], metrics: Sequence[str] = (), figures: Path | None = None
) -> Path:
    """Write the report of a study atomically as one HTML file without references.

    Beside it outcomes.csv and outcomes.tex have the outcomes as a table, a row for each group.

    Args:
        study: loaded; if it is not finished, the page has the number of missing rows.
        path: of the HTML file; its folder is made if it does not exist.
        metrics: names of the quantities to show, such as `position_rmse_m` or `position_rmse_m.0`; by default what
            suits the missions: tracking errors, least clearance, effort of a person.
        figures: folder into which the figures are written as well.

    Returns:
        The path.

    Raises:
        InputError: no row is flown yet, a metric does not exist, or a file is damaged.
    """
    if not len(study):
        raise InputError(f"{study.folder}: no row of the study is flown yet")
    path, rows = Path(path), StudyRows(study, metrics)
    write_outcomes(rows, path.parent)
    return write_page(
        path,
        "study",
        name=study.name,
        about=sections.counted(len(study), "row"),
        verdict=sections.verdict(rows),
        flown=PageTable("setup", (), list(sections.what_was_flown(study))),
        bad_kinds=sections.bad_kinds(rows),
        outcomes=sections.outcomes(rows),
        left_out=sections.left_out(rows),
        refusals=sections.refusals(rows),
        findings=sections.findings(rows),
        measured=list(sections.measured(rows)),
        lacking=rows.lacking,
        bad=sections.counted(int(rows.bad.sum()), "row"),
        figures=_figures(rows, figures),
        influence=sections.influence(rows),
        worst=list(shown_worst(rows)),
        settings=format_toml(study.settings.model_dump(mode="json", exclude_none=True)),
        again=command("study", study.folder / "study.toml", "--out", study.folder),
        versions=", ".join(f"{name} {value}" for name, value in study.versions.items()),
    )
