"""The order of a block's operations: nothing is overwritten before its last reader, and few values wait."""

from __future__ import annotations

import random
from typing import Any

import pytest

import tandemlift as tl
from tandemlift.compiler.tracer import Graph
from tandemlift.compiler.tracer.order import (
    REGISTERS,
    NumbersInMemory,
    best_order,
    depth_first,
    early_stores,
    freeing_first,
    spills,
)
from tandemlift.simulation.plan import FlightPlan

STATE, OPERATIONS = 12, 80


def random_update(seed: int) -> tuple[Graph, dict[int, list[int]], list[int]]:
    """A graph, its operands, and the next state: operations, copies of old values, and values that stay."""
    chance, graph = random.Random(seed), Graph()
    inputs = [graph.input("state", i).node for i in range(STATE)]
    nodes = [*inputs, graph.input("given", 0).node]
    for _ in range(OPERATIONS):
        op, count = chance.choice([("fadd", 2), ("fmul", 2), ("fma", 3), ("fsub", 2)])
        nodes.append(graph.node(op, tuple(chance.choice(nodes[-20:] + inputs) for _ in range(count)), "f"))
    numbers = [chance.choice(nodes[-40:]) for _ in range(STATE)]
    numbers[2:5] = inputs[1:4]  # a delay line
    numbers[5], numbers[6], numbers[7] = inputs[6], inputs[5], inputs[7]  # two change places, one stays
    work = [n for n in graph.needed(numbers) if graph.ops[n] != "in"]
    return graph, {n: [a for a in dict.fromkeys(graph.args[n]) if a in set(work)] for n in work}, numbers


def value_of(graph: Graph, node: int, known: dict[int, Any], memory: list[Any]) -> Any:
    """An operation's value as the text of what it was computed from."""
    if graph.ops[node] == "in":
        kind, index = graph.args[node]
        return memory[index] if kind == "state" else kind
    return known[node]


def run(graph: Graph, order: list[int], numbers: list[int], stores: dict[int, list[int]]) -> list[Any]:
    """The memory after the operations in this order, with these stores; each operation reads memory when it runs."""
    memory: list[Any] = [f"old {i}" for i in range(STATE)]
    known: dict[int, Any] = {}
    for place, node in enumerate([-1, *order], -1):
        if node >= 0:
            known[node] = hash((graph.ops[node], *[value_of(graph, a, known, memory) for a in graph.args[node]]))
        new = [(i, value_of(graph, numbers[i], known, memory)) for i in stores.get(place, ())]
        for i, value in new:
            memory[i] = value
    return memory


@pytest.mark.parametrize("seed", range(10))
def test_no_number_is_stored_before_the_last_reader_of_the_old_one(seed):
    graph, operands, numbers = random_update(seed)
    to = NumbersInMemory(numbers, "state")
    in_order = list(operands)
    last = {len(in_order) - 1: list(range(STATE))}  # everything is computed before anything is written
    wanted = run(graph, in_order, numbers, last)
    deep = depth_first(operands, numbers)
    for order in (in_order, deep, freeing_first(operands, deep), freeing_first(operands, in_order)):
        assert sorted(order) == in_order
        stores = early_stores(graph, order, to, {})
        assert sorted(i for own in stores.values() for i in own) == [i for i in range(STATE) if i != 7]
        assert run(graph, order, numbers, stores) == wanted
    order, stores = best_order(graph, operands, to, {})
    assert run(graph, order, numbers, stores) == wanted


def test_spills_are_counted_by_the_farthest_next_use():
    """`REGISTERS` + 3 sums wait for their readers in the order of their creation: three go to memory and come back."""
    graph, many = Graph(), REGISTERS + 3
    first = [graph.node("fadd", (graph.input("a", i).node, graph.input("b", i).node), "f") for i in range(many)]
    total = [graph.node("fneg", (n,), "f") for n in first]
    operands = {n: [] for n in first} | {n: [a] for n, a in zip(total, first, strict=True)}
    to = NumbersInMemory(total, "c")
    assert count(graph, list(operands), operands, to) == 2 * 3
    order, stores = best_order(graph, operands, to, {})
    assert spills(order, stores, operands, to) == 0


def count(graph: Graph, order: list[int], operands: dict[int, list[int]], to: NumbersInMemory) -> int:
    """Spills of an order, with the stores that it allows."""
    return spills(order, early_stores(graph, order, to, {}), operands, to)


@pytest.mark.parametrize(("name", "most"), [("hover", 1.0), ("iris", 0.82)])
def test_the_chosen_order_of_a_mission_needs_no_more_spills_than_that_of_creation(name, most):
    x = FlightPlan(tl.load_mission(name)).loop_code.traced
    graph, numbers = x.graph, [s.node for s in x.next_state]
    work = [n for n in graph.needed(numbers) if graph.ops[n] not in ("in", "const")]
    among = set(work)
    operands = {n: [a for a in dict.fromkeys(graph.args[n]) if a in among] for n in work}
    to = NumbersInMemory(numbers, "fly")
    order, stores = best_order(graph, operands, to, {})
    assert spills(order, stores, operands, to) <= most * count(graph, work, operands, to)
