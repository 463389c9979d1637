"""Machine code of any function of values over rows of numbers, for tests, benchmarks and studies of single laws."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from tandemlift.compiler import single as single  # for floats
from tandemlift.compiler.machine_code import machine
from tandemlift.compiler.tracer.fused import traced
from tandemlift.compiler.tracer.graph import Graph, symbols
from tandemlift.compiler.tracer.llvm import Function
from tandemlift.compiler.tracer.symbol import Symbol
from tandemlift.compiler.tracer.text import Module, Place
from tandemlift.core.types import Array, leaves


def results_of(graph: Graph, run: Callable[..., Any], likes: Sequence[Any]) -> list[Symbol]:
    """The numbers of what a traced function gives for inputs `x`, laid out like its arguments one after another."""
    firsts = itertools.accumulate(map(leaves, likes), initial=0)
    arguments = [graph.inputs("x", like, first) for like, first in zip(likes, firsts, strict=False)]
    return symbols(graph, run(*arguments))


def in_lanes(rows: Array, lanes: int) -> Array:
    """Rows as blocks of lanes, the lanes last; the last row is repeated up to a multiple of the lanes."""
    blocks = -(-len(rows) // lanes)
    filled = np.concatenate([rows, np.repeat(rows[-1:], blocks * lanes - len(rows), axis=0)])
    return np.ascontiguousarray(np.moveaxis(filled.reshape(blocks, lanes, *rows.shape[1:]), 1, -1))


def in_rows(blocks: Array, rows: int) -> Array:
    """Blocks of lanes as rows."""
    back = np.moveaxis(blocks, -1, 1)
    return back.reshape(-1, *back.shape[2:])[:rows]


def written(
    function: Callable[..., Any], *likes: Any, lanes: int = 1, rolls_from: int = 0, real: str = "double"
) -> tuple[str, int]:
    """The text of a module whose `rows` evaluates a function as `compiled` does, and the number of its results."""
    graph, module = Graph(rolls_from, real), Module()
    found = results_of(graph, traced(function), likes)
    f = Function(module, graph, lanes, "i64 @rows(ptr %x, ptr %y, i64 %count) #0")
    with f.repeat("%count") as row:
        x = f.at("%x", f.integer("mul", row, sum(map(leaves, likes))))
        y = f.at("%y", f.integer("mul", row, len(found)))
        f.read["x"] = lambda i: Place(x, i)
        f.put(y, 0, found)
    f.end("i64 0")
    return module.text, len(found)


def compiled(
    function: Callable[..., Any],
    *likes: Any,
    lanes: int = 1,
    level: machine.Level = machine.BEST,
    rolls_from: int = 0,
    real: str = "double",
) -> Callable[[Array], Array]:
    """Machine code of a function of values.

    Args:
        function: a law, or any function of values that can be traced; a law is fused as in a flight.
        likes: a value laid out like each of its arguments (a number for a number).
        lanes: rows per instruction, 1 or a power of two.
        level: optimisation level.
        rolls_from: size from which on sets are handled in loops; 0 for never.
        real: "double", or "float" for single precision.

    Returns:
        A function from (rows, numbers of all arguments) to (rows, numbers of its results), depth first. The
        last row is repeated up to a multiple of the lanes.

    Raises:
        TraceError: the function cannot be traced.
    """
    text, height = written(function, *likes, lanes=lanes, rolls_from=rolls_from, real=real)
    code = machine.Loaded(machine.compiled(text, level), ["rows"])
    kind = np.float32 if real == "float" else np.float64

    def call(rows: Array) -> Array:
        x = in_lanes(rows.astype(kind), lanes)
        y = np.empty((len(x), height, lanes), kind)
        machine.ROWS(code.addresses["rows"])(x.ctypes.data, y.ctypes.data, len(x))
        return in_rows(y, len(rows))

    return call
