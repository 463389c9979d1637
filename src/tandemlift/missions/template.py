"""`tandemlift template`: a commented mission file with every key, made from the tables."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

from tandemlift.core.errors import shown, written
from tandemlift.missions.sections import EXTENDS, PAPER, Key, Section, default_words, sections

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
