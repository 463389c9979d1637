"""`tandemlift validate`: measure what the pilot is held to."""

from __future__ import annotations

import sys
from pathlib import Path

import click

MISSED = 1


@click.command()
@click.option("--engine", default="compiled", show_default=True, help="Where the body lives; see `tandemlift engines`.")
@click.option("--draws", type=click.IntRange(1, 100_000), help="Of all that is drawn.  [default: 200; 10 elsewhere]")
@click.option(
    "--chapter", "chapters", multiple=True, metavar="NAME", help="Only this chapter. May be given many times."
)
@click.option("--out", metavar="FILE", help="Write the table there too.")
def validate(engine: str, draws: int | None, chapters: tuple[str, ...], out: str | None) -> None:
    """Fly what the pilot is held to, and put what is measured beside its targets.

    Ends with status 1 if a target is missed.

    \b
    Examples:
      tandemlift validate
      tandemlift validate --chapter tracking --engine mujoco
    """
    from tandemlift.cli.notices import compile_notices
    from tandemlift.cli.run import echo
    from tandemlift.engines.registry import engine_named
    from tandemlift.studies.validation import Bench, chosen, rows_of, table

    engine_named(engine)
    names = chosen(list(chapters))
    bench = Bench(engine, draws or (200 if engine == "compiled" else 10))
    with compile_notices.together():
        rows = rows_of(bench, names, lambda name: click.echo(f"flying {name} …", err=True))
    text = table(rows)
    echo(text)
    if out:
        Path(out).write_text(text + "\n", encoding="utf-8")
    if any(row.met is False for row in rows):
        sys.exit(MISSED)
