"""The reference of all keys of a mission, made from its tables.

A key in a few lines (`tandemlift explain KEY`), and a commented mission file with every key (`tandemlift template`).
"""

from __future__ import annotations

import difflib
import textwrap
from collections.abc import Iterable, Iterator
from typing import Any

from tandemlift.core.errors import InputError, shown, written
from tandemlift.core.files import parts_of
from tandemlift.missions.key_descriptions import EXTENDS, PAPER, PLUGINS, Key, Section, default_words, sections
from tandemlift.missions.refusals import present_name

NEAREST = 3


def explained(name: str, controller: str = "") -> str:
    """The description of a key in one to three lines, or of a table with a line for each key.

    Args:
        name: a dotted key or a table.
        controller: only the tables of this controller, if several have one of that name; "" for all.

    Raises:
        InputError: there is none of that name, and the message names the three nearest; or it has too many parts.
    """
    plain = plain_name(name)
    for name, facts in {"extends": EXTENDS, "plugins": PLUGINS}.items():
        if plain == name:
            return f"{name}: {facts.meaning}."
    found = [(section, key) for section in sections() for key in section.keys if plain_name(key.name) == plain]
    if found:
        return "\n".join(_keys(found))
    tables = [section for section in sections() if section.name == plain]
    if controller in [section.controller for section in tables]:
        tables = [section for section in tables if section.controller in ("", controller)]
    if tables:
        return "\n\n".join(_table(section) for section in tables)
    raise _unknown(name, plain)


def index() -> str:
    """All tables, one line each."""
    seen = dict[str, str]()
    for section in sections():
        seen.setdefault(section.header, section.text[0])
    width = max(map(len, seen)) + 2
    return "\n".join(f"{header:{width}}{text}" for header, text in seen.items())


def plain_name(name: str) -> str:
    """A dotted key without the numbers and brackets that pick entries of lists.

    Raises:
        InputError: it has more parts than any key.
    """
    parts = parts_of(name.strip("[]").replace("[]", "").replace("[", ".").replace("]", ""))
    return ".".join(part for part in parts if part and not part.isdigit())


def lines_of(key: Key) -> list[str]:
    """A key in two or three lines: unit and meaning; allowed values; the default and its source."""
    facts = key.facts
    unit = "" if facts.unit is None else f" [{facts.unit}]"
    lines = [f"{key.name}{unit}: {facts.meaning or 'no description'}"]
    if facts.choices:
        lines.append("  " + "; ".join(f"{shown(choice)}: {text}" for choice, text in facts.choices.items()))
        last = f"  {facts.rule}. " if facts.rule else "  "
    else:
        last = f"  Allowed: {key.allowed}. "
    source = f" ({facts.source})" if facts.source else ""
    if key.field.is_required():
        lines.append(f"{last}Required.")
    elif key.default is None:
        lines.append(f"{last}If left out: {default_words(key)}{source}.")
    else:
        lines.append(f"{last}Default: {default_words(key)}{source}.")
    lines[-1] += f" Acts where {key.acts}." if key.acts else ""
    return lines


def _keys(found: Iterable[tuple[Section, Key]]) -> list[str]:
    """The lines of a key, once for all controllers with the same description."""
    said: dict[str, list[str]] = {}
    for section, key in found:
        said.setdefault("\n".join(lines_of(key)), []).append(section.controller)
    return [f"{text}\n  Of {', '.join(names)}." if len(said) > 1 else text for text, names in said.items()]


def _table(section: Section) -> str:
    of = f" of {section.controller}" if section.controller else ""
    head = [f"{section.header}{of}: {section.text[0]}", *section.text[1:]]
    width = max((len(key.name) for key in section.keys), default=0) + 2
    inner = [
        s.header for s in sections() if s.name.startswith(f"{section.name}.") and s.controller == section.controller
    ]
    tables = [f"  tables: {', '.join(inner)}"] if inner else []
    return "\n".join([*head, *(f"  {key.name:{width}}{_in_short(key)}" for key in section.keys), *tables])


def _in_short(key: Key) -> str:
    unit = "" if key.facts.unit in (None, "1") else f"[{key.facts.unit}] "
    return f"{unit}{key.facts.meaning}"


def _unknown(name: str, plain: str) -> InputError:
    if (now := present_name(plain)) != plain:
        return InputError(f"there is no key {shown(name)}; it is {now} now")
    names = {plain_name(key.name): key.name for section in sections() for key in section.keys}
    table = {short: long for short, long in names.items() if short.rpartition(".")[0] == plain.rpartition(".")[0]}
    near = nearest_three(plain[:100], table or names)
    return InputError(f"there is no key {shown(name)}; the nearest are {', '.join(near)}")


