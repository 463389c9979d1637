"""The common base of the functions of a flight's loop: traced step, scratch memory, arguments, context's words.

And what they write at the end of a step: the next state, a row of the log, metrics and detectors.
"""

from __future__ import annotations

from tandemlift.compiler.tracer import Function, Module, Place, Symbol, double
from tandemlift.core.types import leaves
from tandemlift.simulation.preparation.external_inputs import HALVES, SPAN
from tandemlift.simulation.preparation.memory import AT, MEMORY, POINTERS, ScratchLayout
from tandemlift.simulation.preparation.templates import LeafSpan, delayed_spans, leaf_offset
from tandemlift.simulation.preparation.traced_step import Symbols, TracedStep

UNIFORM = ("dt",)
ARGUMENTS = "ptr %c, ptr %flight, ptr %work"


class StepWriter:
    """The common base of the functions of a flight's loop: traced step, scratch memory, writing of functions.

    Args:
        traced: the graph of a step.
        lanes: flights that one instruction serves: 1, or LANES for a block.
        largest: operations of a function, about, where a step is cut into several; 0 for a step in one function.
        draw_lanes: steps that one instruction draws random numbers for, in a flight alone: a power of two up to SPAN.
    """

    def __init__(self, traced: TracedStep, lanes: int, draw_lanes: int = 8, largest: int = 0) -> None:
        self.traced, self.templates, self.graph, self.lanes = traced, traced.templates, traced.graph, lanes
        self.module, self.scratch, self.draw_lanes, self.largest = Module(), ScratchLayout(), draw_lanes, largest
        self.moves_body = True
        self.width, self.draws = leaves(self.templates.given.hand.start), 0
        self.state_size = leaves(self.templates.model.flight_state)
        self.vector = "double" if lanes == 1 else f"<{lanes} x double>"
        self.delayed = delayed_spans(self.templates.model)
        self.ended = leaf_offset(self.templates.model, "flight_state", "ended").at
        self.touches = leaf_offset(self.templates.model, "flight_state", "touches")
        self.moved_touches = leaf_offset(self.templates.moved, "touches").at
        g, roots = self.graph, [s.node for s in self.all_roots]
        self.has_gusts = any(g.ops[n] == "in" and g.args[n][0] == "gust" for n in g.needed(roots))
        self._lay_out_scratch()

    @property
    def all_roots(self) -> Symbols:
        """Every value that a step computes."""
        x = self.traced
        end = [*x.next_state, *x.sample, *self.body_roots(), *self.limit_roots()]
        return [*end, *x.asked, *x.body.acting, *x.body.push]

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
        self.push, self.moved = take("push", 6), take("moved", leaves(x.moved))
        needs = self.traced.limits
        self.solving = take("solving", len(needs.problem) + len(needs.search) if needs else 0)
        self.sample = take("sample", leaves(x.sample) if self.lanes > 1 else 0)
        self.low, self.near, self.due = take("low", 1), take("near", 1), take("due", 1)
        in_block = int(self.lanes > 1)
        self.begun, self.halts = take("begun", in_block), take("halts", in_block)

    def function(self, name: str, more: str = "", result: str = "void") -> Function:
        """An internal function whose arguments are the context %c, the flight, the scratch memory, and `more`."""
        head = f"internal {result} @{name}({MEMORY}{more}) #1"
        f = Function(self.module, self.graph, self.lanes, head, UNIFORM)
        f.lines.append(f"  %dt = load double, ptr {f.at('%c', AT['dt'], 'i64')}, align 8")
        f.sets.room = self.scratch_place
        f.read = {"fly": lambda i: Place("%flight", i), "dt": lambda i: "%dt"}
        return f

    def export(self, name: str) -> None:
        """A function for Python, with the context as its only argument, that calls the internal one of that name."""
        f = Function(self.module, self.graph, self.lanes, f"i64 @{name}(ptr %c) #0")
        given = [f"ptr {self.context_word(f, word)}" for word in ("flight", "work")]
        f.end("i64 " + f.op(f"call i64 @{name}_({', '.join(['ptr %c', *given])})"))

    def scratch_place(self, count: int) -> Place:
        """Scratch memory for a set of `count` numbers."""
        return Place("%work", self.scratch.take(f"room_{self.scratch.size}", count))

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
        begun = f.load("%work", self.begun, kind)
        if times > 1:
            begun = f.op(f"mul {kind} {begun}, splat (i64 {times})")
        return f.op(f"sub {kind} {f.spread(k, 'i64')}, {begun}")

    def time(self, f: Function, k: str, times: int = 1) -> str:
        """The time of step k, or of a part of it: k of `times` as many."""
        counted = self.own(f, k, times)
        step = "%dt" if times == 1 else f.op(f"fmul double %dt, {double(1.0 / times)}")
        number = f.op(f"sitofp {'i64' if self.lanes == 1 else f'<{self.lanes} x i64>'} {counted} to {f.vector}")
        return f.op(f"fmul {f.vector} {number}, {f.spread(step)}")

    def is_halted(self, f: Function, flight: str = "%flight", work: str = "%work") -> str:
        """Whether a flight has ended, so that no further step may be taken; in a block, one of those that halt it."""
        truths = [(flight, self.ended), (work, self.halts)][: 1 + (self.lanes > 1)]
        zero = "0.0" if self.lanes == 1 else "zeroinitializer"
        held = [f.op(f"fcmp une {self.vector} {f.load(*place, self.vector)}, {zero}") for place in truths]
        if self.lanes == 1:
            return held[0]
        both = f.op(f"and <{self.lanes} x i1> {held[0]}, {held[1]}")
        return f.op(f"icmp ne i8 {f.op(f'bitcast <{self.lanes} x i1> {both} to i{self.lanes}')}, 0")

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

    def store_values(self, f: Function, at: int, values: Symbols) -> None:
        """Write values to scratch memory."""
        f.put("%work", at, values)

    @property
    def keeps_touches(self) -> bool:
        """Whether the record of touches stays in its place except in steps near floor or walls."""
        return bool(self.moves_body and self.touches.size and self.traced.body_in_free_air)

    def body_roots(self) -> Symbols:
        """The values of the body after the step in all its forms, and the conditions that select among them."""
        x = self.traced
        bodies = [*x.body_in_contact, *x.body_on_feet, *x.body_in_free_air]
        return [*bodies, *x.may_touch_walls, *x.may_touch_hull]

    def limit_roots(self) -> Symbols:
        """The values that the limit solver needs; none where thrusts have no limits."""
        needs = self.traced.limits
        return [needs.beyond, *needs.problem, *needs.plain, *needs.search] if needs else []


