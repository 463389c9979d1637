"""Kinks: comparisons and absolute values at whose edge a point lies, so that the derivative jumps there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.linearization.derivative import CURVED, Derivative, Sides, difference, meet
from tandemlift.analysis.linearization.period import LinearizationPlan, PeriodDerivative
from tandemlift.analysis.linearization.step_derivative import StepDerivative
from tandemlift.compiler.tracer import LEAVES
from tandemlift.core.types import Array

PACKAGE = Path(__file__).parents[2]
SAME = 1e-9  # relative, of directions; and of the entries of two models to their largest
KINK_TOLERANCE = 1e-3  # relative change of an entry that is no kink
MAX_EDGES = 100  # edges that are examined
UPWARD = ("ogt", "oge")
EQUALITIES = ("oeq", "une")


class Kink(NamedTuple):
    """An edge at the point.

    Attributes:
        law: with the comparison or absolute value.
        file: of the law, with its first line.
        distance: the smallest change of one state or input, in its unit, that leads to the edge; 0 on it.
        text: a sentence with all of this.
    """

    law: str
    file: str
    distance: float
    text: str


class Edge(NamedTuple):
    """Nodes of a step of the period whose truth or sign changes on one surface.

    `normal`: the direction of the surface, of length 1, or None where the compared numbers are equal and have no
    derivative. `nodes`: each with its truth on the side to which the normal points.
    """

    step: int
    normal: Array | None
    distance: float
    nodes: dict[int, bool]


def kinks_near(r: LinearizationPlan, made: PeriodDerivative, tolerance: float) -> list[Kink]:
    """The kinks at a point.

    Args:
        r: the request.
        made: its derivative.
        tolerance: the largest distance of a kink.
    """
    edges = dict[frozenset[int], Edge]()
    for step, d in enumerate(made.steps):
        for edge in edges_of(r, step, d, tolerance):
            edges.setdefault(frozenset(edge.nodes), edge)
    nearest = sorted(edges.values(), key=lambda edge: (edge.normal is None, edge.distance))
    by_law = dict[tuple[str, str], list[float]]()
    for edge in nearest[:MAX_EDGES]:
        if is_kink(r, edge, made.steps[edge.step]):
            by_law.setdefault(law_name(r.graph.graph.laws[min(edge.nodes)]), []).append(edge.distance)
    found = [kink_of(*law, distances) for law, distances in by_law.items()]
    if len(nearest) > MAX_EDGES:
        found.append(Kink("", "", 0.0, f"{len(nearest) - MAX_EDGES} further edges were not examined"))
    margins = sorted([one for d in made.steps for one in near_margins(d, tolerance)], key=lambda one: -one[1])
    return found + ([solver_kink(dict(margins))] if margins else [])


def edges_of(r: LinearizationPlan, step: int, d: StepDerivative, tolerance: float) -> list[Edge]:
    """The edges within a distance of a step, those on one surface together."""
    found = list[Edge]()
    for node, value, row, is_upward in compared(r, d):
        size = float(np.abs(row).max())
        distance = abs(value) / size if size > 0.0 else 0.0 if value == 0.0 else np.inf
        if not distance <= tolerance:
            continue
        if size == 0.0:
            found.append(Edge(step, None, 0.0, {node: not d.nodes.values[node]}))
            continue
        normal = row / np.linalg.norm(row)
        for edge in found:
            cosine = 0.0 if edge.normal is None else float(edge.normal @ normal)
            if abs(cosine) > 1.0 - SAME:
                edge.nodes[node] = is_upward == (cosine > 0.0)
                break
        else:
            found.append(Edge(step, normal, distance, {node: is_upward}))
    return found


def compared(r: LinearizationPlan, d: StepDerivative) -> Iterator[tuple[int, float, Any, bool]]:
    """Decisions by a number's sign: (node, number, its derivative, whether the node is true if it is above 0)."""
    g, rows, values = r.graph.graph, d.nodes.rows, d.nodes.values
    for node in deciding_nodes(r):
        if node not in values:
            continue
        op, args = g.ops[node], g.args[node]
        a, b = args[0], args[-1]
        if op == "fabs":
            row, value = rows[a], values[a]
        else:
            row, value = difference(rows[a], rows[b]), values[a] - values[b]
        if row is not None and np.isfinite(value) and np.isfinite(row).all() and not op.endswith(EQUALITIES):
            yield node, value, row, op == "fabs" or op.endswith(UPWARD)


def deciding_nodes(r: LinearizationPlan) -> list[int]:
    """The comparisons and absolute values that choose between derivatives of the model."""
    g, seen = r.graph.graph, set[int]()
    stack = [g.args[node][0] for node in r.choice.smooth if g.ops[node] == "select"]
    if r.graph.traced.limits:
        stack.append(r.graph.traced.limits.beyond.node)
    while stack:
        node = stack.pop()
        if node in seen or g.types[node] != "b":
            continue
        seen.add(node)
        if not g.ops[node].startswith(("fcmp", "icmp")) and g.ops[node] not in ("const", "in"):
            stack += g.args[node]
    found = [node for node in seen if g.ops[node].startswith("fcmp")]
    return sorted([*found, *[node for node in r.choice.smooth if g.ops[node] == "fabs"]])


