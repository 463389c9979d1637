"""The bounds of the numbers in a page's messages, and what a page says of numbers beyond them."""

from __future__ import annotations

from typing import Any, get_args, get_origin

from tandemlift.apps.live.wire.page_messages import PAGE_MESSAGES, NumberedMessage
from tandemlift.apps.live.wire.quantities import NAME_PATTERN, NAME_RULE
from tandemlift.missions.bounds import allowed, bounds, plain

OWN = ("type", "seq")  # fields that the page writes by itself


def message_rules() -> dict[str, dict[str, dict[str, Any]]]:
    """By message and field: how many numbers (0 if they are not named one by one), their bounds, and the refusal."""
    found = {}
    for name, kind in PAGE_MESSAGES.items():
        rules = {field: _rule(name, field, kind) for field in kind.model_fields if field not in OWN}
        found[name] = {field: rule for field, rule in rules.items() if rule}
    return {name: rules for name, rules in found.items() if rules}


def name_rule() -> tuple[str, str]:
    """The regular expression of the name of a saved flight, and the refusal of another."""
    return NAME_PATTERN, f"save.name = {{value}}: must {NAME_RULE}"


def _rule(message: str, field: str, kind: type[NumberedMessage]) -> dict[str, Any] | None:
    info = kind.model_fields[field]
    annotation, marks = plain(info.annotation), list(info.metadata)
    parts = [part for part in get_args(annotation) if part is not Ellipsis]
    if get_origin(annotation) is tuple and parts:
        limits, count, rule = bounds(get_args(parts[0])[1:]), len(parts), allowed(parts[0])
    elif field == "value":
        limits, count, rule = _innermost_bounds(info.annotation), 0, allowed(info.annotation, marks)
    else:
        limits, count, rule = bounds(marks), 0, allowed(info.annotation, marks)
    if not {"ge", "le"} <= limits.keys():
        return None
    wrong = f"{message}.{{key}} = {{value}}: must be {rule}"
    return {"count": count, "min": limits["ge"], "max": limits["le"], "wrong": wrong}


def _innermost_bounds(annotation: Any) -> dict[str, float]:
    """The first bounds anywhere in an annotation."""
    for part in get_args(annotation):
        found = bounds([part]) if hasattr(part, "metadata") else _innermost_bounds(part)
        if found:
            return found
    return {}
