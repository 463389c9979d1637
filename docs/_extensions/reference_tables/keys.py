"""A section with a table of keys for each table of a mission."""

from __future__ import annotations

from collections.abc import Iterator

from tandemlift.core.errors import shown
from tandemlift.missions.key_descriptions import (
    EXTENDS,
    PLUGINS,
    Key,
    Section,
    default_words,
    is_of_the_package,
    sections,
)

TABLE_HEAD = "| key | unit | default | meaning |\n|---|---|---|---|"


def key_tables() -> str:
    """A section with a table of keys for each table of a mission."""
    extends = f"`extends` (before all tables): {EXTENDS.meaning}.\n\n`plugins` (there, too): {PLUGINS.meaning}.\n"
    ours = (section for section in sections() if is_of_the_package(section.controller))
    return extends + "".join(_section(section) for section in ours)


def _section(section: Section) -> str:
    of = f" of `{section.controller}`" if section.controller else ""
    text = "\n\n".join(f"{p[0].upper()}{p[1:]}{'' if p.endswith('.') else '.'}" for p in section.text)
    rows = "\n".join([TABLE_HEAD, *map(_row, section.keys)]) + "\n" if section.keys else ""
    return f"\n## `{section.header}`{of}\n\n{text}\n" + (f"\n{rows}" if rows else "")


def _row(key: Key) -> str:
    facts = key.facts
    unit = "" if facts.unit in (None, "1") else facts.unit or ""
    return f"| `{key.name}` | {unit} | {_default(key)} | {'. '.join(_meaning(key))} |"


def _default(key: Key) -> str:
    words = default_words(key)
    if not key.field.is_required():
        words = f"if left out, {words}" if key.default is None else f"`{words}`"
    return f"{words}; {key.facts.source}" if key.facts.source else words


def _meaning(key: Key) -> Iterator[str]:
    yield key.facts.meaning
    if key.facts.choices:
        yield "; ".join(f"`{shown(choice)}`: {text}" for choice, text in key.facts.choices.items())
    if allowed := key.facts.rule if key.facts.choices else key.allowed:
        yield f"Allowed: {allowed}"
