"""The paper's tables beside the numbers of the mission `paper`, as data, CSV and LaTeX."""

from __future__ import annotations

import csv
import io
import re
import tomllib
from collections.abc import Mapping
from decimal import Decimal
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from tandemlift.core.types import GRAVITY
from tandemlift.missions import check
from tandemlift.pictures.report.metric_tables import latex_table, latex_text
from tandemlift.pictures.report.paper_figures import DATA, errata

AXES = {"position": slice(0, 3), "attitude": slice(3, 6), "one": slice(None)}
DERIVED = {
    "mass": lambda vehicle: vehicle.mass,
    "inertia": lambda vehicle: np.diag(vehicle.inertia),
    "payload inertia": lambda vehicle: vehicle.payload.moments,
    "gravity": lambda vehicle: GRAVITY,
}


class TableRow(NamedTuple):
    """A row: numbers as the paper prints them and as the mission has them, with units, and where ours are from.

    Attributes:
        symbol: of the paper.
        meaning: of it.
        printed: the paper's numbers.
        unit: the paper's unit.
        ours: the mission's numbers in as many digits, or in full where they differ.
        right: our unit.
        source: the key of the mission, or the computed quantity.
        mark: the difference: `value`, `unit`, or nothing.
    """

    symbol: str
    meaning: str
    printed: str
    unit: str
    ours: str
    right: str
    source: str
    mark: str


class PaperTable(NamedTuple):
    """A table of the paper: its number, our title, its rows, and the errata about it."""

    number: str
    title: str
    rows: list[TableRow]
    errata: list[str]


@cache
def _data() -> dict[str, Any]:
    return tomllib.loads((DATA / "tables.toml").read_text("utf-8"))


def paper_tables(mission: Mapping[str, Any]) -> list[PaperTable]:
    """Tables II and III beside a mission's numbers, as a flight's nested tables have them."""
    return [
        PaperTable(table["number"], table["title"], [_row(row, mission) for row in table["rows"]], _about(table))
        for table in _data()["tables"]
    ]


def nomenclature() -> dict[str, Any]:
    """Table I: number, title, and rows of symbol, printed unit, our name, our unit, note."""
    return dict(_data()["nomenclature"])


def _about(table: Mapping[str, Any]) -> list[str]:
    return [erratum.about for erratum in errata() if table["number"] in erratum.tables]


LEFT_OUT = {"admittance.gate": "hard"}  # the meaning of a key that the paper's mission leaves out


def value_at(mission: Mapping[str, Any], key: str) -> Any:
    """The value of a dotted key of a mission.

    Raises:
        KeyError: there is none.
    """
    value: Any = mission
    for part in key.split("."):
        if key in LEFT_OUT and part not in value:
            return LEFT_OUT[key]
        value = value[int(part) if part.isdigit() else part]
    return value


def _numbers(row: Mapping[str, Any], mission: Mapping[str, Any]) -> list[float]:
    """Our numbers of a row, as many as the paper prints; several that are printed as one must be equal.

    None if the mission has no such quantity: another controller, or a payload of another shape.
    """
    if "derived" in row:
        values = np.atleast_1d(DERIVED[row["derived"]](check(dict(mission), quiet=True).hover.vehicle))
    else:
        try:
            found = value_at(mission, row["key"])
        except KeyError:
            found = None
        if found is None:
            return []
        values = np.atleast_1d(found)[AXES[row.get("axes", "one")]]
    if len(row["printed"]) == 1 and np.all(values == values[0]):
        values = values[:1]
    return [float(value) for value in values]


def agrees(printed: str, value: float) -> bool:
    """Whether a value is the printed one to every printed digit."""
    exponent = Decimal(printed).as_tuple().exponent
    return abs(Decimal(value) - Decimal(printed)) <= Decimal("0.500001").scaleb(int(exponent))


def _row(row: Mapping[str, Any], mission: Mapping[str, Any]) -> TableRow:
    values, printed, unit = _numbers(row, mission), row["printed"], row["unit"]
    same = len(values) == len(printed) and all(map(agrees, printed, values))
    right = row.get("right", unit)
    marks = [] if same else ["value"]
    marks += ["unit"] if unit not in ("", right) else []
    source = f"`{row['key']}`" if "key" in row else "computed from the parts"
    if row.get("derived") == "gravity":
        source = "`core.types.GRAVITY`"
    ours = printed if same else [f"{value:.6g}" for value in values]
    shown = [", ".join(map(_plain, numbers)) or "none" for numbers in (printed, ours)]
    return TableRow(row["symbol"], row["meaning"], shown[0], unit, shown[1], right, source, ", ".join(marks))


def _plain(printed: str) -> str:
    """A printed number without a power of ten."""
    return format(Decimal(printed), "f")


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
    """A table as LaTeX, without the column of our numbers' sources."""
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
