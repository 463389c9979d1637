"""The graph from the numbers of a mission to the numbers of its flight.

A mission is assembled with symbols for its numbers, so that one graph computes all numbers of a flight, bit-identical
on any machine: each product and each sum is rounded separately. Results that depend on more than the values of numbers
(the steps of a delay, the solution of a Riccati equation) are fixed to those of this mission.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple, TypeVar

import numpy as np
from pydantic import BaseModel

from tandemlift.compiler.tracer.fused import FUSES
from tandemlift.compiler.tracer.symbol import Symbol
from tandemlift.compiler.tracer.valued_graph import Guard, ValuedGraph
from tandemlift.core.caching import cached_for_a_trace
from tandemlift.core.errors import dotted
from tandemlift.core.types import is_value
from tandemlift.missions import Mission
from tandemlift.simulation.preparation.assemble import assemble

T = TypeVar("T")
Place = tuple[str | int, ...]

FIXED = {
    "mission.duration": "determines the number of steps",
    "mission.step": "determines the number of steps, and the steps of every time",
    "mission.log_interval": "determines the steps between rows of the log",
}
SHAPE = ("vehicle.payload.size.", "vehicle.payload.corners.", "vehicle.payload.bodies.")
SCHEDULED = "belongs to a change in flight, which becomes a mission of its own"
WHOLE = "is a whole number, on which the layout of the flight may depend"
UNTRACED = ("controller.", "vehicle.")  # tables that a controller's start reads


class TracedAssembly(NamedTuple):
    """An assembled flight as a graph of a mission's numbers.

    Attributes:
        graph: of operations that are rounded one by one.
        keys: of the inputs; input i is `graph.input("number", i)`.
        values: of the inputs in this mission.
        assembled: the result, with symbols and plain numbers.
        guards: conditions and whether they hold in this mission; while all keep their truth, the graph is that of
            missions with other values of the inputs, too.
        fixed: keys that are no inputs, and why.
    """

    graph: ValuedGraph
    keys: tuple[str, ...]
    values: tuple[float, ...]
    assembled: Any
    guards: tuple[Guard, ...]
    fixed: dict[str, str]

    def keys_of(self, guard: Guard) -> tuple[str, ...]:
        """The keys that a guard depends on."""
        return tuple(self.keys[i] for i in self.graph.inputs_of(guard.condition))


def trace_assembly(mission: Mission, build: Callable[[Mission], Any] = assemble) -> TracedAssembly:
    """Trace the assembly of a mission's numbers.

    Args:
        mission: from `load_mission`.
        build: the function to trace; by default, the assembly of the whole flight.

    Raises:
        InputError: a part of the mission cannot be built.
    """
    numbers, fixed = numbers_of_mission(mission), {**FIXED, **dict.fromkeys(counts_of_mission(mission), WHOLE)}
    fixed |= {key: "determines the faces of the payload" for key in numbers if key.startswith(SHAPE)}
    turned = re.compile(r"vehicle\.quadrotors\.\d+\.heading").fullmatch
    fixed |= {key: "determines the axes of a quadrotor" for key in numbers if turned(key)}
    fixed |= {key: SCHEDULED for key in numbers if key.startswith("changes.")}
    while True:
        traced, reasons = _tried(numbers, fixed, lambda symbols: build(with_numbers(mission, symbols)))
        if traced is not None and not reasons:
            return traced
        fixed |= reasons


def _tried(
    numbers: dict[str, float], fixed: dict[str, str], build: Callable[[dict[str, Symbol]], Any]
) -> tuple[TracedAssembly | None, dict[str, str]]:
    """A trace with all numbers that are not fixed, and the numbers that were found to be fixed."""
    inputs = {key: value for key, value in numbers.items() if key not in fixed}
    keys, graph = tuple(inputs), ValuedGraph(tuple(inputs.values()))
    symbols = {key: graph.input("number", i) for i, key in enumerate(keys)}
    before = FUSES.set(False)
    try:
        with cached_for_a_trace():
            assembled = build(symbols)
    except Exception as error:  # a controller's start may use its settings and the vehicle in any way
        return None, _left_plain(keys, error)
    finally:
        FUSES.reset(before)
    reasons = {keys[i]: reason for i, reason in graph.used.items()}
    return TracedAssembly(graph, keys, tuple(inputs.values()), assembled, tuple(graph.guards.values()), fixed), reasons


def _left_plain(keys: tuple[str, ...], error: Exception) -> dict[str, str]:
    """The next keys to fix after an error that the assembly of plain numbers may not raise."""
    for table in UNTRACED:
        untraced = [key for key in keys if key.startswith(table)]
        if untraced:
            return dict.fromkeys(untraced, f"is read by code that cannot be traced: {type(error).__name__}: {error}")
    raise error


def with_values(value: Any, graph: ValuedGraph) -> Any:
    """A value of the same types with the numbers that its symbols have in the traced mission."""
    if isinstance(value, Symbol):
        return float(graph.values[value.node])
    if is_value(value):
        return type(value)(*[with_values(part, graph) for part in value])
    if isinstance(value, np.ndarray) and value.dtype == object:
        return np.array([float(with_values(x, graph)) for x in value.flat]).reshape(value.shape)
    return value


def assembled_by_graph(mission: Mission, build: Callable[[Mission], Any]) -> Any:
    """The result of `build` for a mission; if it is not fused, of its graph: bit-identical on every machine."""
    if mission.mission.fma:
        return build(mission)
    traced = trace_assembly(mission, build)
    return with_values(traced.assembled, traced.graph)


# ---- The numbers of a mission by their dotted keys, as `--set` takes them, and a mission with other numbers or symbols


def numbers_of_mission(mission: BaseModel) -> dict[str, float]:
    """Every real number that a mission's tables hold, by its key; each entry of a list has its own."""
    return {dotted(place): value for place, value in _leaves(mission, ()) if type(value) is float}


def counts_of_mission(mission: BaseModel) -> dict[str, int]:
    """Every whole number that a mission's tables hold, by its key."""
    return {dotted(place): value for place, value in _leaves(mission, ()) if type(value) is int}


def _leaves(value: Any, place: Place) -> Iterator[tuple[Place, Any]]:
    for part, inner in _parts(value):
        yield from _leaves(inner, (*place, part))
    if not isinstance(value, (BaseModel, tuple, list, Mapping)):
        yield place, value


def _parts(value: Any) -> Iterator[tuple[str | int, Any]]:
    """The parts of a table or a list with their names or numbers."""
    if isinstance(value, BaseModel):
        yield from ((name, getattr(value, name)) for name in type(value).model_fields)
    elif isinstance(value, (tuple, list)):
        yield from enumerate(value)
    elif isinstance(value, Mapping):
        yield from value.items()


def with_numbers(value: T, numbers: Mapping[str, Any], place: Place = ()) -> T:
    """The mission with other values for some of its numbers, which are not checked and may be symbols."""
    old = dict(_parts(value))
    if not old:
        return numbers.get(dotted(place), value) if place else value
    new = {part: with_numbers(inner, numbers, (*place, part)) for part, inner in old.items()}
    changed: dict[Any, Any] = {part: inner for part, inner in new.items() if inner is not old[part]}
    if not changed:
        return value
    if isinstance(value, BaseModel):
        return value.model_copy(update=changed)
    return dict(new) if isinstance(value, Mapping) else type(value)(new.values())  # type: ignore[return-value, call-arg]
