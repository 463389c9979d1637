"""Random draws: the distribution of each key of `[draw]`, and random persons."""

from __future__ import annotations

from typing import Any

from tandemlift.analysis.studies.design.distributions import DISTRIBUTIONS, Distribution, Horizontal, Uniform
from tandemlift.analysis.studies.design.keys import by_key, key_at, leaves_of, validated
from tandemlift.core.errors import InputError, shown, suggestion
from tandemlift.core.types import Array
from tandemlift.missions import MISSING, Place, Tables, place_of, value_at

SCALED = (
    *("stiffness", "damping", "lag", "gain", "speed"),
    *("look_ahead", "approach_gain", "trim_rate", "yaw_gain", "yaw_damping"),
)
GRIP = "person.grip"
Drawn = dict[str, Distribution]


def random_person() -> Drawn:
    """The distributions of a random person.

    Gains, arm, speed and lag are those of the mission times independent factors of 0.7 to 1.3. The visual delay is
    0.1 s to 0.3 s (in steps of 20 ms, so that blocks fill), the tremor up to 0.1 N, the grip anywhere on the beam. A
    wind of up to 1 N, unknown to the pilot, comes from a random direction. The mission lasts longer, because some
    persons are slow.
    """
    return {
        **{f"person.{key}": Uniform(distribution="uniform", low=0.7, high=1.3, relative=True) for key in SCALED},
        "person.delay": Uniform(distribution="uniform", low=0.1, high=0.3, step=0.02),
        "person.tremor": Uniform(distribution="uniform", low=0.0, high=0.1),
        GRIP: Uniform(distribution="uniform", low=-1.0, high=1.0),
        "disturbance.force": Horizontal(distribution="horizontal", low=0.0, high=1.0),
    }


def drawn_keys(tables: Tables) -> Drawn:
    """The distribution of each key of `[draw]`, in the order of the file.

    Raises:
        InputError: an entry is no distribution, or one that holds nothing.
    """
    leaves = leaves_of(tables.get("draw", {}), lambda table: "distribution" in table)
    return by_key(((place, _distribution(given, tables, ("draw", *place))) for place, given in leaves), "draw")


def _distribution(given: object, tables: Tables, place: Place) -> Distribution:
    where, known = key_at(place), ", ".join(DISTRIBUTIONS)
    name = given.get("distribution") if isinstance(given, dict) else None
    if name is None:
        example = '{distribution = "uniform", low = 0.9, high = 1.1}'
        raise InputError(f"{where} = {shown(given)}: must be a table such as {example}; distributions are {known}")
    if name not in DISTRIBUTIONS:
        hint = suggestion(name, DISTRIBUTIONS) if isinstance(name, str) else ""
        raise InputError(f"{where}.distribution = {shown(name)}: must be one of {known}.{hint}")
    return validated(DISTRIBUTIONS[name], given, tables, place)


def dimensions_of(drawn: Drawn) -> int:
    """Numbers of a point of all draws."""
    return sum(distribution.dimensions for distribution in drawn.values())


def values_at(drawn: Drawn, points: Array) -> list[dict[str, Any]]:
    """The drawn values by key at points (n, dimensions), one table for each point."""
    columns, at = dict[str, list[Any]](), 0
    for name, distribution in drawn.items():
        columns[name] = distribution.values(points[:, at : at + distribution.dimensions])
        at += distribution.dimensions
    return [{name: column[i] for name, column in columns.items()} for i in range(len(points))]


def absolute(distribution: Distribution, key: str, value: Any, tables: Tables, mission: str) -> Any:
    """The value of a draw of a key, which may be relative to that in a mission's tables.

    Raises:
        InputError: it is relative, and the mission has no number there.
    """
    return _times(value_at(tables, place_of(key)), value, key, mission) if distribution.relative else value


def _times(own: Any, factor: Any, key: str, mission: str) -> Any:
    """A mission's own value times a factor, or times one factor for each entry of a list."""
    if isinstance(own, (list, tuple)):
        factors = factor if isinstance(factor, list) else [factor] * len(own)
        if len(factors) == len(own):
            return [_times(x, f, key, mission) for x, f in zip(own, factors, strict=True)]
    elif isinstance(own, (int, float)) and not isinstance(own, bool) and not isinstance(factor, list):
        return own * factor
    what = "is not set" if own is MISSING else f"= {own!r}"
    raise InputError(
        f"draw.{key}: relative = true, but in mission {mission} the key {what}; it must be as many numbers"
    )
