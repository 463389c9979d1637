"""Tables as programs write them: text with a line of names above lines of numbers.

The encoding is that of the file's first bytes, else UTF-8, else Windows' (cp1252). The line of names and the separator
are those that give the columns which are asked for. A comma is the decimal sign where the separator is another one and
numbers have it. Lines that begin with # or %, and lines of units below the names, are passed over. Only columns that
are asked for are parsed. Motive and Vicon write several lines of names; `motive_layout` and `vicon_layout` read them.
"""

from __future__ import annotations

import csv
import itertools
import math
import re
from array import array
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from tandemlift.apps.export.log_tables import LogTables
from tandemlift.core.errors import InputError, shown
from tandemlift.core.types import Array

SEPARATORS = (",", ";", "\t", "|", None)  # None: blanks
HEAD = 400  # lines in which the names are sought
UNIT_LINES = 4  # lines, at most, between names and numbers
BATCH = 20_000  # lines that are parsed at once
COMMENT = ("#", "%", "//")
NOTHING = {"", "nan", "na", "n/a", "null", "none", "-"}  # cells without a number
DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+([eE][-+]?\d+)?\s*")
THOUSANDS = re.compile(r"\s*[-+]?[1-9]\d{0,2},\d{3}\s*")
UNIT_IN_NAME = re.compile(r"(.*?)\s*[(\[](.*)[)\]]\s*")
LENGTHS = {"Meters": 1.0, "Centimeters": 0.01, "Millimeters": 0.001, "Inches": 0.0254, "Feet": 0.3048}
VICON_UNITS = {"mm": 1e-3, "m": 1.0, "cm": 1e-2, "deg": math.pi / 180.0, "rad": 1.0, "": 1.0}


@dataclass(frozen=True)
class Layout:
    """How a table stands in its file.

    Attributes:
        separator: between cells; None for blanks.
        decimal: the decimal sign.
        names: of its columns, in their order; those with "" cannot be asked for.
        first: the line, from 0, of the first numbers, or of the units above them.
        units: what a line of units, or its name, says of a column, by name.
        factors: with which numbers are multiplied, by name.
        ends: whether an empty line ends it, with other tables below.
    """

    separator: str | None
    names: tuple[str, ...]
    first: int
    decimal: str = "."
    units: Mapping[str, str] = field(default_factory=dict)
    factors: Mapping[str, float] = field(default_factory=dict)
    ends: bool = False


def encoding_of(path: Path) -> str:
    """The encoding of a file by its first bytes; of one without a mark "utf-8", or "cp1252" if it cannot be that."""
    with path.open("rb") as file:
        begin = file.read(4096)
        if begin[:2] in (b"\xff\xfe", b"\xfe\xff"):
            return "utf-16"
        if b"\0" in begin[:64]:
            return "utf-16-le" if begin[1:2] == b"\0" else "utf-16-be"
        file.seek(0)
        try:
            for line in file:
                line.isascii() or line.decode("utf-8")
        except UnicodeDecodeError:
            return "cp1252"
    return "utf-8-sig"


def _cells(line: str, separator: str | None) -> list[str]:
    if separator is None:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])]


def find_layout(path: Path, head: Sequence[str], wanted: Iterable[str], settings: Any) -> Layout:
    """The layout of a table whose names are in one line, or in the lines `names_line` of a map, joined by points.

    Args:
        path: of the file, for messages.
        head: its first lines.
        wanted: the columns that are asked for.
        settings: the map's `separator`, `decimal` and `names_line`; None where it does not say.
    """
    asked = {*wanted}
    said = {"tab": "\t", "blank": None}.get(settings.separator, settings.separator)
    separators = SEPARATORS if settings.separator is None else (said,)
    lines = [settings.names_line] if isinstance(settings.names_line, int) else settings.names_line
    if lines and max(lines) > len(head):
        raise InputError(f"{path}: names_line = {shown(settings.names_line)}: there are {len(head)} lines")
    best: tuple[tuple[int, int, int], str | None, tuple[str, ...], int] | None = None
    for separator in separators:
        for first in [max(lines) - 1] if lines else range(len(head)):
            rows = [_cells(head[i - 1], separator) for i in lines or [first + 1]]
            names = _joined(rows)
            if not names or (not lines and (head[first].startswith("//"))):
                continue
            if names[0].startswith(COMMENT) and not asked & {names[0]}:
                cut = names[0].lstrip("#%").strip()
                names = (cut, *names[1:]) if cut else names[1:]
            here = len(asked & {*names}), -first, len(names)
            if best is None or here > best[0]:
                best = here, separator, names, first + 1
    if best is None:
        raise InputError(f"{path}: has no line of names")
    _, separator, names, first = best
    units = {name: match[2] for name in names if (match := UNIT_IN_NAME.fullmatch(name))}
    return Layout(separator, names, first, settings.decimal or ".", units)


