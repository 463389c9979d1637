"""`tandemlift schema`: the JSON Schema (draft 7) of a mission file, for editors of TOML.

A file that extends another one may omit required keys. Entries of lists are replaced as a whole, so theirs stay
required. Conditions between keys, such as a landing after the lift, are checked when a mission is loaded.
"""

from __future__ import annotations

import types
from collections.abc import Iterable
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo

from tandemlift.core.keys import description_of
from tandemlift.core.plugs import Chosen
from tandemlift.missions.key_descriptions import EXTENDS, PLUGINS, Model, bounds, compact, table_in, text_of
from tandemlift.missions.mission import Mission
from tandemlift.parts.controllers import CONTROLLERS, ControllerTable
from tandemlift.parts.guidance.admittance import AdmittanceTable

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


def _table(model: Model) -> Schema:
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
        return {"type": "array", "description": _text(table), "items": {**_table(table), **_required(table)}}
    if table is not None:
        return _table(table)
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
