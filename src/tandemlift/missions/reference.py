"""The reference of all keys of a mission, made from its tables.

A key in a few lines (`tandemlift explain KEY`), a commented mission file with every key (`tandemlift template`), and
the JSON Schema (draft 7) of a mission file, for editors of TOML (`tandemlift schema`).

In the schema a file that extends another one may omit required keys. Entries of lists are replaced as a whole, so
theirs stay required. Conditions between keys, such as a landing after the lift, are checked when a mission is loaded.
"""

from __future__ import annotations

import difflib
import textwrap
import types
from collections.abc import Iterable, Iterator
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo

from tandemlift.core.errors import InputError, shown, written
from tandemlift.core.files import parts_of
from tandemlift.core.keys import description_of
from tandemlift.core.plugs import Chosen
from tandemlift.missions.key_descriptions import (
    EXTENDS,
    PAPER,
    PLUGINS,
    Key,
    Model,
    Section,
    bounds,
    compact,
    default_words,
    sections,
    table_in,
    text_of,
)
from tandemlift.missions.mission import Mission
from tandemlift.missions.refusals import present_name
from tandemlift.parts.controllers import CONTROLLERS, ControllerTable
from tandemlift.parts.guidance.admittance import AdmittanceTable

NEAREST_KEYS = 3


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

    return [names[name] for name in sorted(names, key=likeness, reverse=True)[:NEAREST_KEYS]]


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


# ---- The schema

Schema = dict[str, Any]
KEYWORDS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}
TYPES = {float: "number", int: "integer", bool: "boolean", str: "string"}


def mission_schema() -> Schema:
    """The schema of a mission file, with the settings of every registered controller."""
    properties = {name: schema_of(field) for name, field in Mission.model_fields.items() if name != "controller"}
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "tandemlift mission",
        "description": "Everything that a flight depends on, in SI units.",
        "type": "object",
        "properties": {
            "extends": {"type": "string", "description": EXTENDS.meaning, "examples": [EXTENDS.example]},
            "plugins": {"type": "array", "description": PLUGINS.meaning, "examples": [PLUGINS.example]},
            **properties,
            "controller": _controllers(),
        },
        "additionalProperties": False,
        "if": {"not": {"required": ["extends"]}},
        "then": _required(Mission),
    }


def _table_schema(model: Model) -> Schema:
    """A table that may be incomplete, because the extended mission may complete it."""
    return {
        "type": "object",
        "description": _text(model),
        "properties": {name: schema_of(field) for name, field in model.model_fields.items()},
        "additionalProperties": False,
    }


def _text(model: Model) -> str:
    first, *others = text_of(model)
    return "\n\n".join([f"{first}.", *others])


def schema_of(field: FieldInfo) -> Schema:
    """The schema of a key or of a table."""
    table = table_in(field.annotation)
    if table is not None and get_origin(field.annotation) is tuple:
        return {"type": "array", "description": _text(table), "items": {**_table_schema(table), **_required(table)}}
    if table is not None:
        return _table_schema(table)
    return {**_leaf(field.annotation, field.metadata), **_facts(field)}


def _facts(field: FieldInfo) -> Schema:
    """Title, description, default and examples of a key; the meanings of its choices for the editors' extension."""
    facts, found = description_of(field), Schema()
    unit = "" if facts.unit in (None, "1") else f" [{facts.unit}]"
    choices = [f"{choice}: {text}" for choice, text in facts.choices.items()]
    sentences = [f"{facts.meaning}{unit}", facts.rule, facts.unset and f"If left out: {facts.unset}", *choices]
    found["description"] = "\n\n".join(f"{s}." for s in sentences if s)
    if not field.is_required() and field.default is not None:
        found["default"] = compact(field, field.default)
    if facts.example is not None:
        found["examples"] = [facts.example]
    if facts.unit is not None:
        found["x-unit"] = facts.unit
    if facts.choices:
        found["x-taplo"] = {"docs": {"enumValues": list(facts.choices.values())}}
    return found


def _leaf(annotation: object, marks: Iterable[Any] = ()) -> Schema:
    """The schema of a value with this annotation."""
    kind = get_origin(annotation)
    parts = [part for part in get_args(annotation) if part not in (type(None), Ellipsis)]
    if kind is Annotated:
        return _leaf(parts[0], (*parts[1:], *marks))
    if kind is Literal:
        chosen = next((mark for mark in marks if isinstance(mark, Chosen)), None)
        return {"enum": chosen.names(parts) if chosen else parts}
    if kind in (Union, types.UnionType):
        forms = [_leaf(part, marks) for part in parts]
        return forms[0] if len(forms) == 1 else {"anyOf": forms}
    spread = next((mark for mark in marks if hasattr(mark, "describe")), None)
    if spread is not None:
        return _spread(spread, annotation)
    if kind is tuple:
        size = {} if Ellipsis in get_args(annotation) else {"minItems": len(parts), "maxItems": len(parts)}
        return {"type": "array", "items": _leaf(parts[0]), **size}
    if annotation not in TYPES:
        return {}  # any value
    return {"type": TYPES[annotation], **{KEYWORDS[name]: limit for name, limit in bounds(marks).items()}}


def _spread(mark: object, annotation: object) -> Schema:
    """The schema of a key given per axis: a list, or a shorter form that its mark accepts."""
    whole = _leaf(annotation)
    if not getattr(mark, "single", True):
        return {"anyOf": [whole, {"const": 0}]} if getattr(mark, "count", 0) == 3 else whole
    forms, inner = [whole], whole
    while inner["type"] == "array":
        inner = inner["items"]
        forms.insert(0, inner)
    return {"anyOf": forms}


def _required(model: Model) -> Schema:
    """The required keys of a table and of its tables, where no extended mission completes it."""
    names = [name for name, field in model.model_fields.items() if field.is_required()]
    if model is AdmittanceTable:
        given = {"anyOf": [{"required": ["mass", "damping"]}, {"required": ["feel"]}]}
        return {"required": ["threshold"], **given}
    tables = {name: table_in(field.annotation) for name, field in model.model_fields.items() if field.is_required()}
    single = {n: t for n, t in tables.items() if t and get_origin(model.model_fields[n].annotation) is not tuple}
    inner = {name: _required(table) for name, table in single.items()}
    return {"required": names, **({"properties": inner} if inner else {})} if names else {}


def _described(schema: Schema) -> Schema:
    """The description of a key without its values: other controllers may have the key too."""
    inner = {name: _described(below) for name, below in schema.get("properties", {}).items()}
    return {"description": schema["description"], **({"properties": inner} if inner else {})}


def _controllers() -> Schema:
    """The controller's table: any name, for a user's controller; the keys of registered ones are checked."""
    known = {name: CONTROLLERS[name].settings for name in sorted(CONTROLLERS)}
    shown, cases = Schema(), list[Schema]()
    for name, model in known.items():
        keys = {key: schema_of(field) for key, field in model.model_fields.items() if key != "name"}
        for key, schema in keys.items():
            shown.setdefault(key, _described(schema))
        named = {"properties": {"name": {"const": name}}, "required": ["name"]}
        cases.append({"if": named, "then": {"properties": keys, "propertyNames": {"enum": ["name", *keys]}}})
    title = {"description": f"{description_of(ControllerTable.model_fields['name']).meaning}.", "examples": list(known)}
    properties = {"name": {"type": "string", **title}, **shown}
    return {"type": "object", "description": _text(ControllerTable), "properties": properties, "allOf": cases}
