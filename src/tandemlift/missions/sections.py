"""All tables of a mission with their keys, in the template's order, and those of every registered controller."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from typing import NamedTuple, get_origin

from pydantic.fields import FieldInfo

from tandemlift.core.errors import written
from tandemlift.core.keys import KeyDescription, description_of
from tandemlift.missions.bounds import Model, allowed, table_in
from tandemlift.missions.tables.mission import Mission
from tandemlift.parts.controllers import CONTROLLERS, ControllerTable

PAPER = "nftsmc"  # whose keys stand for `[controller]` in the template
EXTENDS = KeyDescription(
    meaning="start from this mission and write only what differs: a built-in name, or a path relative to this file",
    example="paper",
)


class Key(NamedTuple):
    """A key of a mission: dotted name, in which 0 stands for any entry of a list of tables, type and description."""

    name: str
    field: FieldInfo
    facts: KeyDescription

    @property
    def allowed(self) -> str:
        """The allowed values in words: the bounds, then further conditions."""
        words = allowed(self.field.annotation, self.field.metadata)
        return f"{words}; {self.facts.rule}" if self.facts.rule else words

    @property
    def default(self) -> object:
        """The default as plain numbers, one for all axes if they are equal; None if there is no default."""
        return None if self.field.is_required() else compact(self.field, self.field.default)

    @property
    def example(self) -> object:
        """The value to show: the key's example, else its default."""
        return self.default if self.facts.example is None else self.facts.example


class Section(NamedTuple):
    """A table of a mission: its dotted name, its header in TOML, its description, and its own keys.

    `controller`: the name of the controller whose settings they are, else "". `optional`: left out by default.
    """

    name: str
    header: str
    model: Model
    keys: tuple[Key, ...]
    controller: str = ""
    optional: bool = False

    @property
    def text(self) -> list[str]:
        """The description of the table, in paragraphs of one line each; the first is a phrase."""
        paragraphs = (inspect.getdoc(self.model) or "").split("\n\n")
        first, *others = [" ".join(p.split()) for p in paragraphs]
        return [(first.partition("`: ")[2] or first).removesuffix("."), *others]


def compact(field: FieldInfo, value: object) -> object:
    """A value as lists, or as one number if all axes have the same."""
    if not isinstance(value, tuple):
        return value
    inner = [compact(field, entry) for entry in value]
    marks = [mark for mark in field.metadata if hasattr(mark, "describe")]
    single = any(getattr(mark, "single", True) for mark in marks)
    alike = single and inner and all(x == inner[0] and isinstance(x, (int, float)) for x in inner)
    return inner[0] if alike else inner


def sections() -> Iterator[Section]:
    """The tables of a mission, each before the tables in it; those of other controllers follow the paper's."""
    for name, field in Mission.model_fields.items():
        if name == "controller":
            yield from _controllers()
        else:
            yield from _sections(name, field)


def is_of_the_package(controller: str) -> bool:
    """Whether a section's controller, if it has one, is built in and not from a user's file."""
    return not controller or CONTROLLERS[controller].start.__module__.startswith("tandemlift.")


def _controllers() -> Iterator[Section]:
    yield Section("controller", "[controller]", ControllerTable, _keys("controller", ControllerTable))
    others = [name for name in CONTROLLERS if name != PAPER]
    for name in (PAPER, *sorted(others)):
        model = CONTROLLERS[name].settings
        own = tuple(key for key in _keys("controller", model) if key.name != "controller.name")
        yield Section("controller", "[controller]", model, own, name)
        for inner, field in model.model_fields.items():
            yield from (s._replace(controller=name) for s in _sections(f"controller.{inner}", field))


def _sections(name: str, field: FieldInfo) -> Iterator[Section]:
    model, many = table_in(field.annotation), get_origin(field.annotation) is tuple
    if model is None:
        return
    plain = name.replace(".0", "")
    entry = f"{name}.0" if many else name
    header = f"[[{plain}]]" if many else f"[{plain}]"
    optional = not field.is_required() and field.default in ((), None)
    yield Section(plain, header, model, _keys(entry, model), optional=optional)
    for inner, below in model.model_fields.items():
        yield from _sections(f"{entry}.{inner}", below)


def _keys(above: str, model: Model) -> tuple[Key, ...]:
    leaves = {name: field for name, field in model.model_fields.items() if table_in(field.annotation) is None}
    return tuple(Key(f"{above}.{name}", field, description_of(field)) for name, field in leaves.items())


def default_words(key: Key) -> str:
    """The default of a key in words: 'required', a TOML value, or the effect of leaving the key out."""
    if key.field.is_required():
        return "required"
    if key.default is None:
        return key.facts.unset or "left out"
    return written(key.default)
