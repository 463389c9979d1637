"""The function that flies many blocks one after another from one call of Python."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tandemlift.compiler.tracer import Function

CALL = ("contexts", "first", "end", "stop", "actions", "rows", "lanes", "place", "halted")  # words of `fly_blocks`
SELDOM = "before", "sample", "solving", "exact"  # parts of scratch memory that few steps use


def write_many_blocks(step: Any, words: Mapping[str, int]) -> None:
    """`fly_blocks`: hand the caller's actions to some blocks, and fly each on to a step, or to where a flight halts it.

    `halted` counts the blocks that a flight halts. `step`: a `LoopWriter`; `words`: places in the context of a block.
    """
    f = Function(step.module, step.graph, 1, "i64 @fly_blocks(ptr %call) #0")
    word = {
        name: f.load("%call", i, "ptr" if name in ("contexts", "actions") else "i64") for i, name in enumerate(CALL)
    }
    vector, halted = step.vector, CALL.index("halted")
    with f.repeat(word["end"], word["first"]) as b:
        context = f.at(word["contexts"], f.integer("mul", b, len(words)), "i64")
        work = f.load(context, words["work"], "ptr")
        following = f.integer("add", b, 1)
        with f.when(f.op(f"icmp slt i64 {following}, {word['end']}")):
            _fetch_ahead(step, f, words, f.at(word["contexts"], f.integer("mul", following, len(words)), "i64"))
        with f.repeat(word["rows"]) as row:
            number = f.integer("add", f.integer("mul", row, word["lanes"]), f.integer("mul", b, step.lanes))
            given = f.op(f"load {vector}, ptr {f.at(word['actions'], number, step.real)}, align 8")
            f.store(given, work, f.integer("add", row, word["place"]), vector)
        f.store(word["stop"], context, words["stop"], "i64")
        f.store(f.integer("sub", word["stop"], 1), context, words["show"], "i64")
        reached = f.op(f"call i64 @fly(ptr {context})")
        f.store(reached, context, words["k"], "i64")
        f.store("0", context, words["fresh"], "i64")
        with f.when(step.is_halted(f, f.load(context, words["flight"], "ptr"), work)):
            f.store(f.integer("add", f.load("%call", halted, "i64"), 1), "%call", halted, "i64")
    f.end("i64 0")


def _fetch_ahead(step: Any, f: Function, words: Mapping[str, int], context: str) -> None:
    """Bring a block's state, and what each step uses of its scratch memory, close to the processor."""
    f.module.declared.add("declare void @llvm.prefetch.p0(ptr, i32, i32, i32)")
    used = [span for name, span in step.scratch.spans.items() if name not in SELDOM and span[1]]
    for kind, spans in (("flight", [(0, step.state_size), (step.numbers, len(step.traced.rests))]), ("work", used)):
        memory = f.load(context, words[kind], "ptr")
        for first, size in spans:
            with f.repeat(first + size, first) as i:
                f.do(f"call void @llvm.prefetch.p0(ptr {f.at(memory, i, step.vector)}, i32 0, i32 2, i32 1)")
