"""The common base of the functions of a flight's loop: traced step, scratch memory, arguments, context's words.

And what they write at the end of a step: the next state, a row of the log, metrics and detectors.
"""

from __future__ import annotations

from tandemlift.compiler.tracer import LEAVES, Function, Module, Place, Symbol, double
from tandemlift.core.types import leaves
from tandemlift.simulation.preparation.external_inputs import HALVES, SPAN
from tandemlift.simulation.preparation.memory import AT, MEMORY, POINTERS, ScratchLayout
from tandemlift.simulation.preparation.templates import LeafSpan, delayed_spans, leaf_offset
from tandemlift.simulation.preparation.traced_step import Symbols, TracedStep

UNIFORM = ("t", "dt", "when", "opens", "closes", "number", "begins")
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
        self.delayed = delayed_spans(self.templates.model)
        self.touches = leaf_offset(self.templates.model, "flight_state", "touches")
        self.moved_touches = leaf_offset(self.templates.moved, "touches").at
        g, roots = self.graph, [s.node for s in self.all_roots]
        self.has_gusts = any(g.ops[n] == "in" and g.args[n][0] == "gust" for n in g.needed(roots))
        self._lay_out_scratch()

    @property
    def all_roots(self) -> Symbols:
        """Every value that a step computes."""
        x = self.traced
        return [
            *x.next_state,
            *x.sample,
            *self.body_roots(),
            *self.limit_roots(),
            *x.asked,
            *x.body.acting,
            *x.body.push,
        ]

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

    def time(self, f: Function, k: str) -> str:
        """The time of step k."""
        number = f.op(f"sitofp i64 {k} to double")
        return f.op(f"fmul double {number}, %dt")

    @property
    def solved(self) -> int:
        """Offset of the limit solver's result in scratch memory."""
        needs = self.traced.limits
        return self.solving + (len(needs.problem) if needs else 0)

    def store_values(self, f: Function, at: int, values: Symbols) -> None:
        """Write values to scratch memory."""
        f.update("%work", at, values)

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
    with f.when(f.op(f"or i1 {logged}, {final}")):
        if step.lanes == 1:
            _write_one_sample(step, f, row, logged, final)
        else:
            _write_samples_of_lanes(step, f, row, logged)


def _write_one_sample(step: StepWriter, f: Function, row: str, logged: str, final: str) -> None:
    sample = step.traced.sample
    f.values(sample)
    for condition, name, index in ((logged, "log", row), (final, "last", "0")):
        with f.when(condition):
            f.put(f.at(step.context_word(f, name), f.integer("mul", index, len(sample))), 0, sample)


def _write_samples_of_lanes(step: StepWriter, f: Function, row: str, logged: str) -> None:
    columns = len(step.traced.sample)
    step.store_values(f, step.sample, step.traced.sample)
    with f.when(logged):
        log, stride = step.context_word(f, "log"), step.context_word(f, "stride")
        with f.repeat(step.lanes) as lane:
            to = f.integer("add", f.integer("mul", lane, stride), f.integer("mul", row, columns))
            with f.repeat(columns) as m:
                at = f.integer("add", f.integer("mul", f.integer("add", m, step.sample), step.lanes), lane)
                f.store(f.load("%work", at, "double"), log, f.integer("add", to, m), "double")


def _numbers_of_each_step(step: StepWriter) -> Symbols:
    """The numbers of the next state that every step writes: not those of detectors, nor touches, which stay."""
    after = list(step.traced.next_state)
    if not step.graph.rolls_from:
        after = after[: leaf_offset(step.templates.model, "flight_state", "detectors").at]
    if step.keeps_touches:
        at, size = step.touches
        after[at : at + size] = step.traced.touches_before
    return after


def write_early(step: StepWriter, f: Function, more: Symbols, done: set[int], *unknown: str) -> None:
    """Compute `more`, and write the numbers of the next state that need no `unknown` kind of input; see `update`."""
    f.update("%flight", 0, _numbers_of_each_step(step), "fly", more, done, step.all_roots, unknown)


def write_next_state(step: StepWriter, f: Function, k: str, done: set[int] | None = None) -> None:
    """Write the state of the flight after step k, and exchange delayed values with the delay lines.

    The record of touches is written in steps near floor or walls only; in others it stays. `done`: numbers written
    already.
    """
    after, detectors = _numbers_of_each_step(step), leaf_offset(step.templates.model, "flight_state", "detectors")
    watches = not step.graph.rolls_from
    read = _read_by_detectors(step, f, [s.node for s in after], detectors) if watches else []
    if f.orders:
        f.hold(s.node for s in read if step.graph.ops[s.node] == "in" and s.node not in f.same)
    f.update("%flight", 0, after, "fly", read, done)
    if step.keeps_touches:
        near = f.load("%work", step.near * step.lanes, "double")
        with f.when(f.op(f"fcmp one double {near}, 0.0")):
            at, size = step.touches
            f.put("%flight", at, step.traced.next_state[at : at + size])
    if watches:
        _write_detectors(step, f, detectors)
    if step.templates.has_delays:
        _write_delays(step, f, k)


def _read_by_detectors(step: StepWriter, f: Function, roots: list[int], at: LeafSpan) -> list[Symbol]:
    """The detectors' inputs from the state before the step, read before the state is written; their counters.

    `roots`: of the state that is written before; what it needs is known to the detectors, but in a block no input.
    """
    g, state = step.graph, step.traced.next_state[at.at : at.at + at.size]
    counters = [state[i] for i in _counters(step)]
    early = set(g.needed([*roots, *(s.node for s in counters)])) if f.orders else set()
    known = {n for n in early if g.ops[n] not in LEAVES} | f.known() if f.orders else ()
    inputs = [n for n in g.needed([s.node for s in state], known) if g.ops[n] == "in"]
    old = [n for n in inputs if g.args[n][0] == "fly" and (g.args[n][1] < at.at or n in early)]
    return [*(Symbol(g, n, g.types[n]) for n in (*old, *f.same.keys() & set(inputs))), *counters]


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
