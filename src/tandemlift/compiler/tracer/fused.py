"""The copy of a law that is traced: each a·b + c of its source becomes one fused multiply-add.

A compiler could contract products and sums differently for one flight and for a block of flights. Here the choice is
made once, in the source of the law, so that all machine code rounds alike. Plain Python runs the unfused source. A law
whose source cannot be read, or that is defined inside another function, is traced unfused.

Processors without a fused multiply-add, and WebAssembly, need code that rounds products and sums one by one: what is
traced by `rounded_twice` has the same bits on all of them.
"""

from __future__ import annotations

import ast
import builtins
import copy
import functools
import linecache
import math
import operator
import threading
import traceback
import types
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from fractions import Fraction
from typing import Any, Protocol, TypeGuard

from tandemlift.compiler.tracer.graph import LAW
from tandemlift.compiler.tracer.refusal import is_ours, refused
from tandemlift.compiler.tracer.symbol import Symbol, graph_of, made, type_of
from tandemlift.core import algebra, vector
from tandemlift.core.algebra import PRIMITIVES
from tandemlift.core.errors import InputError
from tandemlift.core.law import LAWS, Choice, Elementwise
from tandemlift.core.vector import is_set

FMA = "_fma_"
LEAVES = "_leaves_"
ALGEBRA = (algebra.__name__, vector.__name__)  # their comparisons count as those of the calling law
ONE_AT_A_TIME = threading.RLock()
FUSES: ContextVar[bool] = ContextVar("fuses", default=True)  # whether a·b + c is rounded once
# notified of every law that is entered
INTERCEPTOR: ContextVar[LawInterceptor | None] = ContextVar("interceptor", default=None)


class LawInterceptor(Protocol):
    """An interceptor between a law and its caller while a graph is traced (`compiler.tracer.structured`)."""

    def enter(self, law: Callable[..., Any], args: tuple[Any, ...]) -> Any:
        """The result of the law for these arguments."""

    def leave(self, names: dict[str, Any], result: Any) -> Any:
        """The result of the innermost law; `names`: its local names and their values."""


class _Leave(ast.NodeTransformer):
    """Hands the local names of a law to `LawInterceptor.leave` at its end."""

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        return node

    def visit_Return(self, node: ast.Return) -> ast.AST:
        if node.value is None:
            return node
        names = ast.Call(ast.Name("locals", ast.Load()), [], [])
        return ast.copy_location(ast.Return(ast.Call(ast.Name(LEAVES, ast.Load()), [names, node.value], [])), node)


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
        return ast.copy_location(ast.Call(ast.Name(FMA, ast.Load()), arguments, []), node)


def _is_product(node: ast.AST) -> TypeGuard[ast.BinOp]:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)


def _negated(node: ast.expr) -> ast.expr:
    return ast.UnaryOp(ast.USub(), node)


@functools.cache
def _definitions(source: str) -> dict[tuple[str, int], ast.FunctionDef]:
    """The functions of a source text by name and first line, decorators included."""
    found = {}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef):
            found[node.name, min([node.lineno, *[d.lineno for d in node.decorator_list]])] = node
    return found


def _source(function: Callable[..., Any]) -> ast.FunctionDef | None:
    """The definition of a function, if its source can be read and it is no inner function."""
    if not isinstance(function, types.FunctionType) or function.__closure__:
        return None
    code = function.__code__
    try:
        source = "".join(linecache.getlines(code.co_filename))  # the text that ran, also for files of `load_controller`
        return _definitions(source).get((code.co_name, code.co_firstlineno))
    except (SyntaxError, ValueError):
        return None


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """A function's code, and that of the functions inside it."""
    yield code
    for inner in code.co_consts:
        if isinstance(inner, types.CodeType):
            yield from _codes(inner)


def _bare(given: ast.arguments) -> ast.arguments:
    """Arguments without annotations and defaults."""
    first, others, last = ([ast.arg(a.arg) for a in part] for part in (given.posonlyargs, given.args, given.kwonlyargs))
    many, named = (a and ast.arg(a.arg) for a in (given.vararg, given.kwarg))
    return ast.arguments(first, others, many, last, [None] * len(last), named, [])


def fused(function: Callable[..., Any]) -> Callable[..., Any]:
    """The copy of a law that is traced, which calls the traced forms of other laws; fused unless `FUSES` is false."""
    return _copy(function, FUSES.get(), INTERCEPTOR.get() is not None)


def _leave(names: dict[str, Any], result: Any) -> Any:
    interceptor = INTERCEPTOR.get()
    return result if interceptor is None else interceptor.leave(names, result)


