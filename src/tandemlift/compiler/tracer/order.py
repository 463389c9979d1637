"""The order of the operations of a block, in which few values wait for their readers.

A processor holds some thirty vectors. LLVM keeps the order of the text, more or less, and stores what does not fit.
"""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Container, Mapping, Sequence
from typing import NamedTuple

from tandemlift.compiler.tracer.graph import Graph

REGISTERS = 30  # vectors that the processor holds, beside one or two that an operation needs for a moment
VALUES_ALIVE = 28  # values alive, from which on freeing registers comes first
PROGRAM_SIZE = 2_000  # operations, up to which the longest chain bounds the time more than spills do
CYCLES = {"fma": 4, "fmul": 3, "fadd": 3, "fsub": 3, "fdiv": 13, "sqrt": 20, "select": 2}  # approximate latency
Operands = Mapping[int, Sequence[int]]
Stores = dict[int, list[int]]


class NumbersInMemory(NamedTuple):
    """Numbers to be written to consecutive memory, over the inputs of a kind, but those `not_now`; `more` are kept."""

    numbers: Sequence[int]
    kind: str
    more: Sequence[int] = ()
    not_now: Container[int] = ()


def best_order(
    graph: Graph, operands: Operands, to: NumbersInMemory, same: Mapping[int, int], *, seldom: bool = False
) -> tuple[list[int], Stores]:
    """The order of few waiting values, and which numbers are stored after each place in it; place −1: before all.

    `operands`: of each node, in order of creation, those among the nodes. `same`: inputs that other nodes compute.
    `seldom`: whether the code runs seldom, and the order of creation serves.
    """
    created = list(operands)
    plan = created, early_stores(graph, created, to, same)
    if seldom or len(created) <= REGISTERS or not (least := spills(*plan, operands, to)):
        return plan
    if len(created) <= PROGRAM_SIZE:
        chain = urgency(graph, operands)
        wish = sorted(created, key=lambda node: (-chain[node], node))
    else:
        wish = depth_first(operands, sorted({*to.numbers, *to.more}))
    order = freeing_first(operands, wish)
    other = order, early_stores(graph, order, to, same)
    return other if spills(*other, operands, to) <= least else plan


def early_stores(graph: Graph, order: Sequence[int], to: NumbersInMemory, same: Mapping[int, int]) -> Stores:
    """Which numbers are stored after each place of an order: each once it is known and nothing reads the old one."""
    args, replaced = graph.args, dict[int, int]()
    for node in {*to.numbers, *[a for n in order for a in args[n]]} if to.kind else ():
        own = same.get(node, node)
        if graph.ops[own] == "in" and args[own][0] == to.kind:
            replaced[node] = args[own][1]
    reads = {node: [replaced[a] for a in dict.fromkeys(args[node]) if a in replaced] for node in order if to.kind}
    copies = {i: replaced[node] for i, node in enumerate(to.numbers) if node in replaced}
    left = Counter([i for own in reads.values() for i in own] + [j for i, j in copies.items() if i != j])
    waits = {i for i in range(len(to.numbers)) if copies.get(i) != i and i not in to.not_now}
    results, stores = dict[int, list[int]](), Stores()
    for i in waits:
        results.setdefault(to.numbers[i], []).append(i)
    unknown = results.keys() & set(order)
    for place, node in enumerate([-1, *order] if waits else [], -1):
        unknown.discard(node)
        for i in reads.get(node, ()):
            left[i] -= 1
        may = [*waits] if place < 0 else [*results.get(node, ()), *reads.get(node, ())]
        while may:
            i = may.pop()
            if i in waits and not left[i] and to.numbers[i] not in unknown:
                waits.remove(i)
                stores.setdefault(place, []).append(i)
                if i in copies:
                    left[copies[i]] -= 1
                    may.append(copies[i])
    if waits:  # copies in a circle, which are read before any of them is written
        stores.setdefault(len(order) - 1, []).extend(sorted(waits))
    return stores


