"""What a mission key is, said once, where the key is defined: its unit, its meaning, and where its default is from.

Bounds are in the key's type. The template, the reference of keys, `tandemlift explain` and `tandemlift schema` are made
from both.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from pydantic import Field
from pydantic.fields import FieldInfo

DESCRIPTION = "key"  # names the description among what pydantic keeps of a field


class KeyDescription(NamedTuple):
    """What is said of a key beside its type and default; all of it in plain English, without a full stop.

    Attributes:
        unit: in SI, "1" for a number without a unit; None for what is no number.
        meaning: what the key is.
        source: where the default is from, or why it was chosen.
        rule: what else holds for its value, beyond its type.
        unset: what happens when the key is left out, for a key whose default is to be left out.
        example: a value for the template, where the default is none or would say little.
        choices: what each of its choices means.
    """

    unit: str | None = None
    meaning: str = ""
    source: str = ""
    rule: str = ""
    unset: str = ""
    example: Any = None
    choices: Mapping[str, str] = {}


def key(
    default: Any,
    unit: str | None,
    meaning: str,
    *,
    source: str = "",
    rule: str = "",
    unset: str = "",
    example: Any = None,
    choices: Mapping[str, str] | None = None,
) -> Any:
    """A field of a table with what is said of it; `...` as the default makes the key required. See `KeyDescription`."""
    description = KeyDescription(unit, meaning, source, rule, unset, example, choices or {})
    return Field(default, description=meaning, json_schema_extra={DESCRIPTION: description._asdict()})


def description_of(field: FieldInfo) -> KeyDescription:
    """What is said of a field; of one that was not made by `key`, no more than its description."""
    extra = field.json_schema_extra
    if isinstance(extra, dict) and DESCRIPTION in extra:
        return KeyDescription(**extra[DESCRIPTION])  # type: ignore[arg-type]
    return KeyDescription(meaning=field.description or "")