def nearest_three(given: str, names: dict[str, str]) -> list[str]:
    """The three names most similar to the given one, as a whole or in their last parts."""

    def likeness(name: str) -> float:
        whole = difflib.SequenceMatcher(None, given, name).ratio()
        last = difflib.SequenceMatcher(None, given.rpartition(".")[2], name.rpartition(".")[2]).ratio()
        return max(whole, 0.5 * (whole + last), last - 0.05)

    return [names[name] for name in sorted(names, key=likeness, reverse=True)[:NEAREST]]


# ---- The template

HEAD = """\
# A mission of tandemlift with every key. SI units, angles in rad. World axes have z up; body axes are fixed to the
# vehicle, and a beam lies along body y. Six-vectors run x, y, z, roll, pitch, yaw. Where a value is given per axis, one
# number serves all axes. Only keys marked "required" must be given, and only if their table is; for the others the
# default stands in brackets if it is not the value shown. What has a "#" before it is left out here.
# `tandemlift explain KEY` tells bounds and sources as well.

"""
WIDTH, COLUMN = 120, 34  # of a line, and where its comment starts
GIVEN = {  # no default; given here so that the template flies and lands
    *("vehicle.payload.length", "vehicle.payload.radius", "vehicle.quadrotors.0.arm", "phases.land_start"),
    "pushes",
}
SECOND = {"vehicle.quadrotors": {"position": [0.0, -1.0, 0.075]}}  # another entry of a list, with its differences


def template_text() -> str:
    """A commented mission file with every key, its unit and its meaning, which can be flown as it is."""
    extends = _commented(f'extends = "{EXTENDS.example}"', EXTENDS.meaning, "# ")
    blocks = [_block(section) for section in _shown()]
    return HEAD + "\n\n".join(["\n".join(extends), *("\n".join(block) for block in blocks)]) + "\n"


def _shown() -> Iterator[Section]:
    """The sections of the template; the keys of the paper's controller follow the controller's name."""
    ours = [section for section in sections() if section.controller in ("", PAPER)]
    own = next(s for s in ours if s.controller == PAPER and s.name == "controller")
    for section in ours:
        if section.name == "controller":
            if not section.controller:
                yield section._replace(keys=(*section.keys, *own.keys))
        elif section.keys:
            yield section


def _block(section: Section) -> Iterator[str]:
    """The lines of a table."""
    off = "# " if section.optional and section.name not in GIVEN else ""
    yield from _commented(section.header, section.text[0], off)
    for key in section.keys:
        left_out = "" if off or key.default is not None or key.field.is_required() or key.name in GIVEN else "# "
        yield from _commented(_statement(key, key.example), comment_of(key), off or left_out)
    if section.name in SECOND:
        yield from ["", section.header, *_second(section, SECOND[section.name])]


def _second(section: Section, differing: dict[str, Any]) -> Iterator[str]:
    """The statements of a list's second entry: the keys that have no default value in the first."""
    for key in section.keys:
        name = key.name.rpartition(".")[2]
        if name in differing or key.name in GIVEN or (key.facts.example is not None and key.default is not None):
            yield _statement(key, differing.get(name, key.example))
        elif key.field.is_required():
            yield _statement(key, key.example)


def _statement(key: Key, value: object) -> str:
    return f"{key.name.rpartition('.')[2]} = {written(value)}"


def comment_of(key: Key) -> str:
    """Unit, meaning and choices of a key, and its default if that is not the value shown."""
    facts = key.facts
    unit = "" if facts.unit in (None, "1") else f"{facts.unit}: "
    choices = "; ".join(f"{shown(choice)}: {text}" for choice, text in facts.choices.items())
    words = f"{unit}{facts.meaning}{f' ({choices})' if choices else ''}"
    if key.field.is_required():
        return f"{words} [required]"
    if key.default is None:
        return f"{words} [if left out: {default_words(key)}]"
    return words if key.example == key.default else f"{words} [default: {default_words(key)}]"


def _commented(statement: str, comment: str, off: str) -> list[str]:
    """A statement with its comment beside it, continued below if it is long; `off` precedes each line."""
    column = max(COLUMN, len(off) + len(statement) + 2)
    beside = WIDTH - column - 2
    if beside < 40:  # too little room: the comment stands above
        return [*(f"{off or '# '}{line}" for line in textwrap.wrap(comment, WIDTH - 4)), off + statement]
    first, *rest = textwrap.wrap(comment, beside, break_long_words=False, break_on_hyphens=False)
    lead = f"{off.rstrip():{column}}"
    return [f"{off + statement:{column}}# {first}", *(f"{lead}# {line}" for line in rest)]
