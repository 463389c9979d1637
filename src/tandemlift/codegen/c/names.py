"""Identifiers of C: what no identifier, no member and no function may be called, and names in a scope."""

from __future__ import annotations

import itertools
import re
from collections.abc import Container, Iterable, Iterator
from functools import cache

KEYWORDS = """auto bool break case char const continue default do double else enum extern false float for goto if inline
int long register restrict return short signed sizeof static struct switch true typedef union unsigned void volatile
while alignas alignof and and_eq asm bitand bitor catch char16_t char32_t char8_t class co_await co_return co_yield
compl concept const_cast consteval constexpr constinit decltype delete dynamic_cast explicit export friend mutable
namespace new noexcept not not_eq nullptr operator or or_eq private protected public reinterpret_cast requires
static_assert static_cast template this thread_local throw try typeid typename typeof using virtual wchar_t xor xor_eq
"""
MACROS = """EOF HUGE_VAL HUGE_VALF HUGE_VALL INFINITY NAN NULL assert errno linux math_errhandling stderr stdin stdout
unix FP_INFINITE FP_NAN FP_NORMAL FP_SUBNORMAL FP_ZERO MATH_ERREXCEPT MATH_ERRNO M_1_PI M_2_PI M_2_SQRTPI M_E M_LN10
M_LN2 M_LOG10E M_LOG2E M_PI M_PI_2 M_PI_4 M_SQRT1_2 M_SQRT2"""
MATH = """acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs fdim floor fma
fmax fmin fmod frexp hypot ilogb ldexp lgamma llrint llround log log10 log1p log2 logb lrint lround modf nan nearbyint
nextafter nexttoward pow remainder remquo rint round scalbln scalbn sin sinh sqrt tan tanh tgamma trunc"""
LIBRARY = """abs div gamma isfinite isinf isnan j0 j1 jn memcpy memset signbit y0 y1 yn size_t int32_t int64_t
uint32_t uint64_t to_integer bits_of number_of shifted_right"""
# nothing here calls these: a variable may have their names, but no function
UNCALLED = """abort cabs carg calloc cimag conj cpow creal exit fprintf free isgreater isless isnormal labs ldiv llabs
main malloc memchr memcmp memmove printf putchar puts realloc scanf sprintf strcat strchr strcmp strcoll strcpy
strcspn strerror strlen strncat strncmp strncpy strpbrk strrchr strspn strstr strtok strxfrm"""
NO_MEMBER = frozenset([*KEYWORDS.split(), *MACROS.split()])
RESERVED = NO_MEMBER | {"shared"} | set(LIBRARY.split())  # `shared`: of the parts of a function (`text`)
RESERVED |= {name + kind for name in MATH.split() for kind in ("", "f", "l")}


@cache
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

    def new(self, wish: str, kept: Container[str] = ()) -> str:
        """The name that is wished for, with a number behind it if it is taken or `kept` for another."""
        plain = identifier(wish)
        found = next(n for n in itertools.chain([plain], _numbered(plain)) if not self.knows(n) and n not in kept)
        self._taken.add(found)
        return found

    def numbered(self, wish: str) -> str:
        """A name with a number behind it."""
        self._count += 1
        return self.new(f"{wish}{self._count}")


def member_name(field: str) -> str:
    """The name of a member."""
    plain = identifier(field)
    return plain + "_" * (plain in NO_MEMBER)
