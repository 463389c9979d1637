"""The pilot alone, compiled: a measurement in, rotor thrusts out."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.compiler.machine_code.code import Code, Written
from tandemlift.compiler.machine_code.store import key_of
from tandemlift.compiler.tracer import Function, Module, Place, symbols, tracer, written_out
from tandemlift.core.vector import Absent
from tandemlift.parts.pilot.pilot import PilotMemory, PilotParameters, decide
from tandemlift.parts.rotors.allocation import ConstrainedAllocation
from tandemlift.simulation.blocks.limit_search import write_limits, write_solver
from tandemlift.simulation.preparation.limit_solver import limit_thrusts
from tandemlift.simulation.preparation.traced_step import check_layout, graph_for

POINTERS = ("numbers", "pilot_input", "thrusts", "work")  # words of the context, and behind them the step [s] as bits

MEASURED = 19  # numbers of an input that are measured: state, force and moment


class PilotData(NamedTuple):
    """The pilot's numbers in one array: the samples taken so far, its memory and its parameters."""

    samples: Any
    memory: PilotMemory
    parameters: PilotParameters


class PilotDataState(NamedTuple):
    """The part of `PilotData` that changes."""

    samples: Any
    memory: PilotMemory


class PilotSample(NamedTuple):
    """A decision, and the pilot's memory after it."""

    decision: Any
    memory: PilotMemory


class PilotSampler:
    """A traced sample of a pilot; inputs: `pilot`, `pilot_input`, `dt`, and `solved`, the limit solver's result."""

    def __init__(
        self, onboard: PilotData, pilot_input: Any, quadrotors: int, *, fuses: bool = True, rolls: bool = True
    ) -> None:
        self.graph, trace = graph_for(quadrotors, rolls=rolls), tracer(fuses)
        pilot, dt = self.graph.inputs("pilot", onboard), self.graph.input("dt")
        t = pilot.samples * dt
        given = self.graph.inputs("pilot_input", pilot_input)
        decided = PilotSample(*trace(decide)(pilot.parameters, pilot.memory, given, t, dt))
        self.limits = None
        self.refuses = isinstance(getattr(onboard.parameters.guidance, "supervision", Absent()), Absent)
        if isinstance(onboard.parameters.allocation, ConstrainedAllocation):
            self.limits, *within = limit_thrusts(self.graph, trace, pilot.parameters, pilot.memory, decided, t)
            decided = PilotSample(*within)
        self.thrusts = symbols(self.graph, decided.decision.thrusts)
        after = PilotDataState(pilot.samples + 1.0, decided.memory)
        check_layout(pilot.parameters.controller, PilotDataState(onboard.samples, onboard.memory), written_out(after))
        self.after = symbols(self.graph, after)

    def written(self) -> Written:
        """The function `sample`, whose argument is a context of `POINTERS`; it returns 1 for a refused measurement."""
        module = Module()
        if self.limits:
            write_solver(module, self.limits.solver, 1)
        f = Function(module, self.graph, 1, "i64 @sample(ptr %c) #0")
        for i, word in enumerate(POINTERS):
            f.lines.append(f"  %{word} = load ptr, ptr {f.at('%c', i, 'i64')}, align 8")
        dt = f.load("%c", len(POINTERS), "double")
        solved = len(self.limits.problem) if self.limits else 0
        f.read = {
            "pilot": lambda i: Place("%numbers", i),
            "pilot_input": lambda i: Place("%pilot_input", i),
            "dt": lambda i: dt,
            "solved": lambda i: Place("%work", solved + i),
        }
        if self.refuses:
            write_refusal(f)
        if self.limits:
            write_limits(f, self.limits, 0)
        f.values(self.after)
        f.put("%thrusts", 0, self.thrusts)
        f.put("%numbers", 0, self.after, "pilot")
        f.end("i64 0")
        size = solved + len(self.limits.search) if self.limits else 1
        return Written(module.text, {"size": size})


def write_refusal(f: Function) -> None:
    """Return without a sample if a number of the measurement is not finite: its memory would never be again."""
    total = "0.0"
    for i in range(MEASURED):
        zero = f.op(f"fmul double {f.load('%pilot_input', i)}, 0.0")  # or NaN
        total = f.op(f"fadd double {total}, {zero}")
    wrong = f.op(f"fcmp une double {total}, 0.0")
    f.do(f"br i1 {wrong}, label %refused, label %taken")
    f.lines += ["refused:", "  ret i64 1", "taken:"]


def pilot_code(start: PilotData, pilot_input: Any, quadrotors: int, *, fuses: bool) -> Code:
    """The machine code of the function `sample` of a pilot, traced only if none is on disk."""

    def written() -> Written:
        return PilotSampler(start, pilot_input, quadrotors, fuses=fuses).written()

    return Code(key_of(start, "sample", fuses), ["sample"], written)
