"""Graphs of a mission's numbers, for tests: in machine code, and with other numbers."""

from __future__ import annotations

import ctypes
import random
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from tandemlift.compiler.machine_code.machine import QUICK, Loaded, compiled
from tandemlift.compiler.tracer import Function, Module, Place, Symbol
from tandemlift.core.types import layout_and_numbers
from tandemlift.simulation.preparation.memory import aligned
from tandemlift.simulation.preparation.traced_assembly import TracedAssembly

CHOOSES = re.compile(r"controller\.gains\.a\.\d|vehicle\.quadrotors\.\d\.spins")  # a number of these picks a law
PART = re.compile(r"(vehicle\.quadrotors)\.\d+\.")


def assembled_numbers(assembled: Any) -> list[Any]:
    """All numbers of an assembled flight, one after another: floats, or floats and symbols."""
    tables = [x for table in assembled.tables for x in table.flat]
    return [*layout_and_numbers(assembled.model)[1], *tables, *assembled.delays.tolist(), *assembled.seeds.tolist()]


def values_of(traced: TracedAssembly, nodes: list[Any]) -> np.ndarray:
    """The numbers of an assembled flight, given the values of all nodes."""
    numbers = assembled_numbers(traced.assembled)
    return np.array([float(nodes[x.node]) if isinstance(x, Symbol) else float(x) for x in numbers])


def machine_code(traced: TracedAssembly) -> Callable[[Any], np.ndarray]:
    """Machine code of a traced assembly: from its inputs to all numbers of the flight, then the guards' truths."""
    numbers, graph, module = assembled_numbers(traced.assembled), traced.graph, Module()
    made = [x if isinstance(x, Symbol) else Symbol(graph, graph.constant(float(x)), "f") for x in numbers]
    truths = [Symbol(graph, graph.number(guard.condition), "f") for guard in traced.guards]
    f = Function(module, graph, 1, "i64 @prepare(ptr %x, ptr %y) #0")
    f.read["number"] = lambda i: Place("%x", i)
    f.put("%y", 0, [*made, *truths])
    f.end("i64 0")
    code = Loaded(compiled(module.text, QUICK), ["prepare"])
    call = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p)(code.addresses["prepare"])

    def prepared(inputs: Any) -> np.ndarray:
        given, out = aligned(len(traced.keys)), aligned(len(made) + len(truths))
        given[:] = inputs
        call(given.ctypes.data, out.ctypes.data)
        _ = code  # lives as long as what calls it
        return out

    return prepared


def varied(traced: TracedAssembly, seed: int, spread: float = 0.01) -> dict[str, float]:
    """Other values of all inputs, by random factors; all quadrotors alike, so that the vehicle stays symmetric."""
    chance, factors = random.Random(seed), dict[str, float]()
    found = {}
    for key, value in zip(traced.keys, traced.values, strict=True):
        factor = factors.setdefault(PART.sub(r"\1.", key), 1.0 + chance.uniform(-spread, 0.0))
        found[key] = value if CHOOSES.fullmatch(key) else value * factor
    return found
