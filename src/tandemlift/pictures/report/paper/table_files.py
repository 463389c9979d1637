"""The paper's tables beside ours as CSV, and as LaTeX for a paper."""

from __future__ import annotations

import csv
import io
import re

from tandemlift.pictures.report.latex import latex_table, latex_text
from tandemlift.pictures.report.paper.tables import PaperTable

HEADINGS = ("symbol", "meaning", "printed", "unit", "here", "unit here", "from", "agrees")
GREEK = {"ξ": "xi", "η": "eta", "λ": "lambda", "φ": "phi", "θ": "theta", "ψ": "psi"}
INDEX = str.maketrans({"₁": "_1", "₂": "_2"})
POWER = str.maketrans({"²": "^2"})
WORD = re.compile(r"[a-z]{2,}")


def as_csv(table: PaperTable) -> str:
    """A table as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADINGS)
    writer.writerows([*row[:-1], row.mark or "yes"] for row in table.rows)
    return text.getvalue().replace("`", "")


def as_latex(table: PaperTable) -> str:
    """A table as LaTeX, without the column that says where our numbers are from."""
    rows = []
    for row in table.rows:
        cells = [latex_text(row.meaning), row.printed, _unit(row.unit), row.ours, _unit(row.right), row.mark or "yes"]
        rows.append([_symbols(row.symbol), *cells])
    head = [heading for heading in HEADINGS if heading != "from"]
    return latex_table("l" * len(head), head, rows, f"Table {table.number} of the paper beside the mission paper")


def _symbols(text: str) -> str:
    """Symbols such as ξ_φ or J_tx as mathematics; words stay words."""
    parts = text.translate(INDEX).split(", ")
    return ", ".join(part if WORD.fullmatch(part) else f"${_symbol(part)}$" for part in parts)


def _symbol(text: str) -> str:
    named = "".join(f"\\{GREEK[c]} " if c in GREEK else c for c in text)
    return re.sub(r"_(.+)", lambda index: f"_{{{index[1].strip()}}}", named)


def _unit(text: str) -> str:
    """A unit with its powers."""
    return re.sub(r"\^\d", lambda power: f"${power[0]}$", text.translate(POWER))
