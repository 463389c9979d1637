"""`tandemlift study`: fly many missions into one table."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tandemlift.apps.cli.completion import names
from tandemlift.apps.cli.console import compile_notices, echo, progress_bar
from tandemlift.core.files import parse_setting

if TYPE_CHECKING:
    from tandemlift.analysis.studies.design.plan import StudyPlan
    from tandemlift.analysis.studies.execution.store import StudyFolder


@click.command()
@click.argument("file", required=False, shell_complete=names(files=[".toml"]))
@click.option("--out", metavar="DIR", help="Folder of the study.  [default: out/NAME]")
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    help="Set one key of the study file, such as study.draws=1000. Can be repeated.",
)
@click.option("--threads", type=click.IntRange(min=1), help="Threads.  [default: one for each processor]")
@click.option(
    "--scheduler", metavar="ADDRESS", help="Fly on the workers of a Dask scheduler, such as tcp://127.0.0.1:8786."
)
@click.option("--cluster", metavar="local:N", help="Fly in N processes of this machine, with Dask's dashboard.")
@click.option("--part", default="1/1", metavar="K/N", help="Fly part K of N only, as in a job array.")
@click.option(
    "--for",
    "metrics",
    metavar="METRIC",
    multiple=True,
    shell_complete=names("metric"),
    help="Metric that the report shows. Can be repeated.",
)
@click.option("--no-report", is_flag=True, help="Write no report.")
@click.option("--dry-run", is_flag=True, help="Fly a few rows only, and estimate time and size of all.")
@click.option("--template", is_flag=True, help="Print a commented study file.")
def study(
    file: str | None,
    out: str | None,
    settings: tuple[str, ...],
    threads: int | None,
    scheduler: str | None,
    cluster: str | None,
    part: str,
    metrics: tuple[str, ...],
    no_report: bool,
    dry_run: bool,
    template: bool,
) -> None:
    """Fly the study in FILE: many missions, in one table.

    A stopped study continues when it is started again: finished rows in its folder are not flown again.

    \b
    Examples:
      tandemlift study --template > gusts.toml
      tandemlift study gusts.toml --dry-run
      tandemlift study gusts.toml
      tandemlift study gusts.toml --part 3/40
      tandemlift run --from out/gusts --row 17

    \b
    Files in the folder of the study:
      study.toml      the study
      study.json      the same, with all missions and controllers
      chunks/         the table: tl.load_study, or any reader of Parquet files
      report.html     outcomes, distributions, maps, the worst rows; `tandemlift report DIR` writes it again

    \b
    Exit code:
      0    the study, or its part, is flown
      2    bad input: one message; finished rows are kept
      130  stopped by Ctrl-C; finished rows are kept
    """
    if template:
        from tandemlift.analysis.studies.design.study_files import TEMPLATE

        echo(TEMPLATE, nl=False)
        return
    if file is None:
        raise click.UsageError("Missing argument 'FILE': a study file; `tandemlift study --template` prints one.")
    from tandemlift.analysis.studies.design.study_files import load_plan

    plan = load_plan(file, dict(map(parse_setting, settings)))
    rows = f"{plan.count:,} rows = {plan.sizes}" if plan.count > 1 else plan.sizes
    echo(f"{plan.settings.study.name}: {rows}")
    if dry_run:
        from tandemlift.analysis.studies.estimate import estimate

        with compile_notices.together():
            expected = estimate(plan)
        for line in expected.lines(threads or os.cpu_count() or 1):
            echo(f"  {line}")
        return
    folder = _fly(plan, out, part, threads=threads, scheduler=scheduler, cluster=cluster)
    _print_outcomes(folder.path, metrics, report=not no_report)


def _fly(plan: StudyPlan, out: str | None, part: str, **where: Any) -> StudyFolder:
    from tandemlift.analysis.studies.execution.anywhere import fly_study
    from tandemlift.analysis.studies.execution.running import part_from
    from tandemlift.analysis.studies.execution.store import open_folder

    chosen = part_from(part)
    folder = open_folder(plan, Path("out") / plan.settings.study.name if out is None else Path(out))
    with progress_bar(plan.settings.study.name, "rows") as progress:
        fly_study(plan, folder, part=chosen, progress=progress, say=lambda line: click.echo(line, err=True), **where)
    return folder


def _print_outcomes(folder: Path, metrics: tuple[str, ...], *, report: bool) -> None:
    """Print the outcomes of the flights and the place of the table; write the report of a whole study."""
    from tandemlift.analysis.studies.table import load_study, outcome_lines
    from tandemlift.pictures.report.study.study_report import write_study_report

    study = load_study(folder)
    for line in outcome_lines(study):
        echo(f"  {line}")
    if report and not study.missing:
        echo(f"  report: {write_study_report(study, folder / 'report.html', metrics)}")
    echo(f"  table: tl.load_study({str(folder)!r})")
