"""What a flight's loop writes at the end of a step: the next state, a row of the log, metrics and detectors."""

from __future__ import annotations

import functools

from tandemlift.compiler.tracer import LEAVES, Function, Place, Symbol
from tandemlift.simulation.loop.sources import HeldPart, LeafSpan, leaf_offset
from tandemlift.simulation.preparation.step_writer import StepWriter
from tandemlift.simulation.preparation.traced_step import Symbols

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
    with f.when(f.op(f"or i1 {due}, {shown}")):  # never logged and shown at once
        log, show = (f.at("%work", step.sample), "1"), (step.context_word(f, "shown"), step.context_word(f, "apart"))
        base, stride = (
            f.op(f"select i1 {shown}, {kind} {b}, {kind} {a}")
            for kind, a, b in zip(("ptr", "i64"), log, show, strict=True)
        )
        f.update(base, 0, step.traced.sample, stride=stride)
        with f.when(logged):
            _log_lanes(step, f, row)


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
            value = f.load("%work", at, f.real)
            value = value if f.real == "double" else f.op(f"fpext float {value} to double")
            f.store(value, log, f.integer("add", to, m), "double")


def _numbers_of_each_step(step: StepWriter) -> Symbols:
    """The numbers of the next state that every step writes: not those of detectors, nor touches, which stay."""
    after = list(step.traced.next_state)
    if not step.graph.rolls_from:
        after = after[: leaf_offset(step.templates.model, "flight_state", "detectors").at]
    if step.keeps_touches:
        at, size = step.touches
        after[at : at + size] = step.traced.touches_before
    return step.unless_held(after)


def write_estimates(step: StepWriter, f: Function) -> None:
    """Write the estimates if a sample has come in any lane."""
    for part in step.held:
        if not part.noise.size:
            write_held(step, f, "0", part)


def write_held(step: StepWriter, f: Function, k: str, part: HeldPart) -> None:
    """Write the numbers of a held part if one of its steps has come in any lane; from then on they are read there."""
    after, number = step.traced.next_state, step.held.index(part)
    step.fresh[number] = f.any(f.op(f"fcmp une {f.vector} {f.value(after[part.fresh])}, {f.zero}"))
    held = {after[i].node: i for i in part.places}
    read = step.graph.needed([s.node for s in step.all_roots], held.keys() | f.known() | f.kept.keys())
    own = {step.graph.input("fly", i).node for i in part.places}
    f.hold(node for node in read if node in own)
    with f.when(step.fresh[number]):
        if part.noise.size:
            step.call(f, f"draw_noise{number}", f"i64 {k}")
        f.update("%flight", 0, step.unless_held(after, part), "fly")
    f.kept |= {node: functools.partial(Place, "%flight", i) for node, i in held.items()}


def write_early(step: StepWriter, f: Function, more: Symbols, done: set[int], *unknown: str) -> None:
    """Compute `more`, and write the numbers of the next state that need no `unknown` kind of input; see `update`."""
    noise = ("noise",) if step.held else ()  # of held parts, drawn later
    f.update("%flight", 0, _numbers_of_each_step(step), "fly", more, done, step.all_roots, (*unknown, *noise))


def write_next_state(step: StepWriter, f: Function, k: str, done: set[int] | None = None) -> None:
    """Write the state of the flight after step k, and exchange delayed values with the delay lines.

    The record of touches is written in steps near floor or walls only; in others it stays. `done`: numbers written
    already.
    """
    after, detectors = _numbers_of_each_step(step), leaf_offset(step.templates.model, "flight_state", "detectors")
    watches, held = not step.graph.rolls_from, [part for part in step.held if part.noise.size]
    for part in held:
        write_held(step, f, k, part)
    read = _read_by_detectors(step, f, [s.node for s in after], detectors) if watches else []
    if f.orders:
        f.hold(s.node for s in read if step.graph.ops[s.node] == "in" and s.node not in f.same)
    f.update("%flight", 0, after, "fly", [*read, *step.traced.rests], done)
    if step.traced.rests:
        f.put("%flight", step.numbers, step.traced.rests)
    if step.keeps_touches:
        near = f.load("%work", step.near * step.lanes, f.real)
        with f.when(f.op(f"fcmp one {f.real} {near}, 0.0")):
            at, size = step.touches
            f.put("%flight", at, step.traced.next_state[at : at + size])
    if watches:
        _write_detectors(step, f, detectors)
    for part in held:
        with f.when(step.fresh[step.held.index(part)]):
            for to, of in part.copies.items():
                f.store(f.load("%flight", of), "%flight", to)
    if step.templates.has_delays:
        _write_delays(step, f, k)


def _read_by_detectors(step: StepWriter, f: Function, roots: list[int], at: LeafSpan) -> list[Symbol]:
    """The detectors' inputs from the state before the step, read before the state is written; their counters.

    `roots`: of the state that is written before; what it needs is known to the detectors, but in a block no input.
    """
    g, state = step.graph, step.traced.next_state[at.at : at.at + at.size]
    counters = [state[i] for i in _counters(step)]
    early = set(g.needed([*roots, *(s.node for s in counters)])) if f.orders else set()
    known = {n for n in early if g.ops[n] not in LEAVES} | f.known() if f.orders else set[int]()
    known |= {step.traced.next_state[i].node for part in step.held for i in part.places}
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
    before = f.op(f"fcmp one {kind} {f.load('%flight', at)}, {f.zero}")
    after = f.op(f"fcmp one {kind} {f.value(step.traced.next_state[at])}, {f.zero}")
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