COMMAND_LINE = 2  # the delay line of the rotor commands: without delay, a command acts in its own step


def write_sample(step: StepWriter, f: Function, k: str) -> None:
    """Write the sample of step k into the log, if one is due, and the last sample where Python reads it."""
    every, steps = step.context_word(f, "every"), step.context_word(f, "steps")
    past = f.integer("sub", k, step.context_word(f, "since"))
    row = f.integer("sdiv", past, every)
    logged = f.op(f"icmp eq i64 {f.integer('mul', row, every)}, {past}")
    final = f.op(f"icmp eq i64 {k}, {steps}")
    due = f.op(f"or i1 {logged}, {final}")
    if step.lanes == 1:
        with f.when(due):
            _write_one_sample(step, f, row, logged, final)
        return
    shown = f.op(f"icmp eq i64 {k}, {step.context_word(f, 'show')}")
    shown = f.op(f"or i1 {shown}, {_halts_now(step, f)}")
    with f.when(f.op(f"or i1 {due}, {shown}")):
        step.store_values(f, step.sample, step.traced.sample)
        with f.when(logged):
            _log_lanes(step, f, row)
        with f.when(shown):
            _show_lanes(step, f)


def _write_one_sample(step: StepWriter, f: Function, row: str, logged: str, final: str) -> None:
    sample = step.traced.sample
    f.values(sample)
    for condition, name, index in ((logged, "log", row), (final, "last", "0")):
        with f.when(condition):
            f.put(f.at(step.context_word(f, name), f.integer("mul", index, len(sample))), 0, sample)


def _halts_now(step: StepWriter, f: Function) -> str:
    """Whether a flight that halts the block ends in this step."""
    before, halts = f.load("%flight", step.ended), f.load("%work", step.halts)
    after = f.value(step.traced.next_state[step.ended])
    ends = [f.op(f"fcmp {c} {f.vector} {x}, {f.zero}") for c, x in (("oeq", before), ("une", after), ("une", halts))]
    truth = f"<{step.lanes} x i1>"
    return f.any(f.op(f"and {truth} {f.op(f'and {truth} {ends[0]}, {ends[1]}')}, {ends[2]}"))


def _log_lanes(step: StepWriter, f: Function, row: str) -> None:
    columns = len(step.traced.sample)
    log, stride = step.context_word(f, "log"), step.context_word(f, "stride")
    with f.repeat(step.lanes) as lane:
        to = f.integer("add", f.integer("mul", lane, stride), f.integer("mul", row, columns))
        with f.repeat(columns) as m:
            at = f.integer("add", f.integer("mul", f.integer("add", m, step.sample), step.lanes), lane)
            f.store(f.load("%work", at, "double"), log, f.integer("add", to, m), "double")


