"""The common base of the functions of a flight's loop: traced step, scratch memory, arguments, context's words."""

from __future__ import annotations

import functools
from collections.abc import Iterable

from tandemlift.compiler.tracer import Function, Module, Place, ScratchLayout, double
from tandemlift.core.types import leaves
from tandemlift.simulation.loop.external_inputs import HALVES, SPAN
from tandemlift.simulation.loop.random_numbers import MASK
from tandemlift.simulation.loop.sources import HeldPart, delayed_spans, held_parts, leaf_offset
from tandemlift.simulation.preparation.memory import AT, MEMORY, POINTERS
from tandemlift.simulation.preparation.traced_step import Symbols, TracedStep

ARGUMENTS = "ptr %c, ptr %flight, ptr %work"


class StepWriter:
    """The common base of the functions of a flight's loop: traced step, scratch memory, writing of functions.

    Args:
        traced: the graph of a step.
        lanes: flights that one instruction serves: 1, or LANES for a block.
        largest: operations of a function, about, where a step is cut into several; 0 for a step in one function.
        alike: numbers of a flight that are equal in all lanes.
        draw_lanes: steps that one instruction draws random numbers for, in a flight alone: a power of two up to SPAN.
    """

    def __init__(
        self, traced: TracedStep, lanes: int, draw_lanes: int = 8, largest: int = 0, alike: Iterable[int] = ()
    ) -> None:
        self.traced, self.templates, self.graph, self.lanes = traced, traced.templates, traced.graph, lanes
        self.module, self.scratch, self.draw_lanes, self.largest = Module(), ScratchLayout(), draw_lanes, largest
        self.moves_body, self.machine_words, self.uniform = True, 0, ("dt", *[("fly", i) for i in alike])
        self.width, self.draws = leaves(self.templates.given.hand.start), 0
        self.held, self.drawn, self.fresh = list[HeldPart](), dict[int, int](), dict[int, str]()
        self.state_size = leaves(self.templates.model.flight_state)
        self.real, self.numbers = traced.graph.real, leaves(self.templates.model)
        self.vector = self.real if lanes == 1 else f"<{lanes} x {self.real}>"
        self.delayed = delayed_spans(self.templates.model)
        self.ended = leaf_offset(self.templates.model, "flight_state", "ended").at
        self.touches = leaf_offset(self.templates.model, "flight_state", "touches")
        self.moved_touches, self.moved_end = (
            leaf_offset(self.templates.moved, "touches").at,
            leaves(self.templates.moved),
        )
        g, roots = self.graph, [s.node for s in self.all_roots]
        self.has_gusts = any(g.ops[n] == "in" and g.args[n][0] == "gust" for n in g.needed(roots))
        self._lay_out_scratch()

    @property
    def all_roots(self) -> Symbols:
        """Every value that a step computes."""
        x = self.traced
        end = [*x.next_state, *x.rests, *x.sample, *self.body_roots(), *self.limit_roots()]
        return [*end, *x.asked, *x.body.acting, *x.body.push]

    def hold_parts(self) -> None:
        """Compute the held parts of the state, and what serves only them, in no other steps than theirs."""
        if self.graph.rolls_from or self.largest:
            return
        self.held = held_parts(self.templates.model, self.templates.given.noise)
        for part in self.held if self.lanes == 1 else []:  # number i of draw j of a vector of `lanes` of them
            draws, lanes = self.draws_of(part), self.lanes_of(part)
            first = self.scratch.take("drawn_", 4 * lanes * -(-len(draws) // lanes))
            for leaf in range(part.noise.at, part.noise.at + part.noise.size):
                vector, lane = divmod(draws.index(leaf // 4), lanes)
                self.drawn[leaf] = first + (4 * vector + leaf % 4) * lanes + lane

    @staticmethod
    def draws_of(part: HeldPart) -> list[int]:
        """The draws, of four random numbers each, that a held part needs."""
        return list(range(part.noise.at // 4, -(-(part.noise.at + part.noise.size) // 4))) if part.noise.size else []

    def lanes_of(self, part: HeldPart) -> int:
        """Draws of a held part that one instruction makes, in a flight alone."""
        return min(self.draw_lanes, 1 << (len(self.draws_of(part)) - 1).bit_length())

    @property
    def free_draws(self) -> list[int]:
        """The draws that are needed in every step: all but those of held parts alone."""
        only = {i for part in self.held for i in range(part.noise.at, part.noise.at + part.noise.size)}
        total = leaves(self.templates.given.noise)
        return [i for i in range(self.draws) if any(j not in only for j in range(4 * i, min(4 * i + 4, total)))]

    def unless_held(self, values: Symbols, written: HeldPart | None = None) -> Symbols:
        """Numbers of the next state, those of held parts as they were; only those of one part where it is given."""
        kept = [i for part in self.held for i in (*part.places, *part.copies)]
        if written:
            kept = sorted(set(range(len(values))) - set(written.places))
        values = list(values)
        for i in kept:
            values[i] = self.graph.input("fly", i)
        return values

    @property
    def words(self) -> int:
        """Places that a double, or an integer, takes beside floats; 0 beside doubles."""
        return 0 if self.real == "double" else 2

    def _lay_out_scratch(self) -> None:
        x, take = self.templates, self.scratch.take
        self.pushes_at = take("hands", HALVES * self.width)
        self.draws = len(self.traced.normals)
        self.noise = take("noise", 4 * self.draws * (SPAN if self.lanes == 1 else 1))
        self.gust = take("gust", 3)
        self.asked, self.answer = take("asked", len(self.traced.asked)), take("answer", 4 + 3)
        self.acting = take("acting", len(self.traced.body.acting))
        self.external = take("external", leaves(x.given.external))
        self.outside = take("outside", leaves(x.given.outside))
        self.push, self.moved = take("push", 6), take("moved", len(self.traced.body_in_contact))
        needs = self.traced.limits
        solving = len(needs.problem) + len(needs.search) if needs else 0
        self.solving, self.exact = take("solving", solving), take("exact", solving * self.words)
        self.sample = take("sample", leaves(x.sample) if self.lanes > 1 else 0)
        self.low, self.near, self.due = take("low", 1), take("near", 1), take("due", 1)
        in_block = int(self.lanes > 1)
        self.begun, self.halts = take("begun", in_block * (1 + self.words // 2)), take("halts", in_block)

    def function(self, name: str, more: str = "", result: str = "void", attributes: str = "#1") -> Function:
        """An internal function whose arguments are the context %c, the flight, the scratch memory, and `more`."""
        head = f"internal {result} @{name}({MEMORY}{more}) {attributes}"
        f = Function(self.module, self.graph, self.lanes, head, self.uniform)
        f.lines.append(f"  %dt = load double, ptr {f.at('%c', AT['dt'], 'i64')}, align 8")
        f.sets.room = lambda count: Place("%work", self.scratch.take(f"room_{self.scratch.size}", count))
        f.read = {"fly": lambda i: Place("%flight", i), "rest": lambda i: Place("%flight", self.numbers + i)}
        step = "%dt" if self.real == "double" else f.op("fptrunc double %dt to float")
        f.read["dt"] = lambda i: step
        return f

    def export(self, name: str) -> None:
        """A function for Python, with the context as its only argument, that calls the internal one of that name."""
        f = Function(self.module, self.graph, self.lanes, f"i64 @{name}(ptr %c) #0")
        given = [f"ptr {self.context_word(f, word)}" for word in ("flight", "work")]
        with f.without_tiny_numbers():
            result = f.op(f"call i64 @{name}_({', '.join(['ptr %c', *given])})")
        f.end(f"i64 {result}")

    def bind_draw(self, f: Function, keys: str, number: str) -> None:
        """Bind step `number` and the key of each flight's random numbers in a block, as integers of 32 bits."""
        exact, whole = (f"<{self.lanes} x {kind}>" for kind in ("double", "i64"))
        found = [f.op(f"fptosi {exact} {f.load(keys, m, exact)} to {whole}") for m in (0, 1)]
        # the mask tells LLVM how many bits they have
        now, *words = [f.op(f"and {whole} {x}, splat (i64 {MASK})") for x in (number, *found)]
        f.read = {"number": lambda m: now, "key": words.__getitem__}
        if self.real == "double":  # where the graph has the words as doubles
            g = self.graph
            rounded = [g.node("fptosi", (g.input("key", m).node,), "i") for m in (0, 1)]
            f.kept |= {node: functools.partial(words.__getitem__, m) for m, node in enumerate(rounded)}

    def call(self, f: Function, name: str, *more: str) -> None:
        """Call another internal function."""
        f.do(f"call void @{name}({', '.join([ARGUMENTS, *more])})")

    def context_word(self, f: Function, name: str) -> str:
        """A word of the context; words have 64 bits, also where addresses have 32."""
        kind = "ptr" if name in POINTERS else "i64"
        return f.op(f"load {kind}, ptr {f.at('%c', AT[name], 'i64')}, align 8")

    def own(self, f: Function, k: str, times: int = 1) -> str:
        """The number of a step of the loop in each flight's own count; `times`: of both, such as 2 for half steps."""
        if self.lanes == 1:
            return k
        kind = f"<{self.lanes} x i64>"
        begun = f.load(f.at("%work", self.begun), 0, kind)
        if times > 1:
            begun = f.op(f"mul {kind} {begun}, splat (i64 {times})")
        return f.op(f"sub {kind} {f.spread(k, 'i64')}, {begun}")

    def time(self, f: Function, k: str, times: int = 1) -> str:
        """The time of step k, or of a part of it: k of `times` as many."""
        counted = self.own(f, k, times)
        step = "%dt" if times == 1 else f.op(f"fmul double %dt, {double(1.0 / times)}")
        words, exact = (kind if self.lanes == 1 else f"<{self.lanes} x {kind}>" for kind in ("i64", "double"))
        number = f.op(f"sitofp {words} {counted} to {exact}")
        time = f.op(f"fmul {exact} {number}, {f.spread(step, 'double')}")
        return time if exact == f.vector else f.op(f"fptrunc {exact} {time} to {f.vector}")

    def is_halted(self, f: Function, flight: str = "%flight", work: str = "%work") -> str:
        """Whether a flight has ended, so that no further step may be taken; in a block, one of those that halt it."""
        truths = [(flight, self.ended), (work, self.halts)][: 1 + (self.lanes > 1)]
        zero = "0.0" if self.lanes == 1 else "zeroinitializer"
        held = [f.op(f"fcmp une {self.vector} {f.load(*place, self.vector)}, {zero}") for place in truths]
        if self.lanes == 1:
            return held[0]
        both = f.op(f"and <{self.lanes} x i1> {held[0]}, {held[1]}")
        return f.op(f"icmp ne i{self.lanes} {f.op(f'bitcast <{self.lanes} x i1> {both} to i{self.lanes}')}, 0")

    def begins_span(self, f: Function, k: str) -> str:
        """Whether step k begins a span of each flight."""
        if self.lanes == 1:
            return f.op(f"icmp eq i64 {f.integer('and', k, SPAN - 1)}, 0")
        kind = f"<{self.lanes} x i64>"
        in_span = f.op(f"and {kind} {self.own(f, k)}, splat (i64 {SPAN - 1})")
        return f.op(f"icmp eq {kind} {in_span}, zeroinitializer")

    @property
    def solved(self) -> int:
        """Offset of the limit solver's result in scratch memory."""
        needs = self.traced.limits
        return self.solving + (len(needs.problem) if needs else 0)

    @property
    def keeps_touches(self) -> bool:
        """Whether the record of touches stays in its place except in steps near floor or walls."""
        return bool(self.moves_body and self.touches.size and self.traced.body_in_free_air)

    def body_roots(self) -> Symbols:
        """The values of the body after the step in all forms, and what selects among them; elsewhere, its inputs."""
        x = self.traced
        if not self.moves_body:
            return [*x.body.acting, *x.body.push]
        bodies = [*x.body_in_contact, *x.body_on_feet, *x.body_in_free_air]
        return [*bodies, *x.may_touch_walls, *x.may_touch_hull]

    def limit_roots(self) -> Symbols:
        """The values that the limit solver needs; none where thrusts have no limits."""
        return self.traced.limits.symbols if self.traced.limits else []