@functools.cache
def _copy(function: Callable[..., Any], fuses: bool, leaves: bool) -> Callable[..., Any]:
    with ONE_AT_A_TIME:
        node = _source(function)
        if node is None:
            return function
        body = copy.deepcopy(node.body)
        for transformer in [_Fuse()] * fuses + [_Leave()] * leaves:
            body = [transformer.visit(line) for line in body]
        definition = ast.FunctionDef(node.name, _bare(node.args), body, [], None)
        tree = ast.fix_missing_locations(ast.Module([ast.copy_location(definition, node)], []))
        module = compile(tree, function.__code__.co_filename, "exec", dont_inherit=True)
    code = next(c for c in module.co_consts if isinstance(c, types.CodeType))
    known = function.__globals__
    used = {name for part in _codes(code) for name in part.co_names}
    scope: dict[str, Any] = {name: traced(known[name]) for name in used if name in known}
    scope |= {"__builtins__": builtins, FMA: fma, LEAVES: _leave}
    if "int" in used:
        scope["int"] = _elementary("to_integer")
    made = types.FunctionType(code, scope, function.__name__, function.__defaults__)
    made.__kwdefaults__ = function.__kwdefaults__
    return made


def _elementary(name: str) -> Callable[..., Any]:
    return getattr(Symbol.functions, name)


PRIMITIVE = {operation: operation.__name__[1:] for operation in PRIMITIVES}


@functools.lru_cache(maxsize=1)
def _marked(count: int) -> frozenset[Callable[..., Any]]:
    return frozenset(LAWS)


def _run(law: Callable[..., Any], *args: Any) -> Any:
    interceptor = INTERCEPTOR.get()
    return run(law, *args) if interceptor is None else interceptor.enter(law, args)


def run(law: Callable[..., Any], *args: Any) -> Any:
    """Run a law on symbols; a user's law that fails on them is refused."""
    outer = LAW.set(LAW.get() if law.__module__ in ALGEBRA else law)
    try:
        return fused(law)(*args)
    except InputError:
        raise
    except Exception as error:
        if is_ours(law.__code__):
            raise
        trace = traceback.extract_tb(error.__traceback__)
        lines = [f.lineno for f in trace if f.filename == law.__code__.co_filename and f.lineno]
        what = (
            f"fails on symbols, {type(error).__name__}: {error}: use vectors and functions of tandemlift.core.algebra"
        )
        raise refused(what, law.__code__, lines[-1] if lines else law.__code__.co_firstlineno) from error
    finally:
        LAW.reset(outer)


def traced(thing: object) -> Any:
    """The traced form of an object that a law uses by a global name."""
    if isinstance(thing, Elementwise):
        return thing.calling(traced(thing.scalar))
    if isinstance(thing, Choice):
        return lambda *args: _run(thing.chosen(args[0]), *args)
    if isinstance(thing, types.FunctionType):
        if thing in PRIMITIVE:
            return lambda *args: _elementary(PRIMITIVE[thing])(*args)
        if thing in _marked(len(LAWS)):
            return functools.partial(_run, thing)
    return thing


def rounded_twice(thing: object) -> Callable[..., Any]:
    """The traced form of a law in which a·b + c is rounded after the product and after the sum."""
    run = traced(thing)

    def call(*args: Any) -> Any:
        before = FUSES.set(False)
        try:
            return run(*args)
        finally:
            FUSES.reset(before)

    return call


def tracer(fuses: bool) -> Callable[[Any], Any]:
    """`traced`, or `rounded_twice` for code that must not fuse."""
    return traced if fuses else rounded_twice


# ---- Fused multiply-add


def once_rounded(a: Any, b: Any, c: Any) -> Any:
    """a b + c of numbers or symbols, rounded once."""
    if any(isinstance(v, Symbol) for v in (a, b, c)):
        graph = graph_of(a, b, c)
        if not any(isinstance(v, (Symbol, tuple)) for v in (a, b)) and _is_exact(a, b):
            return made(graph, "fadd", a * b, c)
        return made(graph, "fma", a, b, c)
    if all(isinstance(v, int) for v in (a, b, c)):
        return a * b + c
    if not (math.isfinite(a) and math.isfinite(b) and math.isfinite(c)):
        return c if math.isfinite(a) and math.isfinite(b) else a * b + c
    exact = Fraction(a) * Fraction(b) + Fraction(c)
    try:
        return float(exact) if exact else a * b + c
    except OverflowError:
        return math.inf if exact > 0 else -math.inf


def _is_exact(a: float, b: float) -> bool:
    """Whether a product of two numbers needs no rounding."""
    return math.isfinite(a * b) and Fraction(a) * Fraction(b) == Fraction(a * b)


def fma(a: Any, b: Any, c: Any) -> Any:
    """a · b + c of the source of a law: rounded once for numbers, field by field for linear values."""
    rolled = any(isinstance(v, Symbol) and v.rolled for v in (a, b, c))
    if not any(isinstance(v, tuple) and not (rolled and is_set(v)) for v in (a, b, c)):
        return once_rounded(a, b, c) if all(type_of(v) != "b" for v in (a, b, c)) else operator.add(a * b, c)
    kind = type(c)
    fits = all(not isinstance(v, tuple) or type(v) is kind for v in (a, b))
    product = not isinstance(a, tuple) or not isinstance(b, tuple) or getattr(kind, "componentwise", False)
    if not (getattr(kind, "linear", False) and fits and product):
        return a * b + c
    columns = [v if isinstance(v, tuple) else (v,) * len(c) for v in (a, b)]
    return kind(*map(fma, *columns, c))
