"""The loop over the steps of a flight, written once: for one flight, for a block of them, and cut into parts.

A step is cut where a controller in Python or a body in another engine takes part. Scratch memory carries values from
one part to the next, and the values that are constant within a flight, which are computed before its first step.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

from tandemlift.compiler.tracer import LEAVES, Function, Place, Symbol, double
from tandemlift.simulation.loop.external_inputs import SPAN
from tandemlift.simulation.preparation import precompute
from tandemlift.simulation.preparation.body_variants import write_body
from tandemlift.simulation.preparation.limit_solver import write_limits, write_solver
from tandemlift.simulation.preparation.step_end import write_early, write_estimates, write_next_state, write_sample
from tandemlift.simulation.preparation.step_writer import StepWriter
from tandemlift.simulation.preparation.traced_step import Symbols

Write = Callable[[Function], None]
Halves = tuple[Callable[[], None], Callable[[], None]]  # each writes a part of a step: up to its sample, and the rest


class LoopWriter(StepWriter):
    """Writes the functions of a flight's loop as LLVM text; arguments as for `StepWriter`."""

    def begin_step(self, f: Function, k: str) -> None:
        """Form the inputs of step k from outside, once in a span where possible, and bind them."""
        x, lanes = self.templates, self.lanes
        begins = self.begins_span(f, k)
        with f.when(f.op(f"icmp eq i64 {f.integer('and', k, SPAN - 1)}, 0")):
            self.call(f, "sum_pushes", f"i64 {k}")
            if self.free_draws and lanes == 1:
                self.call(f, "draw_noise", f"i64 {k}")
        if x.has_floor or x.has_person:
            with f.when(f.any(begins)):
                self.call(f, "find_surroundings", f"i64 {k}")
        if x.has_walls:
            truth = "i1" if lanes == 1 else f"<{lanes} x i1>"
            self.call(f, "find_walls", f"{f.vector} {f.op(f'uitofp {truth} {begins} to {f.vector}')}")
        self.bind_inputs(f, k)
        if self.free_draws and lanes > 1:
            self.call(f, "draw_noise", f"i64 {k}")
        if self.has_gusts:
            self.call(f, "sum_gusts", f"{f.vector} {f.read['t'](0)}")

    def bind_inputs(self, f: Function, k: str) -> None:
        """Bind the inputs of step k to their places in memory."""
        in_span = f.integer("and", k, SPAN - 1)
        t = self.time(f, k)
        hand = f.at("%work", f.integer("add", f.integer("mul", in_span, 2 * self.width), self.pushes_at))
        noise = f.at("%work", f.integer("add", in_span, self.noise)) if self.lanes == 1 else f.at("%work", self.noise)
        pace = SPAN if self.lanes == 1 else 1
        f.read |= {
            "t": lambda i: t,
            "hand": lambda i: Place(hand, i),
            "noise": lambda i: Place("%work", self.drawn[i]) if i in self.drawn else Place(noise, i * pace, pace),
            "gust": lambda i: Place("%work", self.gust + i),
            "answer": lambda i: Place("%work", self.answer + i),
            "external": lambda i: Place("%work", self.external + i),
            "outside": lambda i: Place("%work", self.outside + i),
            "moved": lambda i: Place("%work", self.moved + i),
            "solved": lambda i: Place("%work", self.solved + i),
        }

    def limit_thrusts(self, f: Function) -> None:
        """Solve for thrusts within limits in the lanes whose thrusts exceed them."""
        needs = self.traced.limits
        if needs is not None:
            write_limits(f, needs, self.solving, self.exact)

    # loops

    def write_outside(self) -> None:
        """The functions that form a step's inputs from outside."""
        precompute.write_push(self)
        if self.free_draws:
            precompute.write_draw(self, "draw_noise", self.free_draws)
        for number, part in enumerate(self.held):
            if part.noise.size:
                precompute.write_draw_of_part(self, f"draw_noise{number}", part)
        if self.has_gusts:
            precompute.write_gust(self)
        if self.templates.has_floor or self.templates.has_person:
            precompute.write_surroundings(self)
        if self.templates.has_walls:
            precompute.write_walls(self)
        if self.traced.limits:
            write_solver(self.module, self.traced.limits.solver, self.lanes)

    def write_loop(self, *, around: bool = False) -> str:
        """`fly`: steps k to stop − 1, fewer if a flight alone ends before; `around`: a body in another engine."""
        self.moves_body, self.machine_words = not around, self.scratch.take("body", 1) if around else 0
        self.hold_parts()
        self.write_outside()
        f = self.function("fly_", result="i64")
        begin, stop, steps = self.context_word(f, "k"), self.context_word(f, "stop"), self.context_word(f, "steps")
        x = self.traced
        roots = [*x.next_state, *x.rests, *x.sample, *self.body_roots(), *self.limit_roots()]
        kept = self.prepare(f, begin, roots)
        f.label("first")
        f.label("loop")
        f.lines.append(f"  %k = phi i64 [ {begin}, %first ], [ %next, %ahead ]")
        f.do(f"br i1 {f.op(f'icmp slt i64 %k, {stop}')}, label %sound, label %over")
        f.lines.append("sound:")
        f.do(f"br i1 {self.is_halted(f)}, label %over, label %step")
        f.lines.append("step:")
        self.begin_step(f, "%k")
        sample, go_on = self._step_in_pieces(f, kept) if self.largest else self._step_in_place(f, steps)
        sample()
        ends = "over" if self.lanes == 1 else "ahead"
        f.do(f"br i1 {f.op(f'icmp eq i64 %k, {steps}')}, label %{ends}, label %on")
        f.lines.append("on:")
        go_on()
        f.label("ahead")
        f.lines.append("  %next = add i64 %k, 1")
        f.do("br label %loop")
        f.lines.append("over:")
        f.end("i64 %k")
        self.export("fly")
        return self.module.text

    def _step_in_place(self, f: Function, steps: str) -> Halves:
        x, done = self.traced, set[int]()
        early = f.orders and bool(x.limits or x.body_in_free_air)

        def sample() -> None:
            if early or self.held:
                final = f.op(f"icmp eq i64 %k, {steps}")
                before = f.at("%work", self.scratch.take("before", self.state_size))
                self._copy_state(f, final, "%flight", before)
            write_estimates(self, f)
            if early and x.limits:
                write_early(self, f, [x.limits.beyond, *x.limits.plain], done, "solved", "moved")
            self.limit_thrusts(f)
            if early and x.body_in_free_air:
                write_early(self, f, x.body.acting, done, "moved")
            write_body(self, f)
            write_sample(self, f, "%k")
            if early or self.held:
                self._copy_state(f, final, before, "%flight")

        return (sample, lambda: write_next_state(self, f, "%k", done))

    def _copy_state(self, f: Function, is_last: str, source: str, to: str) -> None:
        """Copy the numbers that change from step to step in the last step, which takes a sample and changes none."""
        with f.when(is_last), f.repeat(self.state_size) as i:
            f.store(f.load(source, i), to, i)

    def _step_in_pieces(self, f: Function, kept: precompute.ScratchValues) -> Halves:
        """Write a step as functions of some `largest` operations each, which are called one after another."""
        x, sampling = self.traced, list[str]()
        end = [*x.next_state, *x.sample]
        body, acting = [*self.body_roots(), *end], [*x.body.acting, *x.body.push]
        if x.limits:
            sampling += self._pieces("limits", kept, self.limit_roots(), [*acting, *body])
            sampling += [self._piece("solving", self.limit_thrusts, kept, [*acting, *body])]
        sampling += self._pieces("acting", kept, acting, body)
        sampling += [self._piece("body", lambda g: write_body(self, g), kept, end)]
        sampling += self._pieces("end", kept, x.next_state, x.sample)
        sampling += [self._piece("sample", lambda g: write_sample(self, g, "%k"), kept, [])]
        last = self._piece("next", lambda g: write_next_state(self, g, "%k"), kept, [])

        def sample() -> None:
            for name in sampling:
                self.call(f, name, "i64 %k")

        return (sample, lambda: self.call(f, last, "i64 %k"))

    def _pieces(self, name: str, kept: precompute.ScratchValues, roots: Symbols, later: Symbols) -> list[str]:
        """Compute roots in functions of some `largest` operations each; names of the functions."""
        g, ids = self.graph, [s.node for s in roots]
        nodes = [n for n in g.needed(ids, kept.at) if g.ops[n] not in LEAVES and n not in kept.at]
        parts = [nodes[cut : cut + self.largest] for cut in range(0, len(nodes), self.largest)]
        writers = [functools.partial(Function.write, roots=part) for part in parts]
        return [self._piece(f"{name}{i}", write, kept, [*roots, *later]) for i, write in enumerate(writers)]

    def _piece(self, name: str, write: Write, kept: precompute.ScratchValues, later: Symbols) -> str:
        """Write a part of a step as a function, which stores what later parts need; its name."""
        f = self.function(f"{name}_part", ", i64 %k")
        kept.bind(f)
        self.bind_inputs(f, "%k")
        write(f)
        kept.store_for_later(f, later)
        f.end()
        return f"{name}_part"

    def write_parts(self, leaves_body: bool) -> str:
        """Step k in parts: `ask` up to a controller in Python, `decide` up to another body, `complete` to its end."""
        self.moves_body = not leaves_body
        self.write_outside()
        x = self.traced
        parts = ["ask"] * self.templates.calls_python + ["decide"] * leaves_body + ["complete"]
        ends, acts = [*x.next_state, *x.sample], [*self.body_roots(), *self.limit_roots()]
        if not leaves_body:
            ends, acts = [*ends, *acts], []
        later = {"ask": [*acts, *ends], "decide": ends, "complete": []}
        for part in parts:
            f = self.function(f"{part}_", result="i64")
            k = self.context_word(f, "k")
            if part == parts[0]:
                kept = self.prepare(f, k, [*x.asked, *acts, *ends])
                self.begin_step(f, k)
            else:
                kept.bind(f)
                self.bind_inputs(f, k)
            if part == "ask":
                f.update("%work", self.asked, x.asked)
            elif part == "decide":
                self.limit_thrusts(f)
                f.update("%work", self.acting, x.body.acting)
                f.update("%work", self.push, x.body.push)
            else:
                self._complete(f, k, leaves_body)
            kept.store_for_later(f, later[part])
            f.end("i64 0")
            self.export(part)
        return self.module.text

    def _complete(self, f: Function, k: str, leaves_body: bool) -> None:
        if not leaves_body:
            self.limit_thrusts(f)
            write_body(self, f)
        write_sample(self, f, k)
        with f.when(f.op(f"icmp ne i64 {k}, {self.context_word(f, 'steps')}")):
            write_next_state(self, f, k)

    def prepare(self, f: Function, k: str, roots: Symbols) -> precompute.ScratchValues:
        """At the start of a flight or after a change: form the tables for step k and store the constant values."""
        kept = precompute.ScratchValues(self.graph, self.scratch)
        nodes = precompute.steady(self.graph, roots, self.state_size)
        f.values(Symbol(self.graph, n, "f") for n, common in nodes.items() if common)
        own = [n for n, common in nodes.items() if not common]
        alike = [n for n in own if f.is_uniform(n)]
        with f.when(f.op(f"icmp ne i64 {self.context_word(f, 'fresh')}, 0")):
            self.call(f, "sum_pushes", f"i64 {k}")
            if self.free_draws and self.lanes == 1:
                self.call(f, "draw_noise", f"i64 {k}")
            f.store(double(float(self.templates.has_floor)), "%work", self.low * self.lanes, f.real)
            f.put("%work", self.moved + self.moved_touches, self.traced.touches_before)
            kept.store(f, [n for n in own if not f.is_uniform(n) and self.graph.ops[n] not in LEAVES])
            kept.store_alike(f, alike)
        kept.bind(f)
        return kept