def is_kink(r: LinearizationPlan, edge: Edge, d: StepDerivative) -> bool:
    """Whether the step, or its derivative, differs on the two sides of an edge."""
    if not any(differs_here(r, node, edge, d) for node in choosing(r, edge.nodes)):
        return False
    outputs = r.outputs if edge.step == 0 else ()
    nodes = [*[r.graph.next[i] for i in r.choice.kept], *outputs]
    size, one = len(r.choice.kept) + len(r.inputs), edge.nodes
    other = {node: not side for node, side in one.items()}
    known = d, d.depending_on(one)
    nodes = [node for node in nodes if node in known[1]]
    if not nodes:
        return False

    def on(side: dict[int, bool]) -> Derivative:
        holds = all(side[node] == is_true(d, node) for node in side)
        return d.nodes if holds else StepDerivative(r.graph, d.x, Sides(side, edge.distance), known).nodes

    (a, c), (b, e) = [(made.rows_of(nodes, size), made.values_of(nodes)) for made in (on(one), on(other))]
    steepest = 1.0 + np.abs(a).max(axis=1)
    return not (
        alike(a, b, KINK_TOLERANCE * (np.abs(a) + np.abs(b)) + SAME * steepest[:, None])
        and alike(c, e, SAME * (1.0 + np.abs(c)) + CURVED * edge.distance * steepest)
    )


def is_true(d: StepDerivative, node: int) -> bool:
    """The truth of a comparison; whether an absolute value is of a number that is not below 0."""
    g, values = d.graph.graph, d.nodes.values
    return values[g.args[node][0]] >= 0.0 if g.ops[node] == "fabs" else values[node]


def choosing(r: LinearizationPlan, nodes: Iterable[int]) -> Iterator[int]:
    """The selections whose condition depends on a comparison of `nodes`, and the absolute values among these."""
    g, reached = r.graph.graph, set(nodes)
    for node in range(min(reached), len(g.ops)):
        op, args = g.ops[node], g.args[node]
        if op == "fabs":
            if node in reached:
                yield node
        elif op not in LEAVES and g.types[node] == "b":
            if any(a in reached for a in args):
                reached.add(node)
        elif op == "select" and args[0] in reached:
            yield node
    if r.graph.traced.limits and r.graph.traced.limits.beyond.node in reached:
        yield r.graph.traced.limits.beyond.node


def differs_here(r: LinearizationPlan, node: int, edge: Edge, d: StepDerivative) -> bool:
    """Whether the branches of a selection differ, in value or in derivative."""
    g, values, rows = r.graph.graph, d.nodes.values, d.nodes.rows
    if g.ops[node] != "select":
        return True
    if node not in values or node not in r.choice.smooth:
        return False
    branches = g.args[node][1:]
    if not meet([values[n] for n in branches], [rows[n] for n in branches], edge.distance):
        return True
    one, other = (0.0 if rows[n] is None else rows[n] for n in branches)
    return not np.array_equal(one, other)


def alike(a: Array, b: Array, within: Array) -> bool:
    """Whether arrays agree within a tolerance; NaN agrees with nothing."""
    return bool(np.all(np.abs(a - b) <= within))


def kink_of(law: str, file: str, distances: list[float]) -> Kink:
    """The edges of a law in words."""
    nearest = min(distances)
    place = "on an edge" if nearest == 0.0 else f"{nearest:.1e} from an edge"
    times = f" ({len(distances)} times)" if len(distances) > 1 else ""
    return Kink(
        law, file, nearest, f"{law} in {file}: the point is {place}{times}, and the model holds on one side of it"
    )


def law_name(law: Callable[..., Any] | None) -> tuple[str, str]:
    """A law's name, and its file and first line."""
    if law is None:
        return "the step", "simulation/loop/step.py"
    path = Path(law.__code__.co_filename)
    shown = path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else path.name
    return law.__name__, f"{shown}, line {law.__code__.co_firstlineno}"


def near_margins(d: StepDerivative, tolerance: float) -> Iterator[tuple[int, float]]:
    """(Rotor, distance) of the thrusts that are about to be held at a limit, or to be released."""
    for one in d.margins:
        size = np.abs(one.row).max() if one.row.size else 0.0
        if size > 0.0 and abs(one.value) <= tolerance * size:
            yield one.rotor, abs(one.value) / size


def solver_kink(distances: dict[int, float]) -> Kink:
    """Rotors on the edge of the active set, by their index, in words."""
    file, nearest = "parts/rotors/thrust_limit_solver.py", min(distances.values())
    rotors = ", ".join(str(rotor + 1) for rotor in sorted(distances))
    text = (
        f"limited_thrusts in {file}: {nearest:.1e} from holding or releasing another rotor at its limit (of {rotors})"
    )
    return Kink("limited_thrusts", file, nearest, text)
