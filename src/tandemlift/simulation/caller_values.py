"""Values that callers of a simulation give, checked: arrays of finite numbers, and seeds."""

from __future__ import annotations

import math
import operator
from typing import Any

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.toml import shown
from tandemlift.core.types import Array
from tandemlift.missions import Mission

MOST_SEED = 10**18  # as `mission.seed`


def numbers(name: str, value: Any, count: int, what: str) -> Array:
    """An array of `count` finite numbers.

    Raises:
        InputError: the value is something else.
    """
    try:
        found = np.asarray(value)
    except ValueError:  # rows of different lengths
        found = np.empty(0, dtype=object)
    if found.shape != (count,) or found.dtype.kind not in "fiu" or not all(map(math.isfinite, found.tolist())):
        given = value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
        raise InputError(f"{name} = {shown(given)}: must be {count} finite numbers ({what})")
    return found


def with_seed(mission: Mission, seed: Any) -> Mission:
    """A mission with another seed.

    Raises:
        InputError: the seed is not allowed.
    """
    try:
        number = operator.index(seed)
    except TypeError:
        number = -1
    if not 0 <= number <= MOST_SEED:
        raise InputError(f"seed = {shown(seed)}: must be a whole number from 0 to {MOST_SEED:g}")
    return mission.model_copy(update={"mission": mission.mission.model_copy(update={"seed": number})})
