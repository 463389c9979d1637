"""Standard normal numbers by random access: four for every (step, draw) of a key, in any order, alone or in blocks.

Philox4x32-10 turns a counter of four 32-bit words and a key of two into four words: J. K. Salmon, M. A. Moraes,
R. O. Dror and D. E. Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011. Two words make two independent normal
numbers: G. E. P. Box and M. E. Muller, Ann. Math. Statist. 29, 1958.

Words are integers below 2³². Products of two wrap in compiled 64-bit integers and grow in Python's; masked to 32 bits,
both are the same. The laws here take single numbers, not arrays: a loop over flights calls them for each.
"""

from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import cos, log, sin, sqrt
from tandemlift.core.law import law
from tandemlift.core.types import Number

MASK = 0xFFFFFFFF
MULTIPLIER = (0xD2511F53, 0xCD9E8D57)
WEYL = (0x9E3779B9, 0xBB67AE85)  # increment of the key from round to round: golden ratio, √3 − 1
WORD = 2.0**-32
TURN = 6.283185307179586  # 2π


class Words(NamedTuple):
    """Four 32-bit words: a counter, or the output of Philox."""

    first: int
    second: int
    third: int
    fourth: int


class Scramble(NamedTuple):
    """Words between two rounds of Philox, and the two words of the key for the next."""

    words: Words
    key0: int
    key1: int


class Normals(NamedTuple):
    """Four independent standard normal numbers."""

    first: Number
    second: Number
    third: Number
    fourth: Number


def key_from_seed(seed: int) -> tuple[float, float]:
    """The key of a seed: two words, as floats (exact), so that they can be stored among a flight's numbers.

    Args:
        seed: any integer from 0. Two seeds share a key with a chance of 2⁻⁶⁴.
    """
    first, second = np.random.SeedSequence(seed).generate_state(2)
    return float(first), float(second)


@law
def philox_round(s: Scramble) -> Scramble:
    """One round of Philox4x32."""
    x = s.words
    p, q = MULTIPLIER[0] * x.first, MULTIPLIER[1] * x.third
    above, below = (q >> 32) & MASK, (p >> 32) & MASK
    words = Words(above ^ x.second ^ s.key0, q & MASK, below ^ x.fourth ^ s.key1, p & MASK)
    return Scramble(words, (s.key0 + WEYL[0]) & MASK, (s.key1 + WEYL[1]) & MASK)


@law
def five_rounds(s: Scramble) -> Scramble:
    """Half of Philox4x32-10."""
    return philox_round(philox_round(philox_round(philox_round(philox_round(s)))))


@law
def philox(counter: Words, key0: int, key1: int) -> Words:
    """Philox4x32-10: four words from a counter under a key, all integers."""
    return five_rounds(five_rounds(Scramble(counter, key0, key1))).words


@law
def normal_radius(word: Number) -> Number:
    """√(−2 ln u), u the middle of one of 2³² equal parts of (0, 1), so never 0: at most 6.77."""
    return sqrt(-2.0 * log((word + 0.5) * WORD))


@law
def normal_angle(word: Number) -> Number:
    """2π u [rad], u as above."""
    return (word + 0.5) * (TURN * WORD)


@law
def normals(step: Number, draw: Number, key0: Number, key1: Number) -> Normals:
    """Four standard normal numbers, the same for the same arguments on every machine.

    Args:
        step: number of the step, a whole number from 0, below 2³².
        draw: which four of that step, a whole number from 0, below 2³².
        key0: first word of the key, as a float or an integer (see `key_from_seed`).
        key1: second word.
    """
    x = philox(Words(int(step), int(draw), 0, 0), int(key0), int(key1))
    r, a, s, b = normal_radius(x.first), normal_angle(x.second), normal_radius(x.third), normal_angle(x.fourth)
    return Normals(r * cos(a), r * sin(a), s * cos(b), s * sin(b))
