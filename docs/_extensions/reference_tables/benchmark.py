"""The tables of the benchmark's baselines, as the package has them: an entry is a column, so that a page holds all."""

from tandemlift.analysis.studies.benchmark import shipped_tables
from tandemlift.analysis.studies.benchmark_entry import Kind


def controllers() -> str:
    """Of the controllers."""
    return _table("controllers")


def observers() -> str:
    """Of the observers of the external wrench."""
    return _table("observers")


def policies() -> str:
    """Of the policies."""
    return _table("policies")


def _table(kind: Kind) -> str:
    scores = shipped_tables()[kind]
    titles = list(next(iter(scores.values())))
    rows = [[title, *(_text(row[title]) for row in scores.values())] for title in titles]
    lines = [["", *scores], ["---", *("---:" for _ in scores)], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _text(number: float | None) -> str:
    if number is None:
        return "–"
    return f"{number:,.0f}" if abs(number) >= 100.0 else f"{number:.3g}"
