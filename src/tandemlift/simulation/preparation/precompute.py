"""Values that are formed ahead of steps: pushes, gusts, random numbers, surroundings, and those that stay constant.

Scratch memory keeps the values that are constant within a flight, and those that a later part of a step needs.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence

from tandemlift.compiler.tracer import LEAVES, Function, Graph, Place, ScratchLayout, Symbol, symbols
from tandemlift.core.types import leaves
from tandemlift.simulation.loop.external_inputs import HALVES, ROWS, SPAN
from tandemlift.simulation.loop.sources import HeldPart, leaf_offset
from tandemlift.simulation.preparation.memory import MEMORY
from tandemlift.simulation.preparation.step_writer import StepWriter
from tandemlift.simulation.preparation.traced_step import Symbols


def write_push(step: StepWriter) -> None:
    """The sum of all pushes at the half steps of the span that holds step k."""
    f, width = step.function("sum_pushes", ", i64 %k"), step.width
    first = f.integer("and", "%k", -SPAN)
    with f.repeat(HALVES * width) as i:
        f.store(f.zero, "%work", f.integer("add", i, step.pushes_at))
    opens, closes = step.time(f, first), step.time(f, f.integer("add", first, SPAN))
    twice = f.integer("mul", first, 2)
    pushes, count = step.context_word(f, "pushes"), step.context_word(f, "push_count")
    with f.repeat(count) as i:
        row = f.at(pushes, f.integer("mul", i, leaves(ROWS.pushes)))
        f.read |= {"push": lambda m: Place(row, m), "opens": lambda m: opens, "closes": lambda m: closes}
        with f.when(f.any(f.value(step.traced.push_is_active))), f.repeat(HALVES) as j:
            when = step.time(f, f.integer("add", twice, j), 2)
            f.read["when"] = lambda m: when
            _add_to(f, f.integer("add", f.integer("mul", j, width), step.pushes_at), step.traced.push)
    f.end()


def write_gust(step: StepWriter) -> None:
    """The velocity of all gusts at the time of a step."""
    f = step.function("sum_gusts", f", {step.vector} %t")
    f.read["t"] = lambda m: "%t"
    for m in range(3):
        f.store(f.zero, "%work", step.gust + m)
    gusts, count = step.context_word(f, "gusts"), step.context_word(f, "gust_count")
    with f.repeat(count) as i:
        row = f.at(gusts, f.integer("mul", i, leaves(ROWS.gusts)))
        f.read["gusts"] = lambda m: Place(row, m)
        _add_to(f, step.gust, step.traced.gust)
    f.end()


def _add_to(f: Function, at: str | int, more: Symbols) -> None:
    """Add values to those in scratch memory."""
    place = f.at("%work", at)
    for m, value in enumerate(f.values(more)):
        f.store(f.op(f"fadd {f.vector} {f.load(place, m)}, {value}"), place, m)


def write_draw(step: StepWriter, name: str, draws: Sequence[int]) -> None:
    """Draws of one step in every lane; for a flight alone, of all steps of the span that holds step k."""
    lanes = step.lanes if step.lanes > 1 else step.draw_lanes
    uniform = () if step.lanes > 1 else ("key",)
    f = Function(step.module, step.graph, lanes, f"internal void @{name}({MEMORY}, i64 %k) #1", uniform)
    keys = step.context_word(f, "keys")
    if step.lanes > 1:
        step.bind_draw(f, keys, step.own(f, "%k"))
        for i in draws:
            for m, value in enumerate(f.values(step.traced.normals[i])):
                f.store(value, "%work", step.noise + 4 * i + m)
        f.end()
        return
    first = f.integer("and", "%k", -SPAN)
    kind = f"<{lanes} x i64>" if lanes > 1 else "i64"
    ramp = "<" + ", ".join(f"i64 {j}" for j in range(lanes)) + ">" if lanes > 1 else "0"
    f.read = {"key": lambda m: f.load(keys, m, "double")}
    with f.repeat(SPAN // lanes) as j:
        base = f.spread(f.integer("add", first, f.integer("mul", j, lanes)), "i64")
        numbers = f.op(f"add {kind} {base}, {ramp}")
        f.read["number"] = lambda m: numbers
        for i in draws:
            for m, value in enumerate(f.values(step.traced.normals[i])):
                at = f.integer("add", f.integer("mul", j, lanes), step.noise + (4 * i + m) * SPAN)
                f.store(value, f.at("%work", at, "double"))
    f.end()


def write_draw_of_part(step: StepWriter, name: str, part: HeldPart) -> None:
    """Standard normals of step k for a held part; for a flight alone, several draws at once."""
    draws, lanes = step.draws_of(part), step.lanes_of(part)
    if step.lanes > 1:
        write_draw(step, name, draws)
        return
    head = f"internal void @{name}({MEMORY}, i64 %k) #1"
    f = Function(step.module, step.graph, lanes, head, ("key", "number"))
    keys, to = step.context_word(f, "keys"), step.drawn[part.noise.at] - part.noise.at % 4 * lanes
    f.read = {"key": lambda m: f.load(keys, m, "double"), "number": lambda m: "%k"}
    for first in range(0, len(draws), lanes):
        numbers = [str(draws[0] + first + lane) for lane in range(lanes)]
        text = numbers[0] if lanes == 1 else f"<{', '.join(f'i64 {n}' for n in numbers)}>"
        f.read["draw"] = {0: text}.__getitem__
        with f.afresh():
            for m, value in enumerate(f.values(step.traced.normals_of_draw)):
                f.store(value, f.at("%work", to + 4 * first + m * lanes, "double"))
    f.end()


def write_surroundings(step: StepWriter) -> None:
    """Search once per span of a flight: whether the floor is near, the leg of the person's path."""
    x, f = step.templates, step.function("find_surroundings", ", i64 %k")
    if x.has_floor:
        low = f.any(f.value(step.traced.may_touch_floor))
        f.store(f.op(f"uitofp i1 {low} to {f.real}"), "%work", step.low * step.lanes, f.real)
    if x.has_person:
        _find_legs(step, f)
    f.end()


