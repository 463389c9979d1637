"""Compiled loops over pixels: the formula of a pixel is traced, and loops are written around it.

The argument of a loop is one array of 64-bit words: addresses of arrays, and integers.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from tandemlift.machine_code.code import Code, Written
from tandemlift.machine_code.store import PACKAGE, key_of
from tandemlift.trace import Function, Graph, Module

LANES = 8  # columns that one vector instruction processes
RAMP = f"<{', '.join(f'i64 {j}' for j in range(LANES))}>"
FILES = [*Path(__file__).parent.glob("*.py"), *(PACKAGE / "algebra").glob("*.py")]


class Pixels:
    """A compiled loop over pixels, compiled at its first call.

    Args:
        name: of the loop.
        words: the names of its arguments.
        write: writes its body, given the graph, the function and the arguments by name.
        uniform: kinds of inputs that are the same for neighbouring columns.
    """

    def __init__(self, name: str, words: tuple[str, ...], write: Callable[..., None], uniform: tuple[str, ...]) -> None:
        self.name, self.words, self.write, self.uniform = name, words, write, uniform
        self._lock, self._code = threading.Lock(), list[Code]()

    def _written(self) -> Written:
        module, graph = Module(), Graph()
        f = Function(module, graph, LANES, f"i64 @{self.name}(ptr noalias %c) #0", self.uniform)
        self.write(graph, f, {word: f.load("%c", i, "i64") for i, word in enumerate(self.words)})
        f.end("i64 0")
        return Written(module.text, {"what": "drawing loop"})

    def __call__(self, *given: Any) -> None:
        """Run the loop with C-contiguous arrays and integers."""
        with self._lock:
            if not self._code:
                self._code.append(Code(key_of(0.0, self.name, files=FILES), [self.name], self._written))
        (code,) = self._code
        words = np.array([x.ctypes.data if isinstance(x, np.ndarray) else x for x in given], np.int64)
        began = time.perf_counter()
        code.free[self.name](words.ctypes.data)
        code.add_time(time.perf_counter() - began)


def array(f: Function, word: str) -> str:
    """The array at an address."""
    return f.op(f"inttoptr i64 {word} to ptr")


@contextmanager
def column_blocks(f: Function, first: str, after: str) -> Iterator[str]:
    """A loop from column `first` to `after` − 1 in blocks of LANES; yields the first column of a block.

    The input `column` is the index of a column; in the last block it may exceed the last column.
    """
    blocks = f.integer("sdiv", f.integer("add", f.integer("sub", after, first), LANES - 1), LANES)
    with f.repeat(blocks) as block:
        column = f.integer("add", first, f.integer("mul", block, LANES))
        lanes = f.op(f"add <{LANES} x i64> {f.spread(column, 'i64')}, {RAMP}")
        f.read["column"] = lambda i: lanes
        yield column


def load_where(f: Function, mask: str, base: str, count: int = 1) -> list[str]:
    """Load `count` numbers for each column of a block; 0 where the mask is false."""
    size = LANES * count
    kind, mask = f"<{size} x double>", _widened(f, mask, count)
    types = ["ptr align 8", f"<{size} x i1>", kind]
    wide = f.call(kind, f"@llvm.masked.load.v{size}f64.p0", base, mask, "zeroinitializer", types=types)
    if count == 1:
        return [wide]
    return [_shuffled(f, [wide, wide], kind, range(m, size, count)) for m in range(count)]


def store_where(f: Function, mask: str, values: list[str], base: str, kind: str = "double") -> None:
    """Store values for each column of a block where the mask is true."""
    count, size = len(values), LANES
    order = [m * LANES + lane for lane in range(LANES) for m in range(count)]
    values = [*values, *values[-1:] * (-count % 2 if count > 1 else 0)]
    while len(values) > 1:
        pairs = zip(values[::2], values[1::2], strict=True)
        values = [_shuffled(f, pair, f"<{size} x {kind}>", range(2 * size)) for pair in pairs]
        size *= 2
    value = values[0] if count == 1 else _shuffled(f, values * 2, f"<{size} x {kind}>", order)
    wide, mask = f"<{len(order)} x {kind}>", _widened(f, mask, count)
    name = f"@llvm.masked.store.v{len(order)}{'f64' if kind == 'double' else kind}.p0"
    f.module.declared.add(f"declare void {name}({wide}, ptr, <{len(order)} x i1>)")
    f.do(f"call void {name}({wide} {value}, ptr align 8 {base}, <{len(order)} x i1> {mask})")


def _shuffled(f: Function, pair: Iterable[str], kind: str, order: Iterable[int]) -> str:
    """The elements of two vectors in a given order."""
    a, b = pair
    places = ", ".join(f"i32 {i}" for i in order)
    return f.op(f"shufflevector {kind} {a}, {kind} {b}, <{places.count('i32')} x i32> <{places}>")


def _widened(f: Function, mask: str, count: int) -> str:
    """A mask with each element repeated `count` times."""
    if count == 1:
        return mask
    return _shuffled(f, [mask, mask], f"<{LANES} x i1>", (lane for lane in range(LANES) for _ in range(count)))
