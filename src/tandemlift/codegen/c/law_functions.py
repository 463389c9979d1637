"""The function of C for a traced law, with its Python name, its docstring's first line, and its paper labels."""

from __future__ import annotations

import inspect
import re
from typing import Any

from tandemlift.codegen.c.function_text import FunctionHead, comment, function
from tandemlift.codegen.c.signatures import Signature, head
from tandemlift.codegen.c.statements import Statements
from tandemlift.codegen.c.unit import Unit

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
    result, given = head(signature, unit.structs, unit.real)
    body = Statements(unit, law.graph, [s.node for s in law.ends], law.locals)
    body.taken = unit.local_names(number)
    for p in signature.parameters:
        body.know(p.value, p.name, pointer=p.pointer)
    body.compute([s.node for s in law.ends])
    outs = list[str]()
    if signature.returns_many:
        for r in signature.results:
            kind = head(Signature("", (), (r,), ()), unit.structs, unit.real)[0]
            outs.append(f"{kind} *{body.taken.new(r.name if r.name != 'v' else 'result')}")
        last = "\n".join(
            f"*{out.split('*')[1]} = {body.value(r.value)};" for out, r in zip(outs, signature.results, strict=True)
        )
    else:
        last = f"return {body.value(signature.results[0].value)};"
    return function(
        FunctionHead(comment(description(law.law)), result, signature.name, [*given, *outs]), body.made, last
    )
