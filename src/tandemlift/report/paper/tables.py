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

from tandemlift.algebra.constants import GRAVITY
from tandemlift.report.latex import latex_text
from tandemlift.report.paper.errata import DATA, errata
from tandemlift.vehicle import Vehicle

AXES = {"position": slice(0, 3), "attitude": slice(3, 6), "one": slice(None)}
DERIVED = {
    "mass": lambda vehicle: vehicle.mass,
    "inertia": lambda vehicle: np.diag(vehicle.inertia),
    "payload inertia": lambda vehicle: vehicle.payload.moments,
    "gravity": lambda vehicle: GRAVITY,
}
HEADINGS = ("symbol", "meaning", "printed", "unit", "here", "unit here", "from", "agrees")


class TableRow(NamedTuple):
    """A row: numbers as the paper prints them and as the mission has them, with units, and where ours are from.

    Attributes:
        symbol: of the paper.
        meaning: of it.
        printed: the paper's numbers.
        unit: the paper's unit.
        ours: the mission's numbers in as many digits, or in full where they differ.
        right: our unit.
        source: the key of the mission, or what is computed.
        mark: what differs: `value`, `unit`, or nothing.
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


def value_at(mission: Mapping[str, Any], key: str) -> Any:
    """The value of a dotted key of a mission.

    Raises:
        KeyError: there is none.
    """
    value: Any = mission
    for part in key.split("."):
        value = value[int(part) if part.isdigit() else part]
    return value


def _numbers(row: Mapping[str, Any], mission: Mapping[str, Any]) -> list[float]:
    """Our numbers of a row, as many as the paper prints; several that are printed as one must be equal."""
    if "derived" in row:
        values = np.atleast_1d(DERIVED[row["derived"]](Vehicle.from_mission(mission)))
    else:
        values = np.atleast_1d(value_at(mission, row["key"]))[AXES[row.get("axes", "one")]]
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
        source = "`algebra.constants.GRAVITY`"
    ours = printed if same else [f"{value:.6g}" for value in values]
    shown = [", ".join(map(_plain, numbers)) for numbers in (printed, ours)]
    return TableRow(row["symbol"], row["meaning"], shown[0], unit, shown[1], right, source, ", ".join(marks))


def _plain(printed: str) -> str:
    """A printed number without a power of ten."""
    return format(Decimal(printed), "f")


def as_csv(table: PaperTable) -> str:
    """A table as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADINGS)
    writer.writerows([*row[:-1], row.mark or "yes"] for row in table.rows)
    return text.getvalue().replace("`", "")


LATEX_COLUMNS = "lllllll"


def latex_head() -> list[str]:
    """The cells of the first row in LaTeX."""
    return [latex_text(heading) for heading in HEADINGS if heading != "from"]


def latex_rows(table: PaperTable) -> list[list[str]]:
    """The rows of a table in LaTeX."""
    return [
        [latex_symbol(row.symbol), *map(_latex_unit, (row.meaning, row.printed, row.unit, row.ours, row.right))]
        + [row.mark or "yes"]
        for row in table.rows
    ]


GREEK = {letter: f"\\{name}" for letter, name in zip("ξηλφθψμΩωτχ", (
    "xi", "eta", "lambda", "phi", "theta", "psi", "mu", "Omega", "omega", "tau", "chi"), strict=True)}
SUBSCRIPTS = {"₁": "_1", "₂": "_2"}


def latex_symbol(text: str) -> str:
    """Symbols such as ξ_φ or J_tx in LaTeX's mathematics."""
    found = re.sub(r"_(\w+)", lambda match: "_{" + match[1] + "}", text)
    for character, name in (GREEK | SUBSCRIPTS).items():
        found = found.replace(character, name + (" " if character in GREEK else ""))
    return re.sub(r"[^,\s][^,]*", lambda match: f"${match[0].strip()}$", found)


def _latex_unit(text: str) -> str:
    """Text in LaTeX with powers and Greek letters."""
    return "".join(f"${GREEK[c]}$" if c in GREEK else "$^2$" if c == "²" else latex_text(c) for c in text)
