"""Numbers of every magnitude and kind, and their bits."""

import math
import random
import struct

import numpy as np

ODD = [0.0, -0.0, 1.0, -1.0, 0.5, math.inf, -math.inf, math.nan, 5e-324, -2.2250738585072014e-308, 1.797e308]


def any_number(chance: random.Random) -> float:
    kind = chance.random()
    if kind < 0.1:
        return chance.choice(ODD)
    if kind < 0.2:
        return struct.unpack("<d", chance.randbytes(8))[0]
    return chance.choice([-1.0, 1.0]) * chance.uniform(1.0, 2.0) * 2.0 ** chance.choice([-40, -2, -1, 0, 0, 1, 2, 30])


def bits(values: np.ndarray) -> np.ndarray:
    """Bits of numbers as integers; all NaNs are the same."""
    return np.where(np.isnan(values), np.nan, values).view(np.int64)
