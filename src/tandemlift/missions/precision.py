"""The precision of a mission's flight: `mission.precision`, in place of it, and where it must be double."""

from __future__ import annotations

from typing import Any

from tandemlift.core.errors import InputError, shown

PRECISIONS = "double", "single"


def check_double(mission: Any, reason: str) -> None:
    """Refuse single precision for a reason.

    Raises:
        InputError: the mission asks for it.
    """
    if mission.mission.precision == "single":
        raise InputError(f"mission.precision = 'single': must be 'double' here, because {reason}")


def with_precision(mission: Any, precision: str | None) -> Any:
    """A mission in the precision that a caller asks for; in its own if None.

    Raises:
        InputError: there is no such precision.
    """
    if precision is None or precision == mission.mission.precision:
        return mission
    if precision not in PRECISIONS:
        raise InputError(f"precision = {shown(precision)}: must be {' or '.join(map(repr, PRECISIONS))}")
    return mission.model_copy(update={"mission": mission.mission.model_copy(update={"precision": precision})})
