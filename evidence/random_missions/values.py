"""Random values for keys of a mission: near the key's value, within its bounds, of a relevant size."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np

from tandemlift.missions.key_descriptions import Key, bounds

SHORTEST, LONGEST = 8.0, 20.0  # s
STEPS = (0.0005, 0.001, 0.002, 0.004, 0.005, 0.01)  # s
STRENGTHS = (0.1, 0.5, 1.2)  # standard deviation of the logarithm of a factor
SIZES = {  # of a change of a number that is 0 or of either sign, by unit
    **{"N": 3.0, "N m": 0.5, "m": 0.3, "m/s": 2.0, "rad": 0.6, "rad/s": 1.0, "s": 0.5, "kg": 0.2, "1": 0.3},
    **{"m²": 0.02, "N s/m": 0.5, "N m s": 0.2, "N/m": 1.0},
}
SMALL_SIZES = {  # the same, for values that are small in good hardware: noise, biases, delays
    **{"N": 0.1, "N m": 0.01, "m": 0.003, "m/s": 0.02, "rad": 0.005, "rad/s": 0.01, "m/s²": 0.05, "s": 0.02},
    **{"N/√s": 0.01, "N m/√s": 0.001, "m/s²/√s": 0.002, "rad/s/√s": 0.0002},
}


def varied(key: Key, value: Any, rng: np.random.Generator) -> Any:
    """Another value of a key of numbers, near the one that it has, or near its example."""
    if key.name == "mission.duration":
        return round(float(rng.uniform(SHORTEST, LONGEST)), 1)
    if key.name == "mission.step":
        return float(rng.choice(STEPS))
    if value is None:
        value = key.example
    strength, together = float(rng.choice(STRENGTHS)), rng.random() < 0.5
    spread = rng.normal(0.0, strength)

    def another(x: Any) -> Any:
        if isinstance(x, (list, tuple)):
            return [another(y) for y in x]
        if isinstance(x, bool) or not isinstance(x, (int, float)):
            return x
        return _another_number(key, x, spread if together else rng.normal(0.0, strength))

    return another(value)


def _another_number(key: Key, x: float, spread: float) -> float:
    limits = bounds(_marks(key.field.annotation, key.field.metadata))
    unit, signed = key.facts.unit or "1", limits.get("gt", limits.get("ge", -1.0)) < 0.0
    small = key.name.startswith(("sensors", "actuators", "mission"))
    size = (SMALL_SIZES if small else SIZES).get(unit, 0.3)
    if isinstance(x, int):
        new = round(max(x, 1) * np.exp(spread * 2.0))
        return int(min(max(new, limits.get("ge", 0)), limits.get("le", 1000)))
    new = x + spread * max(size, 0.5 * abs(x)) if signed else (x * np.exp(spread) if x else size * abs(spread))
    least, most = limits.get("ge", limits.get("gt", -np.inf)), limits.get("le", limits.get("lt", np.inf))
    return float(f"{min(max(new, least), most):.4g}")


def _marks(annotation: Any, metadata: Any) -> list[Any]:
    """The marks of the numbers inside an annotation."""
    found = list(metadata)
    if hasattr(annotation, "__metadata__"):
        found += annotation.__metadata__
    for part in get_args(annotation):
        if part is not Ellipsis and not isinstance(part, (str, int, bool)):
            found += _marks(part, [])
    return found
