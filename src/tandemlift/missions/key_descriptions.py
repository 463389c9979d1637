"""All tables of a mission with their keys, in words; a key is a field of a table in its part's file, in `parts/`.

The tables are in the template's order, with those of every registered controller. The allowed values are read from the
type of a key, which also covers the keys of a user's controller.
"""

from __future__ import annotations

import inspect
import types
from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from tandemlift.core.errors import shown, written
from tandemlift.core.keys import KeyDescription, description_of
from tandemlift.core.plugs import Chosen
from tandemlift.missions.mission import Mission
from tandemlift.parts.controllers import CONTROLLERS, CascadeTable, ControllerTable

Model = type[BaseModel]
WORDS: dict[object, str] = {float: "a number", int: "a whole number", bool: "true or false", str: "text in quotes"}
LIMITS = {"gt": ">", "ge": "≥", "lt": "<", "le": "≤"}
PAPER = "nftsmc"  # whose keys stand for `[controller]` in the template
EXTENDS = KeyDescription(
    meaning="start from this mission and write only what differs: a built-in name, or a path relative to this file",
    example="paper",
)

PLUGINS = KeyDescription(
    meaning="files in Python, relative to this file, or installed packages, that bring parts, metrics and figures",
    example=["my.py"],
)


def table_in(annotation: object) -> Model | None:
    """The table inside an annotation such as `tuple[Quadrotor, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((t for t in map(table_in, get_args(annotation)) if t is not None), None)


def allowed(annotation: object, marks: Iterable[Any] = ()) -> str:
    """The allowed values of a key with this annotation, in words."""
    kind, parts = get_origin(annotation), [a for a in get_args(annotation) if a not in (type(None), Ellipsis)]
    if kind is Annotated:
        return allowed(parts[0], (*parts[1:], *marks))
    if kind is Literal:
        chosen = next((mark for mark in marks if isinstance(mark, Chosen)), None)
        *others, last = map(shown, chosen.names(parts) if chosen else parts)
        return f"{', '.join(others)} or {last}" if others else last
    if kind in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(allowed(part, marks) for part in parts))
    table = table_in(annotation)
    if table is not None:
        return "a list of tables" if kind is tuple else f"a table with {', '.join(table.model_fields)}"
    axes = next((mark for mark in marks if hasattr(mark, "describe")), None)
    if axes is not None:
        return axes.describe(limits(innermost(annotation)))
    size = f" of {len(parts)}" if kind is tuple and Ellipsis not in get_args(annotation) else ""
    otherwise = {None: "another kind of value", dict: "a table"}.get(kind, f"a list{size}")
    return f"{WORDS.get(annotation, otherwise)} {limits(marks)}".rstrip()


def innermost(annotation: object) -> tuple[Any, ...]:
    """The marks of the numbers in nested tuples."""
    while get_origin(annotation) is tuple:
        annotation = get_args(annotation)[0]
    return get_args(annotation)[1:]


def bounds(marks: Iterable[Any]) -> dict[str, float]:
    """The bounds that marks set, by their names `gt`, `ge`, `lt` and `le`."""
    flat = [inner for mark in marks for inner in getattr(mark, "metadata", [mark])]
    return {name: getattr(mark, name) for mark in flat for name in LIMITS if hasattr(mark, name)}


def limits(marks: Iterable[Any]) -> str:
    """The bounds as text, such as '> 0 and ≤ 0.02'."""
    return " and ".join(f"{LIMITS[name]} {limit:g}" for name, limit in bounds(marks).items())


def plain(annotation: object) -> object:
    """An annotation without its marks and without the None of a key that may be left out."""
    while get_origin(annotation) in (Annotated, Union, types.UnionType):
        annotation = get_args(annotation)[0]
    return annotation


class Key(NamedTuple):
    """A key of a mission: dotted name, in which 0 stands for any entry of a list of tables, type and description.

    `acts`: the condition of its table and its own without which it does not act; "" if there is none.
    """

    name: str
    field: FieldInfo
    facts: KeyDescription
    acts: str = ""

    @property
    def allowed(self) -> str:
        """The allowed values in words: the bounds, then further conditions."""
        words = allowed(self.field.annotation, self.field.metadata)
        return f"{words}; {self.facts.rule}" if self.facts.rule else words

    @property
    def bounds(self) -> dict[str, float]:
        """The bounds of its number, or of each of its numbers, as `bounds` gives them."""
        return bounds(innermost(self.field.annotation) or self.field.metadata)

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
        return text_of(self.model)


def text_of(model: Model) -> list[str]:
    """The description of a table, in paragraphs of one line each; the first is a phrase."""
    paragraphs = (inspect.getdoc(model) or "").split("\n\n")
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


def controller_names() -> list[str]:
    """The controllers that a mission may name, a user's loaded ones among them."""
    return sorted(CONTROLLERS)


def own_numbers(controller: str) -> Iterator[Key]:
    """The keys of a user's controller that are a number or a few, without those that all controllers share."""
    if controller not in CONTROLLERS or is_of_the_package(controller):
        return
    for one in _keys("controller", CONTROLLERS[controller].settings):
        parts = get_args(kind) if get_origin(kind := plain(one.field.annotation)) is tuple else (kind,)
        shared = one.name.removeprefix("controller.") in CascadeTable.model_fields
        if not shared and all(plain(part) is float for part in parts):
            yield one


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
    return tuple(Key(f"{above}.{n}", f, description_of(f), _acts(model, n, above)) for n, f in leaves.items())


def _acts(model: Model, name: str, above: str) -> str:
    both = getattr(model, "acts", ""), getattr(model, "conditions", {}).get(name, "")
    return ", ".join(one for one in both if one and not one.startswith(f"{above}.{name} "))


def default_words(key: Key) -> str:
    """The default of a key in words: 'required', a TOML value, or the effect of leaving the key out."""
    if key.field.is_required():
        return "required"
    if key.default is None:
        return key.facts.unset or "left out"
    return written(key.default)


def as_key(option: str, words: Sequence[str]) -> str:
    """What to write in place of an unknown option in a command's words that is a table or a key; "" for others."""
    name = option.lstrip("-").replace("-", "_")
    own = [key for section in sections() for key in section.keys if key.facts.unit]
    found = next((k for k in own if name in (k.name.rpartition(".")[0], k.name, k.name.rpartition(".")[2])), None)
    if found is None:
        return ""
    value = [*" ".join(words).partition(option)[2].lstrip(" =").split(), ""][0]
    number = value if value.lstrip("+-")[:1].isdigit() else "…"
    vector = "3 numbers" in found.allowed and not found.allowed.startswith("one number")
    return f"it is a key of the mission: --set {found.name}={f'[{number},0,0]' if vector else number}"
