"""Laws as machine code, for tests: a step in a loop, and any function over rows of numbers."""

from __future__ import annotations

import ctypes
import itertools
from collections.abc import Callable
from types import FunctionType
from typing import Any

import numpy as np

from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.compiler.machine_code.machine import BEST, Level, Loaded
from tandemlift.compiler.machine_code.machine import compiled as object_code
from tandemlift.compiler.tracer import Function, Graph, Module, symbols
from tandemlift.compiler.tracer.fused import fused
from tandemlift.core.types import flat, leaves, rebuilt

STEPS = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_void_p] * 4, ctypes.c_int64)


def fused_copy(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function as a law is traced, marked as one or not."""
    return fused(function) if isinstance(function, FunctionType) else function


def answers(
    function: Callable[..., Any], arguments: tuple[Any, ...], rows: Any = None, lanes: int = 1, level: Level = BEST
) -> np.ndarray:
    """Results of a function's machine code for rows of numbers (rows × numbers); without rows, for the arguments."""
    table = np.array([[x for a in arguments for x in flat(a)]] if rows is None else rows, dtype=float)
    return compiled(fused_copy(function), *arguments, lanes=lanes, level=level)(table)


class Loop:
    """A step in a loop of machine code: (fixed, moving, given) → (shown, next moving).

    Args:
        step: of values, fused as a law is.
        fixed: a value of the type that is constant.
        moving: a value of the type that a step passes to the next.
        given: a value of the type of which every step gets a row.
    """

    def __init__(self, step: Callable[..., Any], fixed: Any, moving: Any, given: Any, level: Level = BEST) -> None:
        graph, inputs = Graph(), itertools.count
        arguments = [
            rebuilt((graph.input(kind, i) for i in inputs()), like)
            for kind, like in (("fixed", fixed), ("moving", moving), ("given", given))
        ]
        shown, after = (symbols(graph, part) for part in fused_copy(step)(*arguments))
        self.width, self.given, module = len(shown), leaves(given), Module()
        head = "i64 @steps(ptr %fixed, ptr %moving, ptr %given, ptr %shown, i64 %count) #0"
        f = Function(module, graph, 1, head)
        with f.repeat("%count") as i:
            row, out = (
                f.at(base, f.integer("mul", i, n)) for base, n in (("%given", self.given), ("%shown", self.width))
            )
            f.read = {
                "fixed": lambda m: f.load("%fixed", m),
                "moving": lambda m: f.load("%moving", m),
                "given": lambda m: f.load(row, m),
            }
            values, next_ones = f.values(shown), f.values(after)
            for base, numbers in ((out, values), ("%moving", next_ones)):
                for m, value in enumerate(numbers):
                    f.store(value, base, m)
        f.end("i64 0")
        self.code = Loaded(object_code(module.text, level), ["steps"])
        self.run = STEPS(self.code.addresses["steps"])

    def __call__(self, fixed: Any, moving: Any, given: Any) -> np.ndarray:
        """What the steps show (steps × numbers), one step per row of `given` (steps × numbers)."""
        arrays = [np.array(flat(fixed)), np.array(flat(moving)), np.ascontiguousarray(given, dtype=float)]
        assert arrays[2].shape[1:] == (self.given,)
        shown = np.zeros((len(arrays[2]), self.width))
        self.run(*[a.ctypes.data for a in (*arrays, shown)], len(shown))
        return shown
