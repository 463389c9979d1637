"""The loop over the steps of a flight, written once: for one flight, for a block of them, and cut into parts.

A step is cut where another has its say: a controller in Python, or a body in another engine. What a part leaves to the
next waits in memory. What does not change within a flight is computed before its first step and waits there too.
"""

from __future__ import annotations

from tandemlift.kernels.context import AT, MEMORY, POINTERS, ScratchLayout
from tandemlift.kernels.external_inputs import HALVES, SPAN
from tandemlift.kernels.limit_solver import write_limits, write_solver
from tandemlift.kernels.offsets import delayed_spans, leaf_offset
from tandemlift.kernels.precompute import write_draw, write_gust, write_push, write_surroundings
from tandemlift.kernels.scratch import ScratchValues, steady
from tandemlift.kernels.traced_step import Symbols, TracedStep
from tandemlift.trace import Function, Module, Place, Symbol, double, leaves

HANDED = "ptr %c, ptr %flying, ptr %work"
UNIFORM = ("t", "dt", "when", "opens", "closes", "number")


class LoopWriter:
    """The functions of a flight's loop, for so many lanes."""

    def __init__(self, traced: TracedStep, lanes: int) -> None:
        self.traced, self.likes, self.graph, self.lanes = traced, traced.likes, traced.graph, lanes
        self.module, self.rooms = Module(), ScratchLayout()
        self.width, self.draws = leaves(self.likes.given.hand.start), 0
        self.moving = leaves(self.likes.flying.moving)
        self.lines = delayed_spans(self.likes.flying)
        g, roots = self.graph, [s.node for s in self.everything]
        self.blows = any(g.ops[n] == "in" and g.args[n][0] == "gust" for n in g.needed(roots))
        self._take_rooms()

    @property
    def everything(self) -> Symbols:
        """All that a step gives."""
        x = self.traced
        return [*x.moving, *x.sample, *self._swings(), *self._limits(), *x.asked, *x.body.acting, *x.body.push]

    def _take_rooms(self) -> None:
        x, take = self.likes, self.rooms.take
        self.hands = take("hands", HALVES * self.width)
        self.draws = len(self.traced.normals)
        self.noise = take("noise", 4 * self.draws * (SPAN if self.lanes == 1 else 1))
        self.gust = take("gust", 3)
        self.asked, self.answer = take("asked", len(self.traced.asked)), take("answer", 4 + 3)
        self.acting = take("acting", len(self.traced.body.acting))
        self.external = take("external", leaves(x.given.external))
        self.push, self.moved = take("push", 6), take("moved", leaves(x.moved))
        needs = self.traced.limits
        self.solving = take("solving", len(needs.problem) + len(needs.search) if needs else 0)
        self.sample = take("sample", leaves(x.sample) if self.lanes > 1 else 0)
        self.low = take("low", 1)

    # the functions

    def function(self, name: str, more: str = "", result: str = "void") -> Function:
        """An inner function: handed the context %c, the flight, the scratch memory, and more."""
        head = f"internal {result} @{name}({MEMORY}{more}) #1"
        f = Function(self.module, self.graph, self.lanes, head, UNIFORM)
        f.lines.append(f"  %dt = load double, ptr {f.at('%c', AT['dt'], 'i64')}, align 8")
        f.sets.room = self.room
        f.read = {"fly": lambda i: Place("%flying", i), "dt": lambda i: "%dt"}
        return f

    def export(self, name: str) -> None:
        """A function for Python, handed the context alone, that calls the inner one of that name."""
        f = Function(self.module, self.graph, self.lanes, f"i64 @{name}(ptr %c) #0")
        given = [f"ptr {self.word(f, word)}" for word in ("flying", "work")]
        f.end("i64 " + f.op(f"call i64 @{name}_({', '.join(['ptr %c', *given])})"))

    def room(self, count: int) -> Place:
        """Scratch memory for a set of so many numbers."""
        return Place("%work", self.rooms.take(f"room_{self.rooms.size}", count))

    def call(self, f: Function, name: str, *more: str) -> None:
        """Call another inner function."""
        f.do(f"call void @{name}({', '.join([HANDED, *more])})")

    def word(self, f: Function, name: str) -> str:
        """A word of the context."""
        return f.load("%c", AT[name], "ptr" if name in POINTERS else "i64")

    def time(self, f: Function, k: str) -> str:
        """The time of step k."""
        number = f.op(f"sitofp i64 {k} to double")
        return f.op(f"fmul double {number}, %dt")

    # a step

    def begin(self, f: Function, k: str) -> None:
        """What a step is given from outside, and how its inputs are read from then on."""
        x, lanes = self.likes, self.lanes
        in_span = f.whole("and", k, SPAN - 1)
        with f.when(f.op(f"icmp eq i64 {in_span}, 0")):
            self.call(f, "feel", f"i64 {k}")
            if self.draws and lanes == 1:
                self.call(f, "draw", f"i64 {k}")
            if x.grounded or x.walled or x.accompanied:
                self.call(f, "look")
        self.reading(f, k)
        if self.draws and lanes > 1:
            self.call(f, "draw", f"i64 {k}")
        if self.blows:
            self.call(f, "blow", f"double {f.read['t'](0)}")

    def reading(self, f: Function, k: str) -> None:
        """How the inputs of step k are read."""
        in_span = f.whole("and", k, SPAN - 1)
        t = self.time(f, k)
        hand = f.at("%work", f.whole("add", f.whole("mul", in_span, 2 * self.width), self.hands))
        noise = f.at("%work", f.whole("add", in_span, self.noise)) if self.lanes == 1 else f.at("%work", self.noise)
        pace = SPAN if self.lanes == 1 else 1
        f.read |= {
            "t": lambda i: t,
            "hand": lambda i: Place(hand, i),
            "noise": lambda i: Place(noise, i * pace, pace),
            "gust": lambda i: Place("%work", self.gust + i),
            "answer": lambda i: Place("%work", self.answer + i),
            "external": lambda i: Place("%work", self.external + i),
            "moved": lambda i: Place("%work", self.moved + i),
            "solved": lambda i: Place("%work", self.solved + i),
        }

    @property
    def solved(self) -> int:
        """Where the answer of the solver of limits stands."""
        needs = self.traced.limits
        return self.solving + (len(needs.problem) if needs else 0)

    def limit(self, f: Function) -> None:
        """Let the solver find thrusts within limits for the lanes that left theirs."""
        needs = self.traced.limits
        if needs is None:
            return
        write_limits(f, needs, self.solving)

    def swing(self, f: Function) -> None:
        """Move the body over the step."""
        if not self.traced.apart:
            if self.graph.rolls_from:
                self.keep(f, self.moved, self.traced.near)
            else:
                f.read["moved"] = lambda i: f.value(self.traced.near[i])  # as far as it is asked for
            return
        touches = f.op(f"fcmp one double {f.load('%work', self.low * self.lanes, 'double')}, 0.0")
        for value in f.values(self.traced.pressing):
            touches = f.op(f"or i1 {touches}, {f.any(value)}")
        near, apart, done = f.fresh("near"), f.fresh("apart"), f.fresh("done")
        f.do(f"br i1 {touches}, label %{near}, label %{apart}")
        for name, values in ((near, self.traced.near), (apart, self.traced.apart)):
            f.lines.append(f"{name}:")
            with f.scope():
                self.keep(f, self.moved, values)
            f.do(f"br label %{done}")
        f.lines.append(f"{done}:")

    def keep(self, f: Function, at: int, values: Symbols) -> None:
        """Write values to scratch memory."""
        f.put("%work", at, values)

    def show(self, f: Function, k: str) -> None:
        """Write the step's sample where it is logged, and where the last one goes."""
        every, steps = self.word(f, "every"), self.word(f, "steps")
        past = f.whole("sub", k, self.word(f, "since"))
        row = f.whole("sdiv", past, every)
        logged = f.op(f"icmp eq i64 {f.whole('mul', row, every)}, {past}")
        final = f.op(f"icmp eq i64 {k}, {steps}")
        with f.when(f.op(f"or i1 {logged}, {final}")):
            if self.lanes == 1:
                self._show_one(f, row, logged, final)
            else:
                self._show_lanes(f, row, logged)

    def _show_one(self, f: Function, row: str, logged: str, final: str) -> None:
        f.values(self.traced.sample)
        for condition, name, index in ((logged, "log", row), (final, "last", "0")):
            with f.when(condition):
                f.put(f.at(self.word(f, name), f.whole("mul", index, len(self.traced.sample))), 0, self.traced.sample)

    def _show_lanes(self, f: Function, row: str, logged: str) -> None:
        columns = len(self.traced.sample)
        self.keep(f, self.sample, self.traced.sample)
        with f.when(logged):
            log, stride = self.word(f, "log"), self.word(f, "stride")
            with f.repeat(self.lanes) as lane:
                to = f.whole("add", f.whole("mul", lane, stride), f.whole("mul", row, columns))
                with f.repeat(columns) as m:
                    at = f.whole("add", f.whole("mul", f.whole("add", m, self.sample), self.lanes), lane)
                    f.store(f.load("%work", at, "double"), log, f.whole("add", to, m), "double")

    def go_on(self, f: Function, k: str) -> None:
        """Let the flight be what it is after the step."""
        f.put("%flying", 0, self.traced.moving, "fly")
        if self.likes.late:
            self._delay(f, k)

    def _delay(self, f: Function, k: str) -> None:
        """Put what is delayed into a row of the line, and what arrives for the next step in its place."""
        ring, delays = self.word(f, "ring"), self.word(f, "delays")
        mask = f.whole("sub", self.word(f, "rings"), 1)
        into = f.at(ring, f.whole("mul", f.whole("and", k, mask), self.lines.size))
        column = 0
        for j, (at, size) in enumerate(self.lines):
            if not size:
                continue
            arrives = f.whole("add", k, 1) if j == 2 else k  # a command without delay acts at once
            out = f.whole("and", f.whole("sub", arrives, f.load(delays, j, "i64")), mask)
            for m in range(size):
                f.store(f.load("%flying", at + m), into, column + m)
            since = f.at(ring, f.whole("mul", out, self.lines.size))
            for m in range(size):
                f.store(f.load(since, column + m), "%flying", at + m)
            column += size

    # loops

    def write_outside(self) -> None:
        """The functions of what a step is given from outside."""
        write_push(self)
        if self.draws:
            write_draw(self)
        if self.blows:
            write_gust(self)
        if self.likes.grounded or self.likes.walled or self.likes.accompanied:
            write_surroundings(self)
        if self.traced.limits:
            write_solver(self.module, self.traced.limits.solver, self.lanes)

    def write_loop(self) -> str:
        """`fly`: steps k to stop − 1, fewer where a flight alone is no longer sound; it gives the step reached."""
        self.write_outside()
        f = self.function("fly_", result="i64")
        begin, stop, steps = self.word(f, "k"), self.word(f, "stop"), self.word(f, "steps")
        self.settle(f, begin, [*self.traced.moving, *self.traced.sample, *self._swings(), *self._limits()])
        f.label("first")
        f.label("loop")
        f.lines.append(f"  %k = phi i64 [ {begin}, %first ], [ %next, %ahead ]")
        f.do(f"br i1 {f.op(f'icmp slt i64 %k, {stop}')}, label %sound, label %over")
        f.lines.append("sound:")
        if self.lanes == 1:
            lost = f.load("%flying", leaf_offset(self.likes.flying, "moving", "diverged").at)
            f.do(f"br i1 {f.op(f'fcmp oeq double {lost}, 0.0')}, label %step, label %over")
            f.lines.append("step:")
        self.begin(f, "%k")
        self.limit(f)
        self.swing(f)
        self.show(f, "%k")
        ends = "over" if self.lanes == 1 else "ahead"
        f.do(f"br i1 {f.op(f'icmp eq i64 %k, {steps}')}, label %{ends}, label %on")
        f.lines.append("on:")
        self.go_on(f, "%k")
        f.label("ahead")
        f.lines.append("  %next = add i64 %k, 1")
        f.do("br label %loop")
        f.lines.append("over:")
        f.end("i64 %k")
        self.export("fly")
        return self.module.text

    def write_parts(self, leaves_body: bool) -> str:
        """Step k in parts: `ask` until a controller answers, `decide` until a body has moved, `complete` to its end."""
        self.write_outside()
        x = self.traced
        parts = ["ask"] * x.asks + ["decide"] * leaves_body + ["complete"]
        ends = [*x.moving, *x.sample, *([] if leaves_body else self._swings())]
        acts = [*self._limits(), *([*x.body.acting, *x.body.push] if leaves_body else [])]
        if not leaves_body:
            ends, acts = [*ends, *acts], []
        later = {"ask": [*acts, *ends], "decide": ends, "complete": []}
        for part in parts:
            f = self.function(f"{part}_", result="i64")
            k = self.word(f, "k")
            if part == parts[0]:
                waiting = self.settle(f, k, [*x.asked, *acts, *ends])
                self.begin(f, k)
            else:
                waiting.find(f)
                self.reading(f, k)
            if part == "ask":
                self.keep(f, self.asked, x.asked)
            elif part == "decide":
                self.limit(f)
                self.keep(f, self.acting, x.body.acting)
                self.keep(f, self.push, x.body.push)
            else:
                self._complete(f, k, leaves_body)
            waiting.hand_on(f, later[part])
            f.end("i64 0")
            self.export(part)
        return self.module.text

    def _complete(self, f: Function, k: str, leaves_body: bool) -> None:
        if not leaves_body:
            self.limit(f)
            self.swing(f)
        self.show(f, k)
        with f.when(f.op(f"icmp ne i64 {k}, {self.word(f, 'steps')}")):
            self.go_on(f, k)

    def _swings(self) -> Symbols:
        return [*self.traced.near, *self.traced.apart, *self.traced.pressing]

    def _limits(self) -> Symbols:
        needs = self.traced.limits
        return [needs.beyond, *needs.problem, *needs.plain, *needs.search] if needs else []

    def settle(self, f: Function, k: str, roots: Symbols) -> ScratchValues:
        """Where a flight begins or has changed: the tables for step k, and what will not change, which waits."""
        waiting = ScratchValues(self.graph, self.rooms)
        nodes = steady(self.graph, roots, self.moving)
        f.values(Symbol(self.graph, n, "f") for n in nodes if f.is_uniform(n))
        with f.when(f.op(f"icmp ne i64 {self.word(f, 'fresh')}, 0")):
            self.call(f, "feel", f"i64 {k}")
            if self.draws and self.lanes == 1:
                self.call(f, "draw", f"i64 {k}")
            f.store(double(float(self.likes.grounded)), "%work", self.low * self.lanes, "double")
            waiting.leave(f, [n for n in nodes if not f.is_uniform(n)])
        waiting.find(f)
        return waiting
