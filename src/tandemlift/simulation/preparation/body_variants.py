"""How a step moves the body: in free air, on its feet, or with all contacts, chosen anew in each step.

In a flight alone, the variants with contact are functions of their own. They fly seldom, and LLVM would spend most of
its time on them.
"""

from __future__ import annotations

from tandemlift.compiler.tracer import LEAVES, Function, Place, double
from tandemlift.simulation.loop.sources import leaf_offset
from tandemlift.simulation.preparation.precompute import ScratchValues
from tandemlift.simulation.preparation.step_writer import StepWriter
from tandemlift.simulation.preparation.traced_step import Symbols

OF_FUNCTIONS = "%flight", "%work"  # memory that each function knows


def write_body(step: StepWriter, f: Function) -> None:
    """Move the body over the step."""
    x = step.traced
    if not step.moves_body:
        return _call_other_body(step, f)
    if not x.body_in_free_air:
        if step.graph.rolls_from or step.largest:
            f.update("%work", step.moved, x.body_in_contact)
        elif f.orders:
            f.same |= {step.graph.input("moved", i).node: s.node for i, s in enumerate(x.body_in_contact)}
        else:
            f.read["moved"] = lambda i: f.value(x.body_in_contact[i])  # computed where it is read
        return
    near, feet, clear, done = [f.fresh(name) for name in ("near", "feet", "clear", "done")]
    _choose_body(step, f, near, feet, clear)
    bodies = {near: x.body_in_contact, feet: x.body_on_feet, clear: x.body_in_free_air}
    for name, values in bodies.items():
        f.lines.append(f"{name}:")
        f.store(double(float(name == near)), "%work", step.near * step.lanes, f.real)
        f.seldom = name == near
        moved = values if name == near else values[: step.moved_touches]
        if name != clear and step.lanes == 1 and not (step.graph.rolls_from or step.largest):
            _call_apart(step, f, name.rstrip("0123456789"), moved)
        else:
            with f.scope():
                f.update("%work", step.moved, moved)
                if x.rests:
                    f.put("%work", step.moved + step.moved_end, values[step.moved_end :])
        f.do(f"br label %{done}")
    f.seldom = False
    f.lines.append(f"{done}:")


def _call_apart(step: StepWriter, f: Function, name: str, moved: Symbols) -> None:
    """Move the body in a function of its own; scratch memory brings it what it needs."""
    graph, g = step.graph, step.function(f"{name}_body", attributes="#3" if name == "near" else "#1")
    known = {n for n in f.known() if graph.types[n] == "f" and (step.held or graph.ops[n] not in LEAVES)}
    nodes = graph.needed([s.node for s in moved], known | f.kept.keys())
    wanted = {a for n in nodes if graph.ops[n] not in LEAVES for a in graph.args[n]}.union(s.node for s in moved)
    given = ScratchValues(graph, step.scratch)
    with f.scope():
        given.store(f, sorted(n for n in wanted - f.kept.keys() if n in known or _is_own(f, n)))
    g.kept, g.read = dict(f.kept), f.read | g.read
    given.bind(g)
    g.update("%work", step.moved, moved)
    g.end()
    step.call(f, f"{name}_body")


def _is_own(f: Function, node: int) -> bool:
    """Whether a node is an input that only this function finds."""
    if f.graph.ops[node] != "in" or f.graph.args[node][0] == "dt":
        return False
    kind, index = f.graph.args[node]
    place = f.read[kind](index)
    return not (isinstance(place, Place) and place.base in OF_FUNCTIONS)


def _call_other_body(step: StepWriter, f: Function) -> None:
    """Let the machine code of a body in another engine take the step: see `engines.registry.MachineBody`."""
    f.update("%work", step.acting, step.traced.body.acting)
    f.update("%work", step.push, step.traced.body.push)
    like, moved = step.templates.acting, step.moved
    thrusts, loads = leaf_offset(like, "thrusts").at, leaf_offset(like, "wind", "loads")
    places = step.acting + thrusts, step.acting + loads.at, step.push, moved, moved + step.moved_touches
    given = [f.at("%work", at) for at in places]
    given[1] = given[1] if loads.size else "null"
    words = f.load("%work", step.machine_words, "ptr")
    f.do(f"call void {f.load(words, 0, 'ptr')}({', '.join(f'ptr {address}' for address in (words, *given))})")


def _choose_body(step: StepWriter, f: Function, near: str, feet: str, clear: str) -> None:
    """Branch to the body near walls or with all its parts near the floor, on its feet, or in free air."""
    low = f.op(f"fcmp one {f.real} {f.load('%work', step.low * step.lanes, f.real)}, 0.0")
    walls, lower, tipped = "false", f.fresh("lower"), f.fresh("tipped")
    for value in f.values(step.traced.may_touch_walls):
        walls = f.op(f"or i1 {walls}, {f.any(value)}")
    f.do(f"br i1 {walls}, label %{near}, label %{lower}")
    f.lines.append(f"{lower}:")
    f.do(f"br i1 {low}, label %{tipped}, label %{clear}")
    f.lines.append(f"{tipped}:")
    with f.scope():
        hull = "false"
        for value in f.values(step.traced.may_touch_hull):
            hull = f.op(f"or i1 {hull}, {f.any(value)}")
        f.do(f"br i1 {hull}, label %{near}, label %{feet}")
