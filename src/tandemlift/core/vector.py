"""Value types: vectors, quaternions, matrices and sets of values, as tuples of numbers with operators.

The numbers may be floats, NumPy arrays, JAX tracers or CasADi symbols; compiled, they are float64.
Keep the vector on the left of a product with a scalar (`v * k`): some array libraries on the left swallow a tuple.
"""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Generic, NamedTuple, TypeGuard, TypeVar

from tandemlift.core.law import Absent as Absent
from tandemlift.core.law import law
from tandemlift.core.types import Number, NumberSet, layout_and_numbers, new, number

C = TypeVar("C", bound=type)
T = TypeVar("T")
V = TypeVar("V", bound=tuple[Any, ...])


def _no_order(a: object, b: object) -> bool:
    raise TypeError(f"{type(a).__name__} values have no order; compare their components")


def linear(cls: C) -> C:
    """Mark a NamedTuple whose values add, subtract and scale field by field; its fields may be linear themselves.

    Operators in its body have no effect: they are there for a type checker.
    """
    cls.linear = True  # type: ignore[attr-defined]
    cls.componentwise = getattr(cls, "componentwise", False)  # type: ignore[attr-defined]
    cls.__array_ufunc__ = None  # type: ignore[attr-defined]  # a NumPy scalar on the left defers to our operators
    for name in ("__lt__", "__le__", "__gt__", "__ge__"):
        setattr(cls, name, _no_order)
    for name, operation in OPERATORS.items():
        setattr(cls, name, operation)
    return cls


def componentwise(cls: C) -> C:
    """Mark a linear NamedTuple of scalars whose product with its own kind is component by component."""
    cls.componentwise = True  # type: ignore[attr-defined]
    return linear(cls)


def _by_fields(operation: Callable[[Any, Any], Any], a: Any, b: Any) -> Any:
    if type(a) is type(b):
        return new(type(a), map(operation, a, b))
    if is_rolled(b):  # a set that is one symbol handles a set of numbers
        return NotImplemented
    raise TypeError(f"cannot combine {type(a).__name__} with {type(b).__name__}")


def plus(a: V, b: V) -> V:
    """a + b, field by field."""
    return _by_fields(operator.add, a, b)


def minus(a: V, b: V) -> V:
    """a − b, field by field."""
    return _by_fields(operator.sub, a, b)


def times(a: V, k: Any) -> V:
    """a scaled by a number, or, for vectors of one kind, the product component by component."""
    if type(k) is float:  # by far most are
        return new(type(a), [x * k for x in a])
    if isinstance(a, Quat) and isinstance(k, tuple):
        raise TypeError("a quaternion is only scaled by numbers; write hamilton(a, b) for the product")
    if isinstance(k, tuple) or (is_set(a) and is_rolled(k)):
        return _by_fields(operator.mul, a, k)
    return new(type(a), [x * k for x in a])


def over(a: V, k: Any) -> V:
    """a divided by a number, or component by component."""
    if isinstance(k, tuple) or (is_set(a) and is_rolled(k)):
        return _by_fields(operator.truediv, a, k)
    return new(type(a), [x / k for x in a])


def negative(a: V) -> V:
    """−a, field by field."""
    return new(type(a), [-x for x in a])


OPERATORS = {
    "__add__": plus,
    "__sub__": minus,
    "__mul__": times,
    "__rmul__": times,
    "__truediv__": over,
    "__neg__": negative,
}


@componentwise
class Vec3(NamedTuple):
    """Three components along x, y, z. `*` between two of them is component by component (a diagonal matrix)."""

    x: Any
    y: Any
    z: Any

    def __add__(self, other: Vec3) -> Vec3: ...
    def __sub__(self, other: Vec3) -> Vec3: ...
    def __mul__(self, k: Any) -> Vec3: ...
    def __rmul__(self, k: Any) -> Vec3: ...
    def __truediv__(self, k: Any) -> Vec3: ...
    def __neg__(self) -> Vec3: ...


@linear
class Quat(NamedTuple):
    """A quaternion w + xi + yj + zk. As an attitude it is of unit norm and maps body axes to world axes."""

    w: Any
    x: Any
    y: Any
    z: Any

    def __add__(self, other: Quat) -> Quat: ...
    def __sub__(self, other: Quat) -> Quat: ...
    def __mul__(self, k: Any) -> Quat: ...
    def __rmul__(self, k: Any) -> Quat: ...
    def __neg__(self) -> Quat: ...


@linear
class Mat3(NamedTuple):
    """A 3 × 3 matrix by its rows x, y, z (each a Vec3)."""

    x: Vec3
    y: Vec3
    z: Vec3

    def __add__(self, other: Mat3) -> Mat3: ...
    def __sub__(self, other: Mat3) -> Mat3: ...
    def __mul__(self, k: Any) -> Mat3: ...


ZERO = Vec3(0.0, 0.0, 0.0)


