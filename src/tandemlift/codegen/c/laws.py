"""Functions of C for traced laws, with Python name, first lines of the docstring and paper labels; calls of them."""

from __future__ import annotations

import inspect
import itertools
import re
from collections.abc import Callable, Iterable
from typing import Any

from tandemlift.codegen.c.source import Unit
from tandemlift.codegen.c.statements import Statements
from tandemlift.codegen.c.text import FunctionHead, comment, function
from tandemlift.compiler.tracer.structured import TracedLaw
from tandemlift.core.types import leaves

LABEL = re.compile(r"#\s*(paper: .+)")


def description(law: Any) -> list[str]:
    """The lines of a law's comment."""
    doc = (inspect.getdoc(law) or "").split("\n\n")[0].split("\n")
    try:
        labels = LABEL.findall(inspect.getsource(law))
    except (OSError, TypeError):
        labels = []
    return [f"{law.__module__}.{law.__qualname__}", *[line for line in doc if line], *labels]


def law_function(unit: Unit, number: int) -> str:
    """The function of a law by its number."""
    law, signature = unit.laws.all[number], unit.signature(number)
    result = "void" if signature.returns_many else unit.type_of(signature.results[0].value)
    roots = [s.node for s in law.ends]
    body = Statements(unit, law.graph, roots, law.locals)
    body.taken = unit.local_names(number)
    given = [body.argument(p.name, p.value, pointer=p.pointer) for p in signature.parameters]
    body.compute(roots)
    if signature.returns_many:
        outs = [body.taken.new("result" if r.name == "v" else r.name) for r in signature.results]
        given += [f"{unit.type_of(r.value)} *{out}" for out, r in zip(outs, signature.results, strict=True)]
        last = "\n".join(f"*{out} = {body.value(r.value)};" for out, r in zip(outs, signature.results, strict=True))
    else:
        last = f"return {body.value(signature.results[0].value)};"
    return function(FunctionHead(comment(description(law.law)), result, signature.name, given), body.made, last)


def write_functions(unit: Unit, numbers: Iterable[int]) -> None:
    """Add the functions of laws to a file, but those that it has."""
    for number in numbers:
        if number not in unit.written:
            unit.written.add(number)
            unit.texts.append(law_function(unit, number))


def write_call(unit: Unit, law: Callable[..., Any], arguments: dict[str, tuple[Any, str]]) -> tuple[TracedLaw, str]:
    """Add a law to a file.

    Args:
        unit: the file.
        law: the law, or any function of laws.
        arguments: by name, a value laid out like each, and its text in C.

    Returns:
        The traced law, and a call of its function.
    """
    traced = unit.laws.trace(law, {name: like for name, (like, _) in arguments.items()})
    write_functions(unit, unit.needed(traced))
    signature, texts = unit.signature(traced.number), list[str]()
    firsts = itertools.accumulate([leaves(like) for like, _ in arguments.values()], initial=0)
    values = dict(zip(firsts, [text for _, text in arguments.values()], strict=False))
    for p in signature.parameters:
        value = values[p.first]
        texts.append((value[1:] if value.startswith("*") else f"&{value}") if p.pointer else value)
    return traced, f"{signature.name}({', '.join(texts)})"
