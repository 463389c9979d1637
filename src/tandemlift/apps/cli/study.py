"""Many flights: `tandemlift study`, in one table, and `compare`, one mission by several controllers or in engines."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tandemlift.apps.cli import flying
from tandemlift.apps.cli.completion import CONTROLLERS, MISSIONS, names, separated
from tandemlift.apps.cli.console import compile_notices, echo, progress_bar
from tandemlift.apps.export.results import results_folder
from tandemlift.core.errors import InputError
from tandemlift.core.files import parse_setting

if TYPE_CHECKING:
    from tandemlift.analysis.studies.comparison import MissionComparison
    from tandemlift.analysis.studies.design.plan import StudyPlan
    from tandemlift.analysis.studies.execution.chunk_scheduling import StudyPart


PROCESS_ROWS = 2_000  # rows; fewer are mostly flown by threads before processes have started


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
@click.option(
    "--processes",
    type=click.IntRange(min=1),
    help="Processes that fly.  [default: one for each processor, if there are 2,000 rows]",
)
@click.option("--threads", type=click.IntRange(min=1), help="Threads that fly, in place of processes.")
@click.option("--part", default="1/1", metavar="K/N", help="Fly part K of N only, as in a job array.")
@click.option(
    "--for",
    "metrics",
    metavar="METRIC",
    multiple=True,
    shell_complete=names("metric"),
    help="Metric that the report shows. Can be repeated.",
)
@flying.plugin_option
@click.option("--no-report", is_flag=True, help="Write no report.")
@click.option("--dry-run", is_flag=True, help="Fly a few rows only, and estimate time and size of all.")
@click.option("--template", is_flag=True, help="Print a commented study file.")
def study(
    file: str | None,
    out: str | None,
    settings: tuple[str, ...],
    processes: int | None,
    threads: int | None,
    part: str,
    metrics: tuple[str, ...],
    no_report: bool,
    dry_run: bool,
    template: bool,
) -> None:
    """Fly the study in FILE: many missions, in one table.

    A study stopped by Ctrl-C (exit code 130) continues when it is started again: finished rows are not flown again.

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
    """
    if template:
        from tandemlift.analysis.studies.design.study_files import template as study_template

        echo(study_template(), nl=False)
        return
    if file is None:
        raise click.UsageError("Missing argument 'FILE': a study file; `tandemlift study --template` prints one.")
    if metrics and no_report:
        raise InputError(f"--for {metrics[0]}: leave out --no-report, or there is no report to show it")
    from tandemlift.analysis.studies.design.study_files import load_plan
    from tandemlift.analysis.studies.execution.chunk_scheduling import part_from
    from tandemlift.analysis.studies.execution.store import check_names

    chosen, plan = part_from(part), load_plan(file, dict(map(parse_setting, settings)))
    workers = _workers(plan, chosen, processes, threads)
    check_names(plan, metrics)
    rows = f"{plan.count:,} rows = {plan.sizes}" if plan.count > 1 else plan.sizes
    echo(f"{plan.settings.study.name}: {rows}")
    if dry_run:
        from tandemlift.analysis.studies.execution.estimate import estimate

        with compile_notices.together():
            expected = estimate(plan)
        echo(*(f"  {line}" for line in expected.lines(*workers)))
        return
    _fly(plan, out, chosen, workers, metrics, report=not no_report)


def _workers(plan: StudyPlan, part: StudyPart, processes: int | None, threads: int | None) -> tuple[int, str]:
    """The number of workers, and what they are: processes, or threads where few rows are to fly."""
    from tandemlift.analysis.studies.execution.workers import processors

    if processes and threads:
        raise InputError("--processes, --threads: give only one of them")
    rows = plan.count // part.parts
    if threads is None and processes is None and rows >= PROCESS_ROWS and processors() > 1:
        processes = min(processors(), -(-rows // plan.rows_per_chunk))
    return (processes, "processes") if processes else (threads or processors(), "threads")


def _fly(
    plan: StudyPlan,
    out: str | None,
    part: StudyPart,
    workers: tuple[int, str],
    metrics: tuple[str, ...],
    *,
    report: bool,
) -> None:
    """Fly a part; print the outcomes and the place of the table; write the report of a whole study."""
    from tandemlift.analysis.studies.execution.chunk_scheduling import fly_study
    from tandemlift.analysis.studies.execution.store import open_folder
    from tandemlift.analysis.studies.execution.workers import worker_processes
    from tandemlift.analysis.studies.table import load_study, outcome_lines

    folder = open_folder(plan, Path("out") / plan.settings.study.name if out is None else Path(out))
    (count, kind), say, name = workers, partial(click.echo, err=True), plan.settings.study.name
    processes = worker_processes(count) if kind == "processes" else nullcontext()
    with processes as executor, progress_bar(name, "rows") as progress:
        fly_study(plan, folder, threads=count, executor=executor, part=part, progress=progress, say=say)
    study = load_study(folder.path)
    echo(*(f"  {line}" for line in outcome_lines(study)))
    if report and not study.missing:
        from tandemlift.pictures.report.study.study_report import write_study_report

        echo(f"  report: {write_study_report(study, folder.path / 'report.html', metrics)}")
    echo(f"  table: tl.load_study({str(folder.path)!r})")


SCORES = ("scores.json", "scores.csv")


@click.command()
@click.argument("file", required=False, type=click.Path(path_type=Path), shell_complete=names(files=[".py", ".toml"]))
@click.option("--quick", is_flag=True, help="Few and short flights, for a first look.")
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/benchmark]")
@flying.plugin_option
def benchmark(file: Path | None, quick: bool, out: str | None) -> None:
    """Score your observer, controller or policy in FILE.

    FILE is found out: a controller, as for `run --controller`; an observer of the external wrench, a law or a function
    of a table; or weights of a policy, as `train` writes them. It flies held-out tasks, and its row is printed beside
    the baselines. Without FILE these fly; of the benchmark's folder the checksums are compared. Tasks and columns:
    docs/how-to/benchmark.md.

    \b
    Examples:
      tandemlift benchmark my_pd.py
      tandemlift benchmark out/zigzag-tuned/tuned.toml --quick
      tandemlift benchmark

    \b
    Files in the results folder (other files there are left alone):
      scores.json, scores.csv   the rows, each with all columns
    """
    from tandemlift.analysis.studies.benchmark import baseline_tables, scores_of, shipped_tables
    from tandemlift.analysis.studies.benchmark_columns import csv_of, json_of, lines_of
    from tandemlift.analysis.studies.benchmark_entry import checked_folder, entry_of
    from tandemlift.core.files import write_files

    if file is not None and file.is_dir():
        echo(f"{file}: {checked_folder(file)} files, all with their checksums")
        return
    entry = None if file is None else entry_of(file)
    with results_folder(out, Path("out/benchmark"), SCORES) as folder:
        with progress_bar("Flying", "flights" if entry else "baselines", shown=sys.stderr.isatty()) as progress:
            if entry is None:
                tables = baseline_tables(quick=quick, progress=progress)
            else:
                own = {entry.name: scores_of(entry, quick=quick, progress=progress)}
                tables = {entry.kind: {**shipped_tables(quick=quick)[entry.kind], **own}}
        for kind, rows in tables.items():
            echo(*lines_of(kind, rows, entry.name if entry else ""), "")
        write_files(folder, dict(zip(SCORES, (json_of(tables), csv_of(tables)), strict=True)))


STEMS = {"controllers": "compare", "engines": "engines"}  # of the files
KINDS = ("json", "csv", "tex")


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option(
    "--controllers",
    metavar="A,B,…",
    shell_complete=separated(CONTROLLERS),
    help="Controllers: names, or your .py files.  [default: all]",
)
@flying.engine_option
@click.option(
    "--engines",
    metavar="A,B,…",
    shell_complete=separated(names("engine")),
    help="Compare engines instead: fly the mission once in each.",
)
@flying.set_option
@click.option("--out", metavar="DIR", help="Folder for the results.  [default: out/NAME]")
@flying.strict_option
def compare(
    mission: str,
    controllers: str | None,
    engine: str,
    engines: str | None,
    settings: tuple[str, ...],
    out: str | None,
    strict: bool,
) -> None:
    """Fly MISSION with several controllers, or in several engines.

    The mission's own controller flies with the mission's settings, every other
    one with its defaults. Keys of `controller` given by --set apply to the mission's own controller only. Wall times
    are those of one flight each, and depend on the machine's load.

    \b
    Examples:
      tandemlift compare iris
      tandemlift compare iris --controllers nftsmc,pid,lqr --set 'disturbance.force=[3, 3, 0]'
      tandemlift compare hover --controllers nftsmc,my_pd.py --out out/mine
      tandemlift compare zigzag --engines compiled,mujoco,gazebo

    \b
    Files in the results folder (other files there are left alone):
      compare.json   the table as numbers in SI units, with all metrics and settings
      engines.json   with --engines: the largest differences from the first, in SI units
      *.csv, *.tex   all metrics, a column for each controller or engine, for a spreadsheet and for LaTeX

    `tandemlift plot` draws several saved flights over each other.

    Exit code 3: a flight crashed, diverged or did not lift; its row has the reason. With --strict, also findings.
    """
    from tandemlift.pictures.report.comparison import write_comparison

    if engines is not None and controllers is not None:
        raise InputError("--engines, --controllers: give only one of them")
    entered = _entered(mission, controllers, engine, engines, settings)
    stem = STEMS[entered.of]
    with results_folder(out, Path("out") / entered.name, [f"{stem}.{kind}" for kind in KINDS]) as folder:
        with progress_bar("Flying", "flights", shown=sys.stderr.isatty()) as progress:
            found = entered.fly(progress)
        echo(*found.lines())
        write_comparison(found, folder, stem)
        echo(f"  numbers: {folder / stem}.json")
    flying.exit_if_amiss(found.flights, strict=strict)


def _entered(
    mission: str, controllers: str | None, engine: str, engines: str | None, settings: tuple[str, ...]
) -> MissionComparison:
    """The comparison that the options ask for."""
    from tandemlift.analysis.studies.comparison import in_engines, names_in, with_controllers
    from tandemlift.engines.registry import engine_named

    if engines is not None:
        return in_engines(flying.load(mission, settings), names_in("--engines", engines, "compiled,mujoco"))
    engine_named(engine)
    changes, chosen = dict(map(parse_setting, settings)), None
    if controllers is not None:
        chosen = [flying.chosen_controller(name) for name in names_in("--controllers", controllers, "nftsmc,pid")]
    return with_controllers(mission, changes, chosen, engine)
