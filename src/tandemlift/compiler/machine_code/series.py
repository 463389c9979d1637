"""A step from state to state over a series of inputs, for many rows at once, and its tangents: called from NumPy.

The parameters are the same for all rows; what depends on nothing else is computed once for a call, before all steps.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from ctypes import CFUNCTYPE, c_int64, c_void_p
from typing import Any

import numpy as np

from tandemlift.compiler.machine_code import machine
from tandemlift.compiler.machine_code.differentiated import tangents
from tandemlift.compiler.machine_code.functions import in_lanes, in_rows
from tandemlift.compiler.tracer import Function, Graph, Module, Place, Symbol, symbols, traced
from tandemlift.core.caching import cached_for_a_trace
from tandemlift.core.types import Array, leaves

LANES = 8
KINDS = ("x", "p", "u")  # state, parameters, inputs
CALL = CFUNCTYPE(c_int64, *[c_void_p] * 8, c_int64, c_int64)
HEAD = "i64 @series({}, i64 %steps, i64 %blocks) #0".format(
    ", ".join(f"ptr noalias %{name}" for name in ("x", "p", "u", "y", "dx", "dp", "du", "dy"))
)


class Series:
    """A step over series of inputs as machine code.

    Args:
        prepare: from the parameters to the first argument of the step.
        step: a law from (what `prepare` gives, state, inputs) to (the next state, outputs).
        parameters: a value laid out like the parameters; `state` and `inputs` likewise.
        differentiated: whether tangents are formed.
    """

    def __init__(
        self,
        prepare: Callable[[Any], Any],
        step: Callable[[Any, Any, Any], tuple[Any, Any]],
        parameters: Any,
        state: Any,
        inputs: Any,
        *,
        differentiated: bool,
    ) -> None:
        graph = Graph()
        x, p, u = (graph.inputs(kind, like) for kind, like in zip(KINDS, (state, parameters, inputs), strict=True))
        with cached_for_a_trace():
            after, outputs = traced(step)(prepare(p), x, u)
        made, seen = symbols(graph, after), symbols(graph, outputs)
        self._sizes = leaves(state), leaves(parameters), leaves(inputs), len(seen)
        self._differentiated = differentiated
        moved = _tangents(graph, [*made, *seen]) if differentiated else []
        text = _written(graph, [made, seen], [moved[: len(made)], moved[len(made) :]])
        self._code = machine.Loaded(machine.compiled(text, machine.BEST_OF_VECTORS), ["series"])

    def __call__(self, x: Array, p: Array, u: Array) -> tuple[Array, Array]:
        """(Outputs of all steps (rows, steps, outputs), states after the last one (rows, n)).

        Args:
            x: states before the first step (rows, n).
            p: parameters (m,).
            u: inputs of all steps (rows, steps, inputs).
        """
        still = (np.zeros_like(x), np.zeros_like(p), np.zeros_like(u)) if self._differentiated else None
        y, _, after = self._called(x, p, u, still)
        return y, after

    def tangent(self, x: Array, p: Array, u: Array, dx: Array, dp: Array, du: Array) -> tuple[Array, Array]:
        """(Outputs, their tangents) along a direction of states, parameters and inputs, laid out like these."""
        y, dy, _ = self._called(x, p, u, (dx, dp, du))
        return y, dy

    def _called(
        self, x: Array, p: Array, u: Array, direction: tuple[Array, Array, Array] | None
    ) -> tuple[Array, Array, Array]:
        rows, steps = u.shape[:2]
        blocks, height = -(-rows // LANES), self._sizes[3]
        y = np.empty((blocks, steps, height, LANES))
        dy = np.empty((blocks, steps, height, LANES)) if direction else y[:0]
        own = [in_lanes(x, LANES), _uniform(p), in_lanes(u, LANES)]
        along = own
        if direction:
            dx, dp, du = direction
            along = [in_lanes(dx, LANES), _uniform(dp), in_lanes(du, LANES)]
        arrays = [*own, y, *along, dy]
        CALL(self._code.addresses["series"])(*[a.ctypes.data for a in arrays], steps, blocks)
        return in_rows(y, rows), in_rows(dy, rows) if direction else dy, in_rows(own[0], rows)


def _tangents(graph: Graph, results: Sequence[Symbol]) -> list[Symbol]:
    """The tangents of results, along those of all inputs."""
    given = [n for n, op in enumerate(graph.ops) if op == "in"]
    seeds = {n: graph.input(f"d{graph.args[n][0]}", graph.args[n][1]) for n in given}
    moved = tangents(graph, [s.node for s in results], seeds, {})
    zero = Symbol(graph, graph.constant(0.0), "f")
    return [moved.get(s.node, zero) for s in results]


def _written(graph: Graph, plain: Sequence[Sequence[Symbol]], moved: Sequence[Sequence[Symbol]]) -> str:
    """The text of a module whose function goes through all steps of all blocks; states are replaced in place."""
    module, parts = Module(), {"x": plain[0], "y": plain[1], "dx": moved[0], "dy": moved[1]}
    f = Function(module, graph, LANES, HEAD, uniform=("p", "dp"))
    sizes = {kind: _size(graph, kind) for kind in ("u", "du")}
    f.read = {kind: _place(f"%{kind}") for kind in ("p", "dp")}
    every = [s for part in parts.values() for s in part]
    f.write([n for n in graph.needed([s.node for s in every]) if f.is_uniform(n) and not f.is_leaf(n)])
    with f.repeat("%blocks") as block:
        states = {name: f.at(f"%{name}", f.integer("mul", block, len(parts[name]))) for name in ("x", "dx")}
        with f.repeat("%steps") as step:
            place = f.integer("add", f.integer("mul", block, "%steps"), step)
            at = states | {name: f.at(f"%{name}", f.integer("mul", place, len(parts[name]))) for name in ("y", "dy")}
            at |= {kind: f.at(f"%{kind}", f.integer("mul", place, size)) for kind, size in sizes.items()}
            f.read |= {kind: _place(at[kind]) for kind in ("x", "dx", "u", "du")}
            texts = f.values(every)
            places = [(name, i) for name, part in parts.items() for i in range(len(part))]
            for (name, i), text in zip(places, texts, strict=True):
                f.store(text, at[name], i)
    f.end("i64 0")
    return module.text


def _size(graph: Graph, kind: str) -> int:
    """The number of inputs of a kind; tangents have as many as their kind."""
    places = [graph.args[n][1] for n, op in enumerate(graph.ops) if op == "in" and graph.args[n][0] == kind[-1]]
    return max(places, default=-1) + 1


def _place(base: str) -> Callable[[int], Place]:
    return lambda i: Place(base, i)


def _uniform(p: Array) -> Array:
    """Numbers that stand in the first lane."""
    return np.ascontiguousarray(np.repeat(np.asarray(p, dtype=float)[:, None], LANES, axis=1))
