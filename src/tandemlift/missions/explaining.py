"""`tandemlift explain KEY`: the description of a key or a table in a few lines."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from tandemlift.core.errors import InputError, shown
from tandemlift.core.files import parts_of
from tandemlift.missions.sections import EXTENDS, Key, Section, default_words, sections

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
    if plain == "extends":
        return f"extends: {EXTENDS.meaning}."
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
    near = nearest_three(
        plain[:100], {plain_name(key.name): key.name for section in sections() for key in section.keys}
    )
    return InputError(f"there is no key {shown(name)}; the nearest are {', '.join(near)}")


def nearest_three(given: str, names: dict[str, str]) -> list[str]:
    """The three names most similar to the given one, as a whole or in their last parts."""

    def likeness(name: str) -> float:
        whole = difflib.SequenceMatcher(None, given, name).ratio()
        last = difflib.SequenceMatcher(None, given.rpartition(".")[2], name.rpartition(".")[2]).ratio()
        return max(whole, 0.5 * (whole + last), last - 0.05)

    return [names[name] for name in sorted(names, key=likeness, reverse=True)[:NEAREST]]
