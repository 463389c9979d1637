"""Measure the pilot's performance, and print it beside its targets; docs/reference/validation.md holds the tables.

python evidence/validate.py [--engine compiled] [--draws 200] [--chapter NAME ...] [--out FILE]

The chapters fly more than a thousand missions together. A second table counts how these flights ended, and how many had
findings. The exit code is 1 if a target is missed, and 2 after bad input, before any flight.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from validation.census import Census
from validation.chapters import CHAPTERS, Bench, rows_of, table

from tandemlift.apps.cli.notices import compile_notices
from tandemlift.core.progress import watching
from tandemlift.engines.registry import ENGINES


def main(arguments: list[str] | None = None) -> int:
    """Fly, print, and optionally write the results; return 1 if a target is missed, else 0."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--engine", choices=ENGINES, default="compiled", help="engine (%(default)s)")
    parser.add_argument("--draws", type=int, help="random draws per experiment (200; 10 in other engines)")
    parser.add_argument("--chapter", nargs="+", choices=CHAPTERS, default=list(CHAPTERS), help="only these (all)")
    parser.add_argument("--out", type=Path, help="also write the tables to this file")
    given = parser.parse_args(arguments)
    census = Census()
    bench = Bench(given.engine, given.draws or (200 if given.engine == "compiled" else 10), census)
    with watching(compile_notices), compile_notices.together():
        rows = rows_of(bench, given.chapter, lambda name: print(f"flying {name} …", file=sys.stderr, flush=True))
    text = f"{table(rows)}\n\n{census.table()}"
    print(text)
    if given.out:
        given.out.write_text(text + "\n", encoding="utf-8")
    return int(any(row.met is False for row in rows))


if __name__ == "__main__":
    sys.exit(main())
