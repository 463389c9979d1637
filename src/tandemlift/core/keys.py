"""Keys of tables with meaning, unit and allowed values, as strict pydantic models."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, NamedTuple, get_args, get_origin

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError, core_schema

__all__ = [
    *("AtLeastOne", "AtLeastOne6", "Axes3", "Bandwidth", "Delay", "Exactly3", "Fraction", "KeyDescription", "Length"),
    *("NonNegative", "NonNegative3", "NonNegative6", "PerAxis", "Positive", "Positive3", "Positive6", "Scale"),
    *("Share", "Size", "Table", "Tilt", "Triple", "description_of", "key"),
]

LEAST_DIVISOR = 1e-300  # of a divisor: its inverse is finite


def must(kind: str, words: str) -> PydanticCustomError:
    """The error of a value that breaks a rule: 'must …'."""
    return PydanticCustomError(kind, "must {words}", {"words": words})


def divisor(value: float) -> float:
    """A number whose inverse is finite."""
    if value < LEAST_DIVISOR:
        raise must("size", f"be at least {LEAST_DIVISOR}")
    return value


Positive = Annotated[float, Field(gt=0.0), AfterValidator(divisor)]
NonNegative = Annotated[float, Field(ge=0.0)]
AtLeastOne = Annotated[float, Field(ge=1.0)]
Scale = Annotated[float, Field(ge=1e-6, le=1e6)]
Size = Annotated[float, Field(ge=0.0, le=1e6)]
Delay = Annotated[float, Field(ge=0.0, le=1.0)]  # s
Tilt = Annotated[float, Field(gt=0.0, le=1.4)]  # rad
Bandwidth = Annotated[float, Field(gt=0.0, le=1e4), AfterValidator(divisor)]  # rad/s
Fraction = Annotated[float, Field(gt=0.0, le=1.0)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]
Length = Annotated[float, Field(gt=0.0, le=1e3), AfterValidator(divisor)]  # m


class Table(BaseModel):
    """A strict, frozen table of a mission.

    A table may say when it acts: `acts` is the condition without which none of its keys does, and `keys_act` has those
    of some of its keys, by their names. A condition is text such as 'wind.model = "air"', "wind.turbulence > 0" or
    "person.path is given"; values and alternatives are joined by " or ", conditions by " and ". After "also ", it is
    one by which a key acts whatever its tables say.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False, validate_default=True)
    acts: ClassVar[str] = ""
    conditions: ClassVar[Mapping[str, str]] = {}

    def __init_subclass__(cls, *, acts: str = "", keys_act: Mapping[str, str] | None = None, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        own = {name: condition for names, condition in (keys_act or {}).items() for name in names.split()}
        cls.acts, cls.conditions = acts or cls.acts, {**cls.conditions, **own}

    @model_validator(mode="before")
    @classmethod
    def _lists_as_tuples(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        listed = {name: tuple(data[name]) for name in _tuples_of(cls) if isinstance(data.get(name), list)}
        return {**data, **listed} if listed else data


@functools.lru_cache(maxsize=256)
def _tuples_of(table: type[BaseModel]) -> tuple[str, ...]:
    """The keys of a table that hold tuples; cached, because every mission needs them for every table."""
    kinds = {name: (field.annotation, *get_args(field.annotation)) for name, field in table.model_fields.items()}
    return tuple(name for name, options in kinds.items() if any(get_origin(o) is tuple for o in options))


def is_number(value: Any) -> bool:
    """Whether a value is a whole or a real number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


class PerAxis:
    """Marks a key given per axis: one number for all `count` axes, or one number each.

    A vector in space has a direction, so its numbers may be negative: it is not `single`, and no number but 0 stands
    for all three.
    """

    def __init__(self, count: int, *, single: bool = True) -> None:
        self.count, self.single = count, single

    def describe(self, limits: str) -> str:
        """The allowed values in words; `limits` is the condition on each number."""
        short = "one number or " if self.single else "0 or " if self.count == 3 else ""
        return f"{short}a list of {self.count} numbers{limits and ', each ' + limits}"

    def is_short(self, value: Any) -> bool:
        """Whether a value is one number that stands for all axes."""
        return is_number(value) and (self.single or (value == 0 and self.count == 3))

    def spread(self, value: Any) -> Any:
        """The numbers of all axes."""
        if self.is_short(value):
            return (value,) * self.count
        if isinstance(value, (list, tuple)) and len(value) == self.count and all(map(is_number, value)):
            return tuple(value)
        raise must("axes", f"be {self.describe('')}")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_before_validator_function(self.spread, handler(source))


Triple = tuple[float, float, float]
Axes3 = Annotated[Triple, PerAxis(3)]
Positive3 = Annotated[tuple[Positive, Positive, Positive], PerAxis(3)]
NonNegative3 = Annotated[tuple[NonNegative, NonNegative, NonNegative], PerAxis(3)]
Exactly3 = Annotated[Triple, PerAxis(3, single=False)]
Positive6 = Annotated[tuple[Positive, Positive, Positive, Positive, Positive, Positive], PerAxis(6)]
NonNegative6 = Annotated[
    tuple[NonNegative, NonNegative, NonNegative, NonNegative, NonNegative, NonNegative], PerAxis(6)
]
AtLeastOne6 = Annotated[tuple[AtLeastOne, AtLeastOne, AtLeastOne, AtLeastOne, AtLeastOne, AtLeastOne], PerAxis(6)]


BELIEVED = "chosen: near the iris's rotors, 0.0125 s up and 0.025 s down"
TRIAL = "chosen; the baseline controllers are tuned with it (benchmarks/trial.toml)"
DESCRIPTION = "key"  # names the description in the metadata that pydantic keeps of a field


class KeyDescription(NamedTuple):
    """The documentation of a key beside its type and default, in plain English without a full stop.

    Attributes:
        unit: in SI, "1" for a number without a unit; None if the key is not a number.
        meaning: the meaning of the key.
        source: the source of the default, or the reason for it.
        rule: the condition on its value beyond its type.
        unset: the effect of leaving the key out, for a key without a default value.
        example: a value for the template, if there is no default or it shows little.
        choices: the meaning of each of its choices.
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
    """A field of a table with its `KeyDescription`; `...` as the default makes the key required."""
    description = KeyDescription(unit, meaning, source, rule, unset, example, choices or {})
    return Field(default, description=meaning, json_schema_extra={DESCRIPTION: description._asdict()})


def description_of(field: FieldInfo) -> KeyDescription:
    """The documentation of a field; only its description if the field was not made by `key`."""
    extra = field.json_schema_extra
    if isinstance(extra, dict) and DESCRIPTION in extra:
        return KeyDescription(**extra[DESCRIPTION])  # type: ignore[arg-type]
    return KeyDescription(meaning=field.description or "")
