"""Names in C: identifiers made from the names of laws, fields and missions, each used once."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator

KEYWORDS = """auto bool break case char const continue default do double else enum extern false float for goto if inline
int long register restrict return short signed sizeof static struct switch true typedef union unsigned void volatile
while and catch class delete explicit export friend mutable namespace new not operator or private protected public
template this throw try typename using virtual xor"""
LIBRARY = """abs acos asin atan atan2 cbrt ceil cos cosh div erf exp exp2 expm1 fabs fdim floor fma fmax fmin fmod frexp
gamma
hypot isfinite isinf isnan j0 j1 jn ldexp lgamma log log10 log1p log2 lrint lround memcpy memset modf nan nearbyint
pow remainder rint round scalbn signbit sin sinh sqrt tan tanh tgamma trunc y0 y1 yn size_t int32_t int64_t uint32_t
uint64_t to_integer bits_of number_of shifted_right"""
NO_MEMBER = frozenset(KEYWORDS.split())
RESERVED = NO_MEMBER | {"shared"} | set(LIBRARY.split())  # `shared`: of the parts of a function (function_text)


def identifier(name: str) -> str:
    """A name as an identifier of C: no leading underscores, no dots, dashes or other letters."""
    plain = re.sub(r"\W", "_", name, flags=re.ASCII).strip("_") or "value"
    return f"_{plain}"[plain[0].isalpha() :]


def _numbered(name: str) -> Iterator[str]:
    return (f"{name}_{i}" for i in itertools.count(2))


class Names:
    """Identifiers in one scope, each given once; `given`: those of an outer scope that it may not hide."""

    def __init__(self, given: Iterable[str] = ()) -> None:
        self._taken, self._count = set(given), 0

    def knows(self, name: str) -> bool:
        """Whether a name is taken."""
        return name in RESERVED or name in self._taken

    def new(self, wish: str) -> str:
        """The name that is wished for, with a number behind it if it is taken."""
        plain = identifier(wish)
        found = plain if not self.knows(plain) else next(n for n in _numbered(plain) if not self.knows(n))
        self._taken.add(found)
        return found

    def numbered(self, wish: str) -> str:
        """A name with a number behind it."""
        self._count += 1
        return self.new(f"{wish}{self._count}")