def layout(value: Any) -> Any:
    """The classes of a nested value, without its numbers: equal for values that hold their numbers alike."""
    return layout_and_numbers(value)[0]


def vec3(values: Any) -> Vec3:
    """A Vec3 of floats from any three numbers; of symbols from symbols."""
    x, y, z = values
    return Vec3(x, y, z) if type(x) is type(y) is type(z) is float else Vec3(number(x), number(y), number(z))


def mat3(rows: Any) -> Mat3:
    """A Mat3 of floats from any 3 × 3 array."""
    x, y, z = (vec3(row) for row in rows)
    return Mat3(x, y, z)


_sets: dict[int, type[NumberSet]] = {}


def each(count: int) -> type[NumberSet]:
    """The class of a set of `count` values, one for each rotor or each quadrotor of a vehicle.

    Value j of quadrotor i (both from 0) of a set of four a quadrotor is field 4 i + j. A `Vec3` of three sets holds a
    vector for each: the laws of vectors serve all of them at once.
    """
    return _sets.get(count) or _sets.setdefault(count, _new_set(count))  # of two threads, both get the first one's


def _new_set(count: int) -> Any:
    name = f"Each{count}"
    cls = NamedTuple(name, [(f"r{i}", Any) for i in range(count)])  # type: ignore[misc]
    cls.__module__, cls.__qualname__, cls.is_set = __name__, name, True  # type: ignore[attr-defined]
    return componentwise(cls)


@functools.cache
def several(count: int) -> Any:
    """The class of `count` values that add and scale, such as one for each mode: no set, so never a loop."""
    name = f"Several{count}"
    cls = NamedTuple(name, [(f"n{i}", Any) for i in range(count)])  # type: ignore[misc]
    cls.__module__, cls.__qualname__ = __name__, name
    return linear(cls)


def set_of(values: Sequence[Number] | NumberSet) -> NumberSet:
    """A set of values; a set that is one symbol is one already."""
    return values if is_rolled(values) else each(len(values))(*values)


def is_rolled(value: object) -> TypeGuard[NumberSet]:
    """Whether a value is a set that is one symbol (`compiler.tracer.graph`)."""
    return bool(getattr(value, "rolled", 0))


def is_set(value: object) -> TypeGuard[NumberSet]:
    """Whether a value is a set of numbers or symbols."""
    return isinstance(value, tuple) and getattr(type(value), "is_set", False)


def __getattr__(name: str) -> Any:
    """Sets and values by name (`vector.Each8`), so that a fresh process can unpickle a compiled loop that uses them."""
    if name.startswith("Each") and name[4:].isdigit():
        return each(int(name[4:]))
    if name.startswith("Several") and name[7:].isdigit():
        return several(int(name[7:]))
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def spread(values: Any) -> Vec3:
    """A `Vec3` of sets from any n × 3 array: a vector for each of n."""
    rows = [[number(v) for v in row] for row in values]
    return Vec3(*[each(len(rows))(*column) for column in zip(*rows, strict=True)])


@linear
class Quarters(NamedTuple, Generic[T]):
    """Values that every quadrotor has four of (rotors, feet), as four, each of sets with one for each quadrotor."""

    first: T
    second: T
    third: T
    fourth: T


def quarters(v: NumberSet) -> Quarters[NumberSet]:
    """The four sets of a set of four a quadrotor."""
    return Quarters(*[set_of(v[i::4]) for i in range(4)])


def total(v: Iterable[Number]) -> Number:
    """The sum of the values of a set, or of the components of a vector."""
    return functools.reduce(operator.add, v)


@law
def cross(a: Vec3, b: Vec3) -> Vec3:
    """a × b."""
    return Vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


@law
def dot(a: V | NumberSet, b: V | NumberSet) -> Number:
    """Sum of the products of corresponding fields (vectors, quaternions, sets)."""
    total = a[0] * b[0]
    for x, y in zip(a[1:], b[1:], strict=True):
        total = total + x * y
    return total


@law
def apply(A: Mat3, v: Vec3) -> Vec3:
    """A v."""
    return Vec3(dot(v, A.x), dot(v, A.y), dot(v, A.z))


@law
def apply_transposed(A: Mat3, v: Vec3) -> Vec3:
    """Aᵀ v."""
    return Vec3(
        v.x * A.x.x + v.y * A.y.x + v.z * A.z.x,
        v.x * A.x.y + v.y * A.y.y + v.z * A.z.y,
        v.x * A.x.z + v.y * A.y.z + v.z * A.z.z,
    )


@law
def outer(a: Vec3, b: Vec3) -> Mat3:
    """a bᵀ."""
    return Mat3(b * a.x, b * a.y, b * a.z)


@law
def hamilton(a: Quat, b: Quat) -> Quat:
    """The quaternion product a b (rotation by b, then by a)."""
    return Quat(
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
    )