def _show_lanes(step: StepWriter, f: Function) -> None:
    """Write the sample to memory in which number m of all blocks stands together, `apart` numbers after m - 1."""
    shown, apart = step.context_word(f, "shown"), step.context_word(f, "apart")
    with f.repeat(len(step.traced.sample)) as m:
        value = f.load("%work", f.integer("add", m, step.sample))
        f.store(value, f.at(shown, f.integer("mul", m, apart), "double"))


def write_next_state(step: StepWriter, f: Function, k: str) -> None:
    """Write the state of the flight after step k, and exchange delayed values with the delay lines.

    The record of touches is written in steps near floor or walls only; in others it stays.
    """
    after, detectors = list(step.traced.next_state), leaf_offset(step.templates.model, "flight_state", "detectors")
    watches = not step.graph.rolls_from
    if watches:
        after = after[: detectors.at]
    if step.keeps_touches:
        at, size = step.touches
        touches, after[at : at + size] = after[at : at + size], step.traced.touches_before
    if watches:
        f.values([*after, *_read_by_detectors(step, detectors)])
    f.put("%flight", 0, after, "fly")
    if step.keeps_touches:
        near = f.load("%work", step.near * step.lanes, "double")
        with f.when(f.op(f"fcmp one double {near}, 0.0")):
            f.put("%flight", at, touches)
    if watches:
        _write_detectors(step, f, detectors)
    if step.templates.has_delays:
        _write_delays(step, f, k)


def _read_by_detectors(step: StepWriter, at: LeafSpan) -> list[Symbol]:
    """The detectors' inputs from the state before the step, read before the state is written; their counters."""
    g, state = step.graph, step.traced.next_state[at.at : at.at + at.size]
    needed = g.needed([s.node for s in state])
    inputs = [n for n in needed if g.ops[n] == "in" and g.args[n][0] == "fly" and g.args[n][1] < at.at]
    return [*(Symbol(g, n, g.types[n]) for n in inputs), *(state[i] for i in _counters(step))]


def _counters(step: StepWriter) -> list[int]:
    """Places of the numbers of the detectors that change in every step, `awake` first."""
    like = step.templates.model.flight_state.detectors
    spans = [leaf_offset(like, name) for name in like._fields]
    return [span.at for span in spans if span.size == 1]


def _write_detectors(step: StepWriter, f: Function, at: LeafSpan) -> None:
    """Write the memory of the detectors; that of a detector that sleeps before and after the step has not changed."""
    like, state = step.templates.model.flight_state.detectors, step.traced.next_state
    spans = {name: leaf_offset(like, name) for name in like._fields}
    with f.when(_awake(step, f, at.at)):
        for span in spans.values():
            first = at.at + span.at
            if span.size > 1:
                with f.when(_awake(step, f, first)):
                    f.put("%flight", first, state[first : first + span.size])
    for i in _counters(step):
        f.put("%flight", at.at + i, [state[at.at + i]])


def _awake(step: StepWriter, f: Function, at: int) -> str:
    """Whether the number at a place of the state is other than 0 before or after the step, in any lane."""
    kind = f.vector
    zero = double(0.0) if step.lanes == 1 else "zeroinitializer"
    before = f.op(f"fcmp one {kind} {f.load('%flight', at)}, {zero}")
    after = f.op(f"fcmp one {kind} {f.value(step.traced.next_state[at])}, {zero}")
    both = f.op(f"or {'i1' if step.lanes == 1 else f'<{step.lanes} x i1>'} {before}, {after}")
    return f.any(both)


def _write_delays(step: StepWriter, f: Function, k: str) -> None:
    """Write delayed values to row k of the delay line, and read those that arrive for the next step."""
    ring, delays = step.context_word(f, "ring"), step.context_word(f, "delays")
    mask = f.integer("sub", step.context_word(f, "rings"), 1)
    into = f.at(ring, f.integer("mul", f.integer("and", k, mask), step.delayed.size))
    column = 0
    for j, (at, size) in enumerate(step.delayed):
        if not size:
            continue
        arrives = f.integer("add", k, 1) if j == COMMAND_LINE else k
        out = f.integer("and", f.integer("sub", arrives, f.load(delays, j, "i64")), mask)
        for m in range(size):
            f.store(f.load("%flight", at + m), into, column + m)
        since = f.at(ring, f.integer("mul", out, step.delayed.size))
        for m in range(size):
            f.store(f.load(since, column + m), "%flight", at + m)
        column += size
