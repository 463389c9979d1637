"""`tandemlift validate`: measure the performance of the pilot against its targets."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from tandemlift.cli.terminal.console import compile_notices, echo
from tandemlift.cli.terminal.findings import exit_if_found, strict_option
from tandemlift.cli.terminal.mission_options import engine_option

MISSED = 1
NAMES = "tracking, observers, draws, losses, triggers, persons, yaw or contacts"


@click.command()
@engine_option
@click.option(
    "--draws",
    type=click.IntRange(1, 100_000),
    help="Random draws per experiment.  [default: 200; 10 in other engines]",
)
@click.option(
    "--chapter", "chapters", multiple=True, metavar="NAME", help=f"Run only this chapter: {NAMES}. Can be repeated."
)
@click.option("--out", metavar="FILE", help="Also write the tables to this file.")
@strict_option
def validate(engine: str, draws: int | None, chapters: tuple[str, ...], out: str | None, strict: bool) -> None:
    """Measure the performance of the pilot, and print it beside its targets.

    The measurements are in chapters; together they fly more than a thousand missions. A second table counts how these
    flights ended, and how many had findings.

    \b
    Examples:
      tandemlift validate
      tandemlift validate --chapter tracking --engine mujoco

    \b
    Exit code:
      0   all targets are met
      1   a target is missed
      2   bad input: one message, nothing is flown
      3   with --strict: a flight has findings, and all targets are met
    """
    from tandemlift.engines.registry import engine_named
    from tandemlift.studies.validation.census import Census
    from tandemlift.studies.validation.chapters import Bench, chosen, rows_of, table

    engine_named(engine)
    names = chosen(list(chapters))
    census = Census()
    bench = Bench(engine, draws or (200 if engine == "compiled" else 10), census)
    with compile_notices.together():
        rows = rows_of(bench, names, lambda name: click.echo(f"flying {name} …", err=True))
    text = f"{table(rows)}\n\n{census.table()}"
    echo(text)
    if out:
        Path(out).write_text(text + "\n", encoding="utf-8")
    if any(row.met is False for row in rows):
        sys.exit(MISSED)
    exit_if_found(census.found, strict=strict)
