"""A wish in words, "1 N gives 0.6 m/s in 0.5 s along x", and the keys that fulfil it.

M v' + C v = F beyond the threshold: C = F/v and M = C t/ln 20 for a speed v that is 95 % there after t.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from tandemlift.common.errors import InputError
from tandemlift.missions import Mission, check, format_toml, merge, tables_of
from tandemlift.missions.values import Tables
from tandemlift.settings.admittance import LN_20
from tandemlift.studies.feel.closed_form import AXES, YAW, axes_of
from tandemlift.studies.feel.quiet import quietly

FORM = (
    '"1 N gives 0.6 m/s in 1.5 s along x and y; 2 N gives 0.4 m/s in 2 s" or, for yaw, "0.5 N m gives 0.2 rad/s in 6 s"'
)
NUMBER = r"([0-9]+(?:\.[0-9]+)?(?:e-?[0-9]+)?)"
CLAUSE = re.compile(
    rf"{NUMBER} ?(N m|N) (?:gives|leads to) {NUMBER} ?(m/s|rad/s) (?:in|within) {NUMBER} ?s"
    r"(?: along ([xyz](?:(?:, ?| and |, and )[xyz])*))?"
)
LARGEST = 1e6  # of any number


class Wished(NamedTuple):
    """A clause: a push of `force` [N] gives `speed` [m/s], 95 % of it within `time` [s], along `axes`.

    In yaw the force is a moment [N m], and the speed a rate [rad/s].
    """

    force: float
    speed: float
    time: float
    axes: tuple[str, ...]


def wishes(text: str) -> list[Wished]:
    """The clauses of a wish. One without axes holds for all that no other clause names.

    Raises:
        InputError: the text has another form, a number is zero or too large, or an axis is named twice.
    """
    clauses = [" ".join(part.split()) for part in text.strip().rstrip(".;").split(";")]
    found = [_clause(text, clause) for clause in clauses]
    named = [axis for wished in found for axis in wished.axes]
    general = [wished for wished in found if not wished.axes]
    twice = sorted({axis for axis in named if named.count(axis) > 1})
    if twice or len(general) > 1:
        what = f"names {twice[0]} twice" if twice else "has two clauses without axes"
        raise InputError(f"--wish {text!r}: {what}; say each axis once, such as {FORM}")
    left = tuple(axis for axis in AXES if axis not in named)
    if general and not left:
        raise InputError(f"--wish {text!r}: no axis is left for the clause without axes; the form is {FORM}")
    return [wished if wished.axes else wished._replace(axes=left) for wished in found]


def _clause(text: str, clause: str) -> Wished:
    match = CLAUSE.fullmatch(clause)
    if match is None:
        raise InputError(f"--wish {text!r}: {clause!r} must have the form {FORM}")
    force, unit, speed, speed_unit, time, axes = match.groups()
    numbers = [float(number) for number in (force, speed, time)]
    if not all(1.0 / LARGEST <= number <= LARGEST for number in numbers):
        raise InputError(f"--wish {text!r}: each number in {clause!r} must be from {1.0 / LARGEST:g} to {LARGEST:g}")
    if (unit == "N m") != (speed_unit == "rad/s") or (axes and unit == "N m"):
        raise InputError(f"--wish {text!r}: {clause!r} mixes forces and moments; the form is {FORM}")
    along = (YAW,) if unit == "N m" else tuple(re.findall("[xyz]", axes or ""))
    return Wished(numbers[0], numbers[1], numbers[2], along)


def proposed(mission: Mission, text: str) -> Tables:
    """The tables of a mission file that fulfil a wish: `[admittance.feel]`, and `[compliance.yaw]` for yaw.

    Axes without a wish keep what they feel like now.

    Raises:
        InputError: the text is no wish, or one that this mission cannot have.
    """
    found, clauses = Tables(), wishes(text)
    forward = [wished for wished in clauses if wished.axes != (YAW,)]
    if forward:
        a = mission.admittance
        if any(a.stiffness):
            raise InputError(
                f"--wish {text!r}: with admittance.stiffness = {list(a.stiffness)} the vehicle springs back, and no "
                "push leads to a lasting speed; add --set admittance.stiffness=0"
            )
        found["admittance"] = {"feel": _feel(mission, text, forward)}
    for wished in clauses:
        if wished.axes == (YAW,):
            found["compliance"] = {"yaw": _yaw(mission, text, wished)}
    return found


def _feel(mission: Mission, text: str, clauses: Iterable[Wished]) -> dict[str, Any]:
    by_axis = {axis: wished for wished in clauses for axis in wished.axes}
    rows = []
    for i, axis in enumerate(AXES):
        wished = by_axis.get(axis) or _present(mission, i)
        if wished.force <= mission.admittance.threshold[i]:
            raise InputError(
                f"--wish {text!r}: {wished.force:g} N along {axis} must be above admittance.threshold = "
                f"{mission.admittance.threshold[i]:g} N, up to which a push is ignored"
            )
        rows.append(wished)
    return {name: _one_or_all([getattr(row, name) for row in rows]) for name in ("force", "speed", "time")}


def _present(mission: Mission, i: int) -> Wished:
    """What an axis feels like now, as a wish."""
    k = axes_of(mission)[i]
    if k.damping == 0.0:
        raise InputError(
            f"admittance.damping = 0 along {k.axis}: it has no speed to keep; name {k.axis} in --wish, too"
        )
    return Wished(k.push, k.final_speed, k.time, (k.axis,))


def _one_or_all(values: list[float]) -> Any:
    rounded = [float(f"{value:.6g}") for value in values]
    return rounded[0] if len(set(rounded)) == 1 else rounded


def _yaw(mission: Mission, text: str, wished: Wished) -> dict[str, Any]:
    yaw = mission.compliance.yaw
    if mission.pilot.guidance != "hand" or yaw.model != "yielding":
        raise InputError(
            f"--wish {text!r}: mission {mission.mission.name} keeps its heading; a wish for yaw needs "
            "--set pilot.guidance=hand --set compliance.yaw.model=yielding"
        )
    if wished.force <= yaw.threshold:
        raise InputError(
            f"--wish {text!r}: {wished.force:g} N m must be above compliance.yaw.threshold = {yaw.threshold:g} N m"
        )
    if wished.force - yaw.threshold > yaw.max_moment:
        raise InputError(
            f"--wish {text!r}: no steady rate exists above {yaw.threshold + yaw.max_moment:g} N m, which "
            "compliance.yaw.max_moment and the threshold make together; wish for less"
        )
    damping = (wished.force - yaw.threshold) / wished.speed
    return {"damping": float(f"{damping:.6g}"), "inertia": float(f"{damping * wished.time / LN_20:.6g}")}


def with_proposal(mission: Mission, tables: Tables) -> Mission:
    """A mission with proposed tables in it.

    Raises:
        InputError: the mission cannot have them.
    """
    before = tables_of(mission)
    if "feel" in tables.get("admittance", {}):
        before["admittance"].pop("feel", None)
    with quietly():
        return check(merge(before, tables), mission.mission.name)


def toml_of(mission: Mission, tables: Mapping[str, Any]) -> str:
    """Proposed tables as TOML to paste into a mission file, with the mass and damping that a feel comes to."""
    after = with_proposal(mission, dict(tables)).admittance
    blocks = {name: format_toml({name: table}).rstrip() for name, table in tables.items()}
    if "admittance" in blocks:
        mass, damping = (_one_or_all(list(value)) for value in (after.mass, after.damping))
        blocks["admittance"] += f"\n# that is, mass = {mass} kg and damping = {damping} N s/m"
    return "\n\n".join(blocks.values())
