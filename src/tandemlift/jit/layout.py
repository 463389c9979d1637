"""A nested value and its numbers in a flat array: one pair of functions for one flight, blocks, logs and buffers.

Leaf i of lane l of `stride` lanes stands at a[i * stride + l].
"""

from __future__ import annotations

from typing import Any

from numba import types
from numba.core.imputils import lower_constant
from numba.extending import models, overload, register_model, typeof_impl

from tandemlift.jit.fuse import INLINE


def is_value(x: Any) -> bool:
    """Whether x is a nested value rather than a number."""
    return hasattr(x, "_fields")


def flat(value: Any) -> list[float]:
    """The numbers of a nested value, depth first."""
    return [number for part in value for number in flat(part)] if is_value(value) else [float(value)]


def leaves(value: Any) -> int:
    """How many numbers a nested value holds."""
    return sum(map(leaves, value)) if is_value(value) else 1


def zeroed(value: Any) -> Any:
    """The same nested value with every number 0.0: the layout alone."""
    return type(value)(*map(zeroed, value)) if is_value(value) else 0.0


def unflat(numbers: Any, like: Any) -> Any:
    """The nested value laid out like `like` whose numbers are `numbers`, as Python floats."""
    return _unflat(map(float, numbers), like)


def _unflat(numbers: Any, like: Any) -> Any:
    return type(like)(*[_unflat(numbers, part) for part in like]) if is_value(like) else next(numbers)


class Layout:
    """The layout of a nested value as a constant of compiled code, which hands it on at no cost."""

    def __init__(self, value: Any) -> None:
        self.value = zeroed(value)


class LayoutType(types.Opaque):
    """Of a `Layout`: the type of the nested value."""

    def __init__(self, kind: Any) -> None:
        self.kind = kind
        super().__init__(f"Layout({kind})")


register_model(LayoutType)(models.OpaqueModel)


@typeof_impl.register(Layout)
def _typeof_layout(layout, context):
    return LayoutType(typeof_impl(layout.value, context))


@lower_constant(LayoutType)
def _layout_constant(context, builder, kind, layout):
    return context.get_dummy_value()


def _kind(like: Any) -> Any:
    return like.kind if isinstance(like, LayoutType) else like


def load(a, like):
    """The nested value laid out like `like`, read from a flat array."""


def store(a, value):
    """Write a nested value's numbers to a flat array."""


def load_lane(a, lane, stride, like):
    """Lane `lane` of `stride` interleaved values laid out like `like`."""


def store_lane(a, lane, stride, value):
    """Write a nested value as lane `lane` of `stride` interleaved ones."""


def _reading(kind: Any, at: int, index: str, names: dict[str, Any]) -> tuple[str, int]:
    if not isinstance(kind, types.BaseTuple):
        return f"a[{index.format(at)}]", at + 1
    name = f"class{len(names)}"
    names[name] = kind.instance_class
    parts = []
    for field in kind:
        source, at = _reading(field, at, index, names)
        parts.append(source)
    return f"{name}({', '.join(parts)})", at


def _writing(kind: Any, at: int, index: str, path: str) -> tuple[list[str], int]:
    if not isinstance(kind, types.BaseTuple):
        return [f"a[{index.format(at)}] = {path}"], at + 1
    lines: list[str] = []
    for i, field in enumerate(kind):
        more, at = _writing(field, at, index, f"{path}[{i}]")
        lines += more
    return lines, at


def _implement(parameters: str, body: list[str], names: dict[str, Any]) -> Any:
    scope = dict(names)
    exec(f"def implementation({parameters}):\n    " + "\n    ".join(body or ["pass"]), scope)
    return scope["implementation"]


@overload(load, jit_options=INLINE)
def _load(a, like):
    names: dict[str, Any] = {}
    source, _ = _reading(_kind(like), 0, "{}", names)
    return _implement("a, like", [f"return {source}"], names)


@overload(load_lane, jit_options=INLINE)
def _load_lane(a, lane, stride, like):
    names: dict[str, Any] = {}
    source, _ = _reading(_kind(like), 0, "{}*stride + lane", names)
    return _implement("a, lane, stride, like", [f"return {source}"], names)


@overload(store, jit_options=INLINE)
def _store(a, value):
    lines, _ = _writing(value, 0, "{}", "value")
    return _implement("a, value", lines, {})


@overload(store_lane, jit_options=INLINE)
def _store_lane(a, lane, stride, value):
    lines, _ = _writing(value, 0, "{}*stride + lane", "value")
    return _implement("a, lane, stride, value", lines, {})