def urgency(graph: Graph, operands: Operands) -> dict[int, int]:
    """Cycles of the longest chain of operations that waits for each node."""
    after = dict.fromkeys(operands, 0)
    for node in reversed(list(operands)):
        cycles = after[node] + CYCLES.get(graph.ops[node], 1)
        for operand in operands[node]:
            after[operand] = max(after[operand], cycles)
    return after


def depth_first(operands: Operands, roots: Sequence[int]) -> list[int]:
    """Each root whole, and of operands the one first that needs more registers (Sethi and Ullman)."""
    need, order, seen = dict[int, int](), list[int](), set[int]()
    for node, own in operands.items():
        most = sorted([need[operand] for operand in own], reverse=True)
        need[node] = max([1, *[n + i for i, n in enumerate(most)]])
    stack = [(node, False) for node in (*reversed(list(operands)), *reversed(roots)) if node in need]
    while stack:
        node, is_ready = stack.pop()
        if is_ready:
            order.append(node)
        elif node not in seen:
            seen.add(node)
            stack += [(node, True), *[(operand, False) for operand in sorted(operands[node], key=need.__getitem__)]]
    return order


def freeing_first(operands: Operands, wish: Sequence[int]) -> list[int]:
    """A wished order, but while many values wait, those first that free most registers (Goodman and Hsu)."""
    place, readers = {node: i for i, node in enumerate(wish)}, {node: list[int]() for node in wish}
    for node, own in operands.items():
        for operand in own:
            readers[operand].append(node)
    left, missing = ({node: len(of[node]) for node in wish} for of in (readers, operands))
    frees = Counter([own[0] for own in readers.values() if len(own) == 1])
    ready = [i for i, node in enumerate(wish) if not missing[node]]
    freeing = [ready[:], *[list[int]() for _ in range(3)]]
    order, written, alive = list[int](), set[int](), 0

    def next_node() -> int:
        for number in (3, 2, 1, 0) if alive >= VALUES_ALIVE else (-1,):
            queue = ready if number < 0 else freeing[number]
            while queue:
                node = wish[heapq.heappop(queue)]
                if node not in written and (number < 0 or number == frees[node]):
                    return node
        raise AssertionError("an operation waits for itself")

    while len(order) < len(wish):
        node = next_node()
        order.append(node)
        written.add(node)
        alive += (left[node] > 0) - frees[node]
        for operand in operands[node]:
            left[operand] -= 1
            if left[operand] == 1:
                last = next(reader for reader in readers[operand] if reader not in written)
                frees[last] += 1
                if not missing[last]:
                    heapq.heappush(freeing[frees[last]], place[last])
        for reader in readers[node]:
            missing[reader] -= 1
            if not missing[reader]:
                heapq.heappush(ready, place[reader])
                heapq.heappush(freeing[frees[reader]], place[reader])
    return order


def spills(order: Sequence[int], stores: Mapping[int, Sequence[int]], operands: Operands, to: NumbersInMemory) -> int:
    """Stores and loads of values that do not fit into the registers: the farthest next use goes first (Belady)."""
    uses: dict[int, list[int]] = {node: [] for node in order}
    read = {place: [n for n in {to.numbers[i] for i in own} if n in uses] for place, own in stores.items()}
    read.setdefault(len(order) - 1, []).extend(n for n in set(to.more) if n in uses)
    for place in range(len(order) - 1, -1, -1):
        for node in (*read.get(place, ()), *operands[order[place]]):
            uses[node].append(place)
    saved, held, moves = set[int](), set[int](), 0
    for place, node in enumerate(order):
        now = *operands[node], *read.get(place, ())
        for value in now:
            moves += value not in held and value != node
            uses[value].pop()
        for value in (*now, node):
            if uses[value]:
                held.add(value)
            else:
                held.discard(value)
        while len(held) > REGISTERS:
            out = max(held, key=lambda value: uses[value][-1])
            held.remove(out)
            moves += out not in saved
            saved.add(out)
    return moves
