"""The LLVM text of a mission's module: its loop over steps, the ramps of its numbers, and functions of values.

    prepare(numbers, prepared, work) → 0, or 1 + …               see `prepare`
    fly(context) → the step reached                              as `LoopCode.loop`
    ramp(flight, before, after, active, first, count, k, begin, steps) → 1 while the ramp goes on
    NAME(x, y) → 0                                               y = function(x), numbers one after another

Addresses are those of the machine; the loop takes them from 64-bit words of its context.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from tandemlift.compiler.machine_code.functions import results_of
from tandemlift.compiler.tracer import Function, Graph, Module, Place, double, rounded_twice
from tandemlift.core.types import leaves
from tandemlift.simulation.preparation.compiled_flight import LoopCode
from tandemlift.simulation.preparation.loops import LoopWriter


class ValuesFunction(NamedTuple):
    """A function of values: its name in the module, its computation, and values laid out like its arguments."""

    name: str
    function: Callable[..., Any]
    likes: tuple[Any, ...]

    @property
    def width(self) -> int:
        """Numbers of all arguments together."""
        return sum(map(leaves, self.likes))


def write_flight_loop(loop_code: LoopCode, draw_lanes: int, largest: int) -> LoopWriter:
    """The loop for one flight, whose module goes on to grow; arguments as for `StepWriter`."""
    writer = LoopWriter(loop_code.traced, 1, draw_lanes, largest)
    writer.write_loop()
    return writer


def write_values_function(module: Module, wanted: ValuesFunction) -> int:
    """Add a function of values to a module; return the number of its results."""
    graph = Graph()
    found = results_of(graph, rounded_twice(wanted.function), wanted.likes)
    f = Function(module, graph, 1, f"i64 @{wanted.name}(ptr %x, ptr %y) #0")
    f.read["x"] = lambda i: Place("%x", i)
    f.put("%y", 0, found)
    f.end("i64 0")
    return len(found)


def write_flight_module(
    loop_code: LoopCode, draw_lanes: int, largest: int, functions: Sequence[ValuesFunction]
) -> tuple[LoopWriter, dict[str, tuple[int, int]]]:
    """The loop, the ramp and further functions in one module; of these, by name, numbers of arguments and results."""
    loop = write_flight_loop(loop_code, draw_lanes, largest)
    write_ramp(loop.module)
    return loop, {f.name: (f.width, write_values_function(loop.module, f)) for f in functions}


RAMP = (
    "i64 @ramp(ptr %flight, ptr %before, ptr %after, ptr %active, i64 %first, i64 %count, i64 %k, i64 %begin, "
    "i64 %steps) #0"
)


def write_ramp(module: Module) -> None:
    """Add the ramp of a flight's numbers at step k, as in `simulation.parameter_changes.ParameterRamp`.

    Numbers i from `first` to `count` − 1 with active[i] = 1 go in a straight line from before[i], at step `begin`, to
    after[i], `steps` later; they jump where an end is not finite.
    """
    f = Function(module, Graph(), 1, RAMP)
    passed = f.op(f"sitofp i64 {f.integer('add', f.integer('sub', '%k', '%begin'), 1)} to double")
    share = f.op(f"fdiv double {passed}, {f.op('sitofp i64 %steps to double')}")
    goes_on = f.op(f"fcmp olt double {share}, {double(1.0)}")
    with f.repeat("%count", "%first") as i, f.when(f.op(f"fcmp one double {f.load('%active', i)}, {double(0.0)}")):
        before, after = f.load("%before", i), f.load("%after", i)
        part = f.op(f"fmul double {f.op(f'fsub double {after}, {before}')}, {share}")
        value = f.op(f"fadd double {before}, {part}")
        finite = f.op(f"and i1 {_is_finite(f, before)}, {_is_finite(f, after)}")
        between = f.op(f"and i1 {goes_on}, {finite}")
        f.store(f.op(f"select i1 {between}, double {value}, double {after}"), "%flight", i)
    f.end("i64 " + f.op(f"zext i1 {goes_on} to i64"))


def _is_finite(f: Function, x: str) -> str:
    """Whether x − x is 0, which is true for finite numbers only."""
    return f.op(f"fcmp oeq double {f.op(f'fsub double {x}, {x}')}, {double(0.0)}")