def write_walls(step: StepWriter) -> None:
    """Find the nearest walls of the flights for which they are due."""
    f = step.function("find_walls", f", {step.vector} %begins")
    at = leaf_offset(step.templates.model, "flight_state", "near").at
    f.read |= {"begins": lambda m: "%begins", "due": lambda m: Place("%work", step.due)}
    is_due, first, more = step.traced.wall_search
    due = f.value(is_due)
    f.store(due, "%work", step.due)
    with f.when(f.any(f.op(f"fcmp one {f.vector} {due}, {f.zero}"))):
        f.put("%flight", at, first)
        walls, count = step.context_word(f, "walls"), step.context_word(f, "wall_count")
        with f.repeat(count) as i:
            row = f.at(walls, f.integer("mul", i, leaves(ROWS.walls)))
            f.read["wall"] = lambda m: Place(row, m)
            with f.afresh():
                f.put("%flight", at, more)
    f.end()


def _find_legs(step: StepWriter, f: Function) -> None:
    model, lanes = step.templates.model, step.lanes
    index, leg = (leaf_offset(model, "flight_state", "person", name).at for name in ("index", "leg"))
    legs, last = step.context_word(f, "legs"), f.integer("sub", step.context_word(f, "leg_count"), 1)
    begins = step.begins_span(f, "%k")
    for lane in range(lanes):
        is_due = begins if lanes == 1 else f.op(f"extractelement <{lanes} x i1> {begins}, i64 {lane}")
        with f.when(is_due):
            number = f.load("%flight", index * lanes + lane, f.real)
            name = f"@llvm.fptosi.sat.i64.{'f64' if f.real == 'double' else 'f32'}"
            i = f.call("i64", name, number, types=[f.real])
            i = f.call("i64", "@llvm.smax.i64", i, "0", types=["i64", "i64"])
            i = f.call("i64", "@llvm.smin.i64", i, last, types=["i64", "i64"])
            row = f.at(legs, f.integer("mul", i, leaves(ROWS.legs)))
            for m in range(leaves(ROWS.legs)):
                f.store(f.load(row, m * lanes + lane, f.real), "%flight", (leg + m) * lanes + lane, f.real)


def steady(graph: Graph, roots: Symbols, state_size: int) -> dict[int, bool]:
    """The nodes that steps need and that are constant within a flight, parameters too; whether any flight has the same.

    Args:
        graph: of a step.
        roots: every value that a step computes.
        state_size: how many of the flight's leading numbers change from step to step.
    """
    constant, common, wanted = [False] * len(graph.ops), [False] * len(graph.ops), set[int]()
    for node in graph.needed([s.node for s in roots]):
        op, args = graph.ops[node], graph.args[node]
        inner = () if op in LEAVES else args
        common[node] = all(common[a] for a in inner) if inner else op == "const" or args[0] == "dt"
        own = all(constant[a] for a in inner) if inner else args[0] == "fly" and args[1] >= state_size
        constant[node] = common[node] or own
        wanted.update(inner if not constant[node] else ())
    found = sorted(n for n in wanted if constant[n] and graph.types[n] == "f")
    return {n: common[n] for n in found if not (common[n] and graph.ops[n] in LEAVES)}


class ScratchValues:
    """Nodes kept in scratch memory, with their offsets."""

    def __init__(self, graph: Graph, scratch: ScratchLayout) -> None:
        self.graph, self.scratch = graph, scratch
        self.at, self.alike = dict[int, int](), dict[int, int]()

    def store(self, f: Function, nodes: list[int]) -> None:
        """Write nodes to scratch memory."""
        g, first = self.graph, self.scratch.size
        for node in nodes:
            self.at[node] = self.scratch.take(f"node_{node}", g.counts[node] or 1)
        f.put("%work", first, [s for n in nodes for s in symbols(g, Symbol(g, n, "f"))])

    def store_alike(self, f: Function, nodes: list[int]) -> None:
        """Write nodes that are equal in all lanes to scratch memory, one number each."""
        first = self.scratch.take("alike_", -(-len(nodes) // f.lanes)) * f.lanes
        self.alike = {node: i for i, node in enumerate(nodes, first)}
        for node, i in self.alike.items():
            f.store(f.scalar(Symbol(self.graph, node, "f")), "%work", i, f.real)

    def bind(self, f: Function) -> None:
        """Make a function read the stored nodes instead of computing them."""
        f.kept |= {node: functools.partial(Place, "%work", at) for node, at in self.at.items()}
        f.kept |= {node: functools.partial(f.load, "%work", i, f.real) for node, i in self.alike.items()}

    def store_for_later(self, f: Function, later: Symbols) -> None:
        """Store the values known now that the later parts of the step need."""
        g, roots = self.graph, [s.node for s in later]
        known = {n for n in f.known() if g.types[n] == "f" and g.ops[n] not in LEAVES} | self.at.keys()
        wanted = {a for n in g.needed(roots, known) if g.ops[n] not in LEAVES for a in g.args[n]}
        self.store(f, sorted((wanted.union(roots) & known) - self.at.keys()))
