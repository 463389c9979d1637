"""Metrics as tables for a spreadsheet (CSV) and for a paper (LaTeX, with booktabs): a row for each component."""

from __future__ import annotations

import csv
import io
import math
import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.analysis.studies.metric_descriptions import metric_of
from tandemlift.core.files import write_files

NOTHING = r"\multicolumn{2}{c}{--}"
NUMBER = "r@{}l"  # the column of a number: the part before its point, and the rest
SPECIAL = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "[": "{[}",  # after the end of a row it would open an argument
    "*": "{*}",
    "^": r"\textasciicircum{}",
    "·": r"$\cdot$",
    "−": "$-$",
    "–": "--",
    "’": "'",
    **{character: f"\\{character}" for character in "{}$&#_%"},
}
MOST_DIGITS = 10**9  # of a whole number that is written out
LETTERS = frozenset("ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÑÒÓÔÕÖØÙÚÛÜÝßàáâãäåæçèéêëìíîïñòóôõöøùúûüýÿ")  # that every LaTeX sets


def latex_text(text: str) -> str:
    """A text without commands; text in backquotes is set as code."""
    parts = [_escaped(part) for part in text.split("`")]
    return "".join(rf"\texttt{{{part}}}" if i % 2 else part for i, part in enumerate(parts))


def _escaped(text: str) -> str:
    return "".join(SPECIAL.get(character) or _letter(character) for character in text)


def _letter(character: str) -> str:
    if character in LETTERS or (character.isascii() and character.isprintable()):
        return character
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return _escaped(plain) if plain.isprintable() and plain else "?" if character.isprintable() else " "


def latex_number(value: float | str | None) -> str:
    """The two cells of a number, to four digits; a text or a truth value over both, and a dash for None."""
    if isinstance(value, (bool, str)):
        return rf"\multicolumn{{2}}{{c}}{{{latex_text(str(value).lower() if isinstance(value, bool) else value)}}}"
    if value is None or not math.isfinite(value):
        return NOTHING
    if float(value).is_integer() and abs(value) < MOST_DIGITS:
        value = int(value)
        return f"${re.sub(r'(?<=[0-9])(?=(?:[0-9]{3})+$)', chr(92) + ',', str(value))}$ &"
    digits, power = f"{value:.3e}".split("e")
    if -3 <= int(power) < 4:
        digits, power = f"{value:#.4g}", ""
    whole, _, rest = digits.partition(".")
    times = rf"\times 10^{{{int(power)}}}" if power else ""
    return f"${whole}$ & ${'.' + rest if rest else ''}{times}$" if rest or times else f"${whole}$ &"


def latex_table(columns: str, head: Sequence[str], rows: Iterable[Sequence[str]], note: str) -> str:
    """A table for a paper, in the size of footnotes; a row that begins with nothing belongs to the one before.

    Args:
        columns: as LaTeX takes them.
        head: cells of the first row, already in LaTeX.
        rows: cells of the others, in LaTeX; a number fills two columns.
        note: description of the table for readers of the file.
    """
    lines, said = [], note.translate(dict.fromkeys(map(ord, "\r\n"), " "))
    for row in rows:
        lines.append(" & ".join(row) + r" \\")
    body = "\n".join(lines)
    return (
        f"% {said}. In the preamble: \\usepackage{{booktabs}}\n"
        "{\\footnotesize\\setlength{\\tabcolsep}{4pt}%\n"
        f"\\begin{{tabular}}{{@{{}}{columns}@{{}}}}\n\\toprule\n{' & '.join(head)} \\\\\n\\midrule\n{body}\n"
        "\\bottomrule\n\\end{tabular}}\n"
    )


LISTS = ("findings", "events")  # metrics that fit no cell: metrics.json has them
SENTENCE = "failure"  # too long for a column of a paper
MEANING = "p{5.4cm}"  # of a column of LaTeX
SYMBOLS = {"x": "$x$", "y": "$y$", "z": "$z$", "roll": r"$\phi$", "pitch": r"$\theta$", "yaw": r"$\psi$"}
SYMBOLS |= {f"U{i}": f"$U_{i}$" for i in range(1, 5)}

MetricsByColumn = Mapping[str, Mapping[str, Any]]
"""The metrics of flights, by the name of their column."""


class MetricRow(NamedTuple):
    """A component of a metric: "" for a metric of one number; its values, None where a flight does not have it."""

    metric: str
    component: str
    unit: str
    meaning: str
    values: tuple[Any, ...]


def metric_rows(flights: MetricsByColumn) -> Iterator[MetricRow]:
    """The rows of all metrics that a flight has, those of lists apart."""
    for name in dict.fromkeys(name for metrics in flights.values() for name in metrics):
        if name in LISTS:
            continue
        known, found = metric_of(name), [metrics.get(name) for metrics in flights.values()]
        count = max((len(value) for value in found if isinstance(value, (list, tuple))), default=0)
        if known.components or count:
            for i in range(max(count, len(known.components))):
                component = known.components[i] if i < len(known.components) else str(i)
                values = tuple(None if value is None else value[i] for value in found)
                yield MetricRow(name, component, known.unit_of(i), known.meaning, values)
        else:
            yield MetricRow(name, "", known.unit_of(0), known.meaning, tuple(found))


def metrics_as_csv(flights: MetricsByColumn) -> str:
    """The metrics as CSV: metric, component, a column of values for each flight, unit, meaning; all digits."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["metric", "component", *flights, "unit", "meaning"])
    for row in metric_rows(flights):
        table.writerow([row.metric, row.component, *map(_plain, row.values), row.unit, row.meaning.replace("`", "")])
    return text.getvalue()


def _plain(value: object) -> str:
    missing = value is None or value != value  # not a number
    return "NaN" if missing else str(value).lower() if isinstance(value, bool) else str(value)


def metrics_as_latex(flights: MetricsByColumn, note: str) -> str:
    """The metrics as a table in LaTeX; with the meaning of each if there is one flight."""
    single = len(flights) == 1
    heads = [rf"\multicolumn{{2}}{{c}}{{{latex_text(name)}}}" for name in (["Value"] if single else flights)]
    lines, before = [], ""
    for row in metric_rows(flights):
        if row.metric == SENTENCE:
            continue
        first = row.metric != before
        before = row.metric
        name = rf"\texttt{{{latex_text(row.metric)}}}" if first else ""
        values, unit = map(latex_number, row.values), latex_text(row.unit).replace(" ", r"\,")
        meaning = [latex_text(row.meaning) if first else ""] if single else []
        lines.append([name, SYMBOLS.get(row.component, latex_text(row.component)), *values, unit, *meaning])
    columns = f"ll{NUMBER * len(flights)}l{MEANING if single else ''}"
    return latex_table(columns, ["Metric", "", *heads, "Unit", *(["Meaning"] if single else [])], lines, note)


def write_metric_tables(flights: MetricsByColumn, folder: Path, stem: str, note: str) -> None:
    """Write STEM.csv and STEM.tex into a folder, both or none."""
    write_files(folder, {f"{stem}.csv": metrics_as_csv(flights), f"{stem}.tex": metrics_as_latex(flights, note)})