def _joined(rows: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """The names of columns from several lines; a name of an upper line stands for the empty cells behind it, too."""
    width = max(map(len, rows), default=0)
    full = [[*row, *[""] * (width - len(row))] for row in rows]
    for row in full[:-1]:
        for i in range(1, width):
            row[i] = row[i] or row[i - 1]
    return tuple(".".join(part for part in parts if part) for parts in zip(*full, strict=True))


def motive_layout(path: Path, head: Sequence[str], rigid_body: str | None) -> Layout:
    """The layout of a table of OptiTrack's Motive, "Data Export: CSV": time, Rotation.X … W, Position.X … Z of a body.

    Lines: facts of the take, types of columns, names, identities, parents (from 3.0 on), Rotation or Position, axes.
    """
    rows = [_cells(line, ",") for line in head]
    types = next((i for i, row in enumerate(rows) if {"Rigid Body", "Bone"} & {*row}), None)
    kinds = next((i for i, row in enumerate(rows[:-1]) if types is not None and i > types and "Rotation" in row), None)
    if types is None or kinds is None:
        raise InputError(f"{path}: no rigid body in it: is it a CSV of Motive, exported with rigid bodies and header?")
    facts = dict(zip(rows[0][::2], rows[0][1::2], strict=False))
    for key, right in {"Rotation Type": "Quaternion", "Coordinate Space": "Global"}.items():
        if facts.get(key, right) != right:
            raise InputError(f"{path}: {key} is {facts[key]}: export it with {key} = {right}")
    unit = facts.get("Length Units", "Meters")
    if unit not in LENGTHS:
        raise InputError(f"{path}: Length Units is {unit}: must be one of {', '.join(LENGTHS)}")
    width = len(rows[kinds + 1])
    kind, body, what = ([*rows[i], *[""] * (width - len(rows[i]))] for i in (types, types + 1, kinds))
    own = [i for i in range(2, width) if kind[i] in ("Rigid Body", "Bone") and what[i] in ("Rotation", "Position")]
    chosen = _one_of(path, list(dict.fromkeys(body[i] for i in own)), rigid_body)
    names = [f"{what[i]}.{rows[kinds + 1][i]}" if i in own and body[i] == chosen else "" for i in range(width)]
    names[:2] = ["frame", "time"]
    factors = {f"Position.{axis}": LENGTHS[unit] for axis in "XYZ"}
    return Layout(",", tuple(names), kinds + 2, factors=factors)


def vicon_layout(path: Path, head: Sequence[str], rigid_body: str | None) -> Layout:
    """The layout of a table that Vicon's Tracker or Nexus exports: time, RX … RW, TX … TZ of an object or segment.

    Lines: the kind of table, its rate in Hz, names of objects, axes with Frame and Sub Frame first, units. In a table
    of trajectories, markers have X, Y, Z. Lengths become metres, angles radians. Others may follow an empty line.
    """
    separator = "\t" if any(line.startswith("Frame\t") for line in head) else ","
    rows = [_cells(line, separator) for line in head]
    axes = next((i for i, row in enumerate(rows) if row[:2] == ["Frame", "Sub Frame"]), 0)
    try:
        rate = float(rows[axes - 2][0])
        if axes < 2 or rate <= 0.0:
            raise ValueError
    except (ValueError, IndexError):
        raise InputError(f"{path}: has no line Frame, Sub Frame two below its rate: is it a CSV of Vicon?") from None
    objects, units = (rows[i] + [""] * (len(rows[axes]) - len(rows[i])) for i in (axes - 1, axes + 1))
    for i in range(3, len(objects)):
        objects[i] = objects[i] or objects[i - 1]
    short = [name.rpartition(":")[2].strip() or name for name in objects]
    known = list(dict.fromkeys(name for name in short[2:] if name))
    chosen = _one_of(path, known, rigid_body and (rigid_body.rpartition(":")[2] or rigid_body))
    names = [axis if own == chosen else "" for own, axis in zip(short, rows[axes], strict=False)]
    names[:2] = ["time", "subframe"]
    wrong = [unit for name, unit in zip(names, units, strict=False) if name and unit not in VICON_UNITS]
    if wrong:
        raise InputError(f"{path}: unit {shown(wrong[0])}: must be one of {', '.join(filter(None, VICON_UNITS))}")
    factors = {name: VICON_UNITS[unit] for name, unit in zip(names, units, strict=False) if name} | {"time": 1.0 / rate}
    return Layout(separator, tuple(names), axes + 2, factors=factors, ends=True)


def _one_of(path: Path, names: Sequence[str], chosen: str | None) -> str:
    if chosen is None and len(names) == 1:
        return names[0]
    if chosen is None or chosen not in names:
        given = "must say which" if chosen is None else f"rigid_body = {shown(chosen)}"
        raise InputError(f"{path}: {given}: rigid_body must be one of {', '.join(names)}")
    return chosen


def read_table(path: Path, wanted: Iterable[str], settings: Any, kind: str = "") -> LogTables:
    """The table "" of a text file, with the columns that are asked for.

    Args:
        path: of the file.
        wanted: names of columns, one for each stream that needs it; those that are not there are left out.
        settings: the map's `separator`, `decimal`, `names_line` and `rigid_body`.
        kind: "optitrack" or "vicon", for their several lines of names.

    Raises:
        InputError: a line has another length, a cell that is asked for is no number, or there is none.
    """
    encoding, uses, asked = encoding_of(path), Counter(wanted := [*wanted]), [*dict.fromkeys(wanted)]
    try:
        with path.open(encoding=encoding, errors="replace" if encoding == "cp1252" else None, newline="") as file:
            head = [line.rstrip("\r\n") for line in itertools.islice(file, HEAD)]
            if kind:
                made = motive_layout if kind == "optitrack" else vicon_layout
                layout = made(path, head, settings.rigid_body)
            else:
                layout = find_layout(path, head, asked, settings)
            layout = _with_numbers(path, layout, head, asked, settings.decimal)
            names = [name for name in layout.names if name]
            for name in asked:
                if names.count(name) > 1:
                    raise InputError(f"{path}: has {names.count(name)} columns {name}: {OWN_NAME}")
            file.seek(0)
            columns = _read(path, file, layout, encoding, [name for name in asked if name in names])
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read as a table ({error})") from error
    for name, factor in layout.factors.items():
        if name in columns and factor != 1.0:
            columns[name] = columns[name] * factor

    def taken(_: str, copied: Sequence[str]) -> None:
        uses.subtract(copied)
        for name in copied:
            if not uses[name]:
                columns.pop(name, None)

    notes = [f"{path}: read as Windows' cp1252, since it is not UTF-8"] * (encoding == "cp1252")
    notes += [f"{path}: read with a decimal comma"] * (layout.decimal == "," and settings.decimal is None)
    return LogTables([""], lambda _: names, lambda _, n: columns[n], (), "", layout.units, tuple(notes), taken)


OWN_NAME = "one that is read must have its own name; names_line = [1, 2] joins the names of two lines as Upper.Lower"


def _with_numbers(path: Path, layout: Layout, head: Sequence[str], asked: Sequence[str], decimal: str | None) -> Layout:
    """A layout with the line of its first numbers, what a line above them says of units, and its decimal sign."""
    places = {name: layout.names.index(name) for name in asked if name in layout.names}
    units, first, commas = dict(layout.units), layout.first, list[str]()
    for i in range(layout.first, len(head)):
        row = _cells(head[i], layout.separator)
        cells = {name: row[k] for name, k in places.items() if k < len(row) and row[k].lower() not in NOTHING}
        numbers = [cell for cell in cells.values() if re.match(r"\s*[-+]?[.,]?(\d|inf)", cell, re.I)]
        if not numbers and (not row or not row[0] or cells) and i < layout.first + UNIT_LINES and first == i:
            units |= {name: cell.strip("()[] ") for name, cell in cells.items()}
            first = i + 1
        commas += [cell for cell in numbers if DECIMAL_COMMA.fullmatch(cell)]
    comma = decimal is None and bool(commas)
    if comma and all(map(THOUSANDS.fullmatch, commas)):
        raise InputError(f'{path}: is {commas[0]} a number of thousands? Say decimal = "." or decimal = ","')
    return replace(layout, first=first, units=units, decimal="," if comma else layout.decimal)


def _read(path: Path, file: Iterator[str], layout: Layout, encoding: str, names: Sequence[str]) -> dict[str, Array]:
    """The columns of these names, from all lines of numbers; a batch of lines is parsed after another."""
    places = [layout.names.index(name) for name in names]
    found = [array("d") for _ in names]
    below: Iterator[str] = itertools.islice(file, layout.first, None)
    reader: Iterator[list[str]] = map(str.split, below)
    if layout.separator is not None:  # quoted cells may have it in them
        reader = csv.reader(below, delimiter=layout.separator, skipinitialspace=True)
    line, is_cut = layout.first + 1, _is_cut(path, encoding)
    while rows := list(itertools.islice(reader, BATCH)):
        kept, numbers = _whole(path, rows, layout, line, is_cut)
        for column, place in zip(found, places, strict=True):
            column.extend(_numbers(path, [row[place] for row in kept], layout.decimal, numbers, line))
        line += len(rows)
        if layout.ends and not all(rows):
            break
    if found and not len(found[0]):
        raise InputError(f"{path}: has no line of numbers below the line of names")
    return {name: np.frombuffer(column) for name, column in zip(names, found, strict=True)}


def _is_cut(path: Path, encoding: str) -> bool:
    """Whether the last line of a file has no end, as after a crash."""
    with path.open("rb") as file:
        file.seek(-2 if encoding.startswith("utf-16") else -1, 2)
        return not {*file.read()} & {*b"\r\n"}


def _whole(
    path: Path, rows: list[list[str]], layout: Layout, line: int, is_cut: bool
) -> tuple[list[list[str]], Sequence[int]]:
    """(The rows of numbers among some lines, the place of each among these); `line`: the number of the first one."""
    width = len(layout.names)
    if all(len(row) == width and not row[0].startswith(COMMENT) for row in rows):
        return rows, range(len(rows))
    kept, places = list[list[str]](), list[int]()
    for i, row in enumerate(rows):
        if not any(row) and layout.ends:
            break
        if not any(row) or row[0].startswith(COMMENT):
            continue
        while len(row) > width and not row[-1].strip():
            row = row[:-1]
        if len(row) < width and layout.ends:
            row = [*row, *[""] * (width - len(row))]
        if len(row) < width and is_cut and i == len(rows) - 1 and len(rows) < BATCH:
            break  # the last line was not written to its end
        if len(row) != width:
            hint = "; a comma as decimal sign and separator? Export it with ; between" if len(row) > width else ""
            raise InputError(f"{path}: line {line + i} has {len(row)} cells, the line of names {width}{hint}")
        kept.append(row)
        places.append(i)
    return kept, places


def _numbers(path: Path, cells: Sequence[str], decimal: str, places: Sequence[int], line: int) -> array[float]:
    if decimal == ".":
        try:
            return array("d", [float(cell or "nan") for cell in cells])
        except ValueError:
            pass
    found = array("d")
    for place, cell in zip(places, cells, strict=True):
        text = cell.strip()
        try:
            found.append(math.nan if text.lower() in NOTHING else float(text.replace(decimal, ".")))
        except ValueError as error:
            hint = '; its decimal sign is a comma? decimal = ","' if DECIMAL_COMMA.fullmatch(text) else ""
            raise InputError(f"{path}: line {line + place}: {error}{hint}") from None
    return found
