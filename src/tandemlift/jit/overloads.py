"""Compiled forms of everything that `tandemlift.law` has recorded, and of the operators of the value types."""

from __future__ import annotations

import inspect
import operator
from collections.abc import Callable
from typing import Any

from numba.extending import overload

from tandemlift import law, ops, vector
from tandemlift.jit.elementary import install_elementary
from tandemlift.jit.fuse import INLINE, define, fma, fused, is_number, value_class

_done: set[int] = set()


def install() -> None:
    """Give every law recorded so far its compiled form; call again after loading more laws."""
    if not _done:
        install_elementary()
        _install_operators()
        _done.add(0)
    for function in law.LAWS:
        if _first_time(function):
            _install_law(function)
    for mapped in law.ELEMENTWISE:
        if _first_time(mapped):
            _install_dispatch(mapped, mapped.scalar, _elementwise(mapped.scalar))
    for choice in law.CHOICES:
        if _first_time(choice):
            _install_dispatch(choice, choice.signature, _chosen(choice.table))


def _first_time(thing: object) -> bool:
    new = id(thing) not in _done
    _done.add(id(thing))
    return new


def _install_law(function: Callable[..., Any]) -> None:
    overload(function, jit_options=INLINE, strict=False)(lambda *types: fused(function))


def _install_dispatch(dispatcher: Any, signature: Callable[..., Any], typed: Callable[..., Any]) -> None:
    """Let `typed` choose the implementation of `dispatcher` from the types of the arguments."""
    names = ", ".join(inspect.signature(signature).parameters)
    overload(dispatcher, jit_options=INLINE)(define(names, f"typed({names!r}, {names})", typed=typed))


def _elementwise(scalar: Callable[..., Any]) -> Callable[..., Any]:
    def typed(names: str, *types: Any) -> Callable[..., Any]:
        vectors = [value_class(t) for t in types if getattr(value_class(t), "componentwise", False)]
        if not vectors:
            return define(names, f"scalar({names})", scalar=scalar)
        cls = vectors[0]
        arguments = [n + "[{i}]" if value_class(t) is cls else n for n, t in zip(names.split(", "), types, strict=True)]
        template = f"scalar({', '.join(arguments)})"
        fields = ", ".join(template.format(i=i) for i in range(len(cls._fields)))
        return define(names, f"cls({fields})", cls=cls, scalar=scalar)

    return typed


def _chosen(table: dict[type, Callable[..., Any]]) -> Callable[..., Any]:
    def typed(names: str, *types: Any) -> Callable[..., Any] | None:
        chosen = table.get(value_class(types[0]))
        return chosen and define(names, f"chosen({names})", chosen=chosen)

    return typed


def _fieldwise(parameters: str, cls: Any, expression: str) -> Callable[..., Any]:
    fields = ", ".join(expression.format(i=i) for i in range(len(cls._fields)))
    return define(parameters, f"cls({fields})", cls=cls)


def _is_linear(kind: Any) -> bool:
    return getattr(value_class(kind), "linear", False)


def _install_operators() -> None:
    for function, symbol in (
        (operator.add, "+"),
        (operator.sub, "-"),
        (operator.mul, "*"),
        (operator.truediv, "/"),
    ):
        _install_operator(function, symbol)

    @overload(operator.neg, jit_options=INLINE)
    def _negative(a):
        return _fieldwise("a", value_class(a), "-a[{i}]") if _is_linear(a) else None

    @overload(vector.dot, jit_options=INLINE)
    def _dot(a, b):
        source = "a[0] * b[0]"
        for i in range(1, len(a)):
            source = f"fma(a[{i}], b[{i}], {source})"
        return define("a, b", source, fma=fma)

    @overload(vector.total, jit_options=INLINE)
    def _total(v):
        return define("v", " + ".join(f"v[{i}]" for i in range(len(v))))

    @overload(ops.greatest, jit_options=INLINE)
    def _greatest(values):
        source = "values[0]"
        for i in range(1, len(values)):
            source = f"maximum({source}, values[{i}])"
        return define("values", source, maximum=ops.maximum)

    @overload(vector.quarters, jit_options=INLINE)
    def _quarters(v):
        sets = (", ".join(f"v[{i}]" for i in range(j, len(v), 4)) for j in range(4))
        return define(
            "v", f"cls({', '.join(f'own({s})' for s in sets)})", cls=vector.Quarters, own=vector.each(len(v) // 4)
        )


def _install_operator(function: Any, symbol: str) -> None:
    @overload(function, jit_options=INLINE)
    def _binary(a, b):
        cls = value_class(a)
        if _is_linear(a) and cls is value_class(b):
            if symbol in "+-" or cls.componentwise:
                return _fieldwise("a, b", cls, f"a[{{i}}] {symbol} b[{{i}}]")
        elif symbol in "*/" and _is_linear(a) and is_number(b):
            return _fieldwise("a, b", cls, f"a[{{i}}] {symbol} b")
        elif symbol == "*" and is_number(a) and _is_linear(b):
            return _fieldwise("a, b", value_class(b), "b[{i}] * a")
        return None
