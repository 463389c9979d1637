"""Problems of a mission's tables, a sentence for each key: the given value, the allowed ones, or its present name."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, get_args, get_origin

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from tandemlift.core.errors import dotted, nearest, shown
from tandemlift.core.files import QUANTITY
from tandemlift.core.keys import description_of, is_number
from tandemlift.core.plugs import Chosen
from tandemlift.missions.changes import MISSING, Place, value_at
from tandemlift.missions.key_descriptions import Model, allowed, plain, table_in

MOST_PROBLEMS = 64  # problems with a sentence, more than are told: those of a file of garbage would take seconds
BY_ANNOTATION = (  # prefixes of the kinds of error for which the annotation has the allowed values
    *("missing", "axes", "float_", "int_", "bool_", "string_type", "finite_", "greater_", "less_"),
    *("literal_", "model_", "tuple_", "list_", "dict_", "too_"),
)


class Problem(NamedTuple):
    """A problem of the key at a place in the nested tables."""

    place: Place
    sentence: str


def problems_in(
    model: Model, error: ValidationError, tables: object, prefix: Place = (), whole: str = "a mission"
) -> list[Problem]:
    """The problems of the table at `prefix` in `tables`, one for each key; `whole` names the kind of file."""
    data = value_at(tables, prefix)
    found: dict[Place, Problem] = {}
    for problem in error.errors(include_url=False, include_input=False):
        if len(found) >= MOST_PROBLEMS:
            place, text = tuple(problem["loc"]), "…"
        elif problem["type"] == "extra_forbidden":
            place, text = _unknown_key(model, problem, data, prefix, whole)
        else:
            place, text = _refusal(model, problem, data, prefix)
        found.setdefault(place, Problem((*prefix, *place), text))
    return list(found.values())


def keys_of(model: Model, above: Place = ()) -> Iterator[Place]:
    """The places of all keys of a table and of the tables in it; 0 stands for any entry of a list of tables."""
    for name, field in model.model_fields.items():
        inner, many = table_in(field.annotation), get_origin(field.annotation) is tuple
        yield (*above, name)
        if inner is not None:
            yield from keys_of(inner, (*above, name, *([0] if many else [])))


def _walk(model: Model, loc: Iterable[Any]) -> tuple[Place, Any, Any]:
    """The place of a pydantic error, without labels of union members, and the last field and table on the path."""
    place: list[str | int] = []
    field, table = None, model
    for part in loc:
        if isinstance(part, str):
            if table is None or part not in table.model_fields:
                break
            field = table.model_fields[part]
            table = table_in(field.annotation)  # type: ignore[assignment]
        place.append(part)
    return tuple(place), field, table


def _refusal(model: Model, problem: ErrorDetails, data: object, prefix: Place) -> tuple[Place, str]:
    place, field, table = _walk(model, problem["loc"])
    if not (place or prefix):  # a rule between tables, whose text names the key itself
        return place, problem["msg"]
    if table is None and value_at(data, place) is MISSING:  # inside one value for all axes
        while isinstance(place[-1], int):
            place = place[:-1]
    key, given = dotted((*prefix, *place)), value_at(data, place)
    rule = _rule(problem, field, bool(place) and isinstance(place[-1], int))
    if problem["type"] == "missing":
        return place, f"{key} is missing: it {rule}"
    whole = problem["type"] == "count" or (not problem["type"].startswith(BY_ANNOTATION) and isinstance(given, Mapping))
    value = "" if whole or given is MISSING else f" = {shown(given)}"
    return place, f"{key}{value}: {rule}{_hint(problem, field, given)}"


def _rule(problem: ErrorDetails, field: FieldInfo | None, entry: bool) -> str:
    """'must be …', from the annotation if that suffices, else from the validator."""
    if field is None or not problem["type"].startswith(BY_ANNOTATION):
        said = problem["msg"].removeprefix("Value error, ").removeprefix("Assertion failed, ")
        return said.replace("Input should", "must")
    if entry:
        parts = get_args(plain(field.annotation))
        return f"must be {allowed(parts[0])}" if parts else "must be different"
    return f"must be {allowed(field.annotation, field.metadata)}"


def _hint(problem: ErrorDetails, field: Any, given: object) -> str:
    kind = problem["type"]
    if kind == "axes" and is_number(given):
        return f", such as [{', '.join([shown(given), *['0'] * (len(get_args(plain(field.annotation))) - 1)])}]"
    if isinstance(given, str) and kind == "literal_error":
        options = get_args(plain(field.annotation))
        options = get_args(options[0]) or options  # of an entry of a list
        near = nearest(given, map(str, options))
        own = [
            mark
            for mark in (
                *field.metadata,
                *(mark for part in get_args(field.annotation) for mark in getattr(part, "__metadata__", ())),
            )
            if isinstance(mark, Chosen)
        ]
        load = " One of your own must be loaded first, as with --plugin FILE." if own else ""
        return (f". Did you mean {shown(near)}?" if near else "." * bool(own)) + load
    if isinstance(given, str) and kind.startswith(("float_", "int_", "axes")):
        if quantity := re.fullmatch(QUANTITY, given):
            unit = (field and description_of(field).unit) or "1"
            bare = [re.sub("[ ·*]", "", one) for one in (unit, quantity[2])]
            number = f", {quantity[1]}" if bare[0] == bare[1] else ""
            return f"{'' if unit == '1' else f', in {unit}'}: write the number alone{number}"
        return ", without quotes" if re.match(r"[-+.\d[]", given) else ""
    if kind == "finite_number" or (kind == "float_type" and isinstance(given, int) and not isinstance(given, bool)):
        return ", and finite"
    if isinstance(given, Mapping) and kind == "tuple_type" and table_in(field.annotation):
        return ", each with its name in double brackets"
    return ""


def _unknown_key(model: Model, problem: ErrorDetails, data: object, prefix: Place, whole: str) -> tuple[Place, str]:
    *above, name = problem["loc"]
    _, _, table = _walk(model, above)
    names, where = list(table.model_fields), (*prefix, *above)
    near = nearest(str(name), names)
    elsewhere = next((place for place in keys_of(model) if place[-1] == name), None)
    meant = (*where, near) if near else elsewhere and (*prefix, *elsewhere)
    hint = f". Did you mean {dotted(meant)}?" if meant else ""
    former = ".".join(part for part in map(str, (*where, name)) if not part.isdigit())
    hint = f". It is {now} now" if (now := present_name(former)) != former else hint
    this = f"{dotted(where)} has" if where else f"{whole} has the tables"
    given = f"{dotted((*where, name))} = {shown(value_at(data, problem['loc']))}"
    return (*above, name), f"{given}: unknown key; {this} {', '.join(names)}{hint}"


RENAMED = {  # by table: OLD=NEW
    "": "partner=person",
    "mission": "fused=fma",
    "admittance": "reanchor=hold_after_release",
    "compliance": "hearing=input_bandwidth easing=output_bandwidth release=release_fraction forget=bias_time_constant "
    "braking=braking_gain thrust_share=thrust_fraction lead=reference_lead press=touchdown_depth spool=spin_up_time "
    "max_descent=max_descent_speed",
    "compliance.yaw": "leash=max_lead_angle",
    "compliance.tank": "size=capacity low=low_energy refill=refill_fraction fade=fade_time",
    "detection": "forget=bias_bandwidth habit=scatter_bandwidth spread=thrust_uncertainty evidence=threshold "
    "margin=isolation_margin unexplained=unexplained_fraction retest=retest_time",
    "estimator": "least_force=min_force",
    "supervision": "patience=hold_timeout calm=recovery_time deeper=blind_descent_depth touch=touchdown_gap "
    "sinking=blind_descent_acceleration watch=watchdog",
    "supervision.checks": "thrust_share=thrust_fraction payload_least=min_payload_ratio payload_most=max_payload_ratio",
    "supervision.watchdog": "stale=stale_time invalid=invalid_time frozen=frozen_samples force=max_force "
    "torque=max_torque specific_force=max_specific_force rates=max_rates position=max_position velocity=max_velocity "
    "turn_bandwidth=rates_bandwidth way_bandwidth=velocity_bandwidth",
    "supervision.fence": "slowing=braking_gain",
    "supervision.limits": "thrust_share=thrust_fraction error=tracking_error error_time=tracking_error_time",
    "supervision.reactions": "unit=imu joints_apart=joints_inconsistent attitude_apart=attitude_inconsistent "
    "velocity_apart=velocity_inconsistent speed_apart=speed_inconsistent error=tracking_error",
    "person": "approach=approach_gain breakaway=breakaway_force trimming=trim_rate corner=corner_distance "
    "arrive=arrival_radius slow=landing_speed turn_gain=yaw_gain turn_damping=yaw_damping start=start_time "
    "height_share=height_fraction",
}


def present_name(key: str) -> str:
    """The present name of a dotted key without numbers; the same if it or a table of it was never renamed."""
    names = list[str]()
    for part in key.split("."):
        own = dict(one.split("=") for one in RENAMED.get(".".join(names), "").split())
        names.append(own.get(part, part))
    return ".".join(names)
