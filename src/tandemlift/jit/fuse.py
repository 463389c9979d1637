"""Rounding that does not depend on how a law is compiled: a·b + c becomes one fused operation in its source.

A compiler may contract a product and a sum as it likes, differently for one flight and for a block of flights. Here the
compiled copy of each law is rewritten before compilation, so that the choice is made once. Plain Python keeps the
unfused source.
"""

from __future__ import annotations

import ast
import functools
import inspect
import textwrap
import types as python_types
from collections.abc import Callable
from typing import Any, TypeGuard

from numba import types
from numba.extending import intrinsic, overload

INLINE = {
    "forceinline": True,
    "error_model": "numpy",
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "_nrt": False,
}


@intrinsic
def _fma(typing_context, a, b, c):
    """One fused multiply-add of float64 numbers."""

    def generate(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


def fma(a: Any, b: Any, c: Any) -> Any:
    """a b + c; compiled, rounded once for numbers and field by field for linear values."""
    return a * b + c


def value_class(kind: Any) -> Any:
    """The NamedTuple class behind a Numba type, or None."""
    return getattr(kind, "instance_class", None) if isinstance(kind, types.BaseNamedTuple) else None


def is_number(kind: Any) -> bool:
    """Whether a Numba type is a real number."""
    return isinstance(kind, (types.Float, types.Integer))


@overload(fma, jit_options=INLINE)
def _typed_fma(a, b, c):
    if is_number(a) and is_number(b) and is_number(c):
        return lambda a, b, c: _fma(a, b, c)
    cls = value_class(c)
    fits = [is_number(t) or value_class(t) is cls for t in (a, b)]
    product = is_number(a) or is_number(b) or getattr(cls, "componentwise", False)
    if not (getattr(cls, "linear", False) and all(fits) and product):
        return lambda a, b, c: a * b + c
    pick = {name: f"{name}[{{i}}]" if value_class(t) is cls else name for name, t in (("a", a), ("b", b))}
    fields = (f"fma({pick['a']}, {pick['b']}, c[{{i}}])".format(i=i) for i in range(len(cls._fields)))
    return define("a, b, c", f"cls({', '.join(fields)})", cls=cls, fma=fma)


def define(parameters: str, expression: str, **names: Any) -> Callable[..., Any]:
    """The function of `parameters` that returns `expression`, for implementations that depend on a type's fields."""
    scope: dict[str, Any] = dict(names)
    exec(f"def defined({parameters}):\n    return {expression}", scope)
    return scope["defined"]


class _Fuse(ast.NodeTransformer):
    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        if not isinstance(node.op, (ast.Add, ast.Sub)):
            return node
        plus = isinstance(node.op, ast.Add)
        left, right = node.left, node.right
        if _is_product(left):
            arguments = [left.left, left.right, right if plus else _negated(right)]
        elif _is_product(right):
            arguments = [right.left if plus else _negated(right.left), right.right, left]
        else:
            return node
        return ast.copy_location(ast.Call(ast.Name("_fma_", ast.Load()), arguments, []), node)


def _is_product(node: ast.AST) -> TypeGuard[ast.BinOp]:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)


def _negated(node: ast.expr) -> ast.expr:
    return ast.UnaryOp(ast.USub(), node)


@functools.cache
def fused(function: Callable[..., Any]) -> Callable[..., Any]:
    """The copy of a law that is compiled: every a·b ± c in its source is one fused multiply-add."""
    lines, first = inspect.getsourcelines(function)
    tree = ast.parse(textwrap.dedent("".join(lines)))
    ast.increment_lineno(tree, first - 1)
    definition = tree.body[0]
    assert isinstance(definition, ast.FunctionDef)
    definition.decorator_list = []
    definition.returns = None
    for argument in definition.args.args:
        argument.annotation = None
    function.__globals__["_fma_"] = fma
    tree = ast.fix_missing_locations(_Fuse().visit(tree))
    code = compile(tree, inspect.getsourcefile(function) or "<law>", "exec", dont_inherit=True)
    body = next(c for c in code.co_consts if isinstance(c, python_types.CodeType))
    return python_types.FunctionType(body, function.__globals__, function.__name__, function.__defaults__)
