"""The statements of a function of C, made from a graph: a variable where a value has a name or is used twice.

Values that the law calls by a name have that name here. A vector that it names is a struct here, which is passed on as
a whole. All other operations stand where they are used.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from tandemlift.codegen.c.expressions import ATOM, CHOSEN, UNARY, Expression, expression, literal
from tandemlift.codegen.c.names import Names
from tandemlift.codegen.c.source import Unit
from tandemlift.codegen.c.text import Statement, token
from tandemlift.codegen.c.types import Struct, parts_of, type_name
from tandemlift.codegen.c.variables import Group, Variables
from tandemlift.compiler.tracer import Graph
from tandemlift.compiler.tracer.structured import as_symbol, calls_in, is_nested, nodes_of, numbers_in

UNNAMED_MEMBERS = 4  # numbers of a struct whose members need no names where it is written


class StructVariable(NamedTuple):
    """A struct that exists in the function: its value and its address."""

    value: str
    address: str


class Statements:
    """The statements that compute nodes of a graph.

    Args:
        unit: the file of C.
        graph: the graph.
        roots: all nodes that will be needed.
        names: the local names of the law, and their values.

    Attributes:
        made: the statements so far.
        taken: the names of the function.
    """

    def __init__(self, unit: Unit, graph: Graph, roots: Iterable[int], names: dict[str, Any] | None = None) -> None:
        self.unit, self.graph, self.made = unit, graph, list[Statement]()
        roots = list(roots)
        self.taken = Names([unit.signature(n).name for n in calls_in(graph, roots)])
        self._text: dict[int, Expression] = {}
        self._existing: dict[Any, StructVariable] = {}
        self._done = set[int | float]()
        self._depth = 0
        self._variables = Variables(unit, graph, roots, names or {})

    # what exists

    def know(self, value: Any, name: str, *, pointer: bool = False) -> None:
        """Numbers of a nested value are in a variable of C, or behind a pointer."""
        existing = StructVariable(f"*{name}" if pointer else name, name if pointer else f"&{name}")
        self._know(value, existing, f"{name}->" if pointer else f"{name}.")

    def _know(self, value: Any, existing: StructVariable, access: str) -> None:
        if not is_nested(value):
            self._text[as_symbol(self.graph, value).node] = Expression(
                existing.value, UNARY if existing.value[0] == "*" else ATOM
            )
            return
        self._existing.setdefault((self.unit.structs.of(value), tuple(nodes_of(self.graph, value))), existing)
        for name, part in parts_of(value):
            self._know(part, StructVariable(access + name, "&" + access + name), access + name + ".")

    def argument(self, name: str, value: Any, *, pointer: bool = False) -> str:
        """The declaration of an argument of the function, which is, or points to, the numbers of a nested value."""
        self.know(value, name, pointer=pointer)
        kind = self.unit.type_of(value)
        return f"const {kind} *{name}" if pointer else f"{kind} {name}"

    # branches

    def _add(self, kind: str, variables: tuple[tuple[str, str], ...], text: str, joins: bool = False) -> None:
        self.made.append(Statement(kind, variables, text, self._depth, joins))

    def line(self, text: str) -> None:
        """A line as it is; names of variables stand between marks."""
        self._add("raw", (), text)

    def variable(self, value: Any, wish: str) -> str:
        """A variable of a nested value's type, which the caller fills: its name between marks."""
        name = self._new(wish)
        self._add("call", ((self.unit.type_of(value), name),), "")
        self.know(value, token(name))
        return token(name)

    @contextmanager
    def branch(self, opening: str, last: bool) -> Iterator[None]:
        """Lines in braces; values computed inside are known only inside. `last`: no other branch follows."""
        self._add("raw", (), opening, joins=opening.startswith("}"))
        before = dict(self._text), dict(self._existing), set(self._done)
        self._depth += 1
        yield
        self._depth -= 1
        self._text, self._existing, self._done = before
        if last:
            self._add("raw", (), "}", joins=True)

    # statements

    def compute(self, roots: Iterable[int]) -> None:
        """Write the statements that nodes need and that are not written yet."""
        g = self.graph
        needed = g.needed(roots, self._text)
        inside = set(needed)
        events: list[tuple[float, Any]] = [(n, n) for n in needed if self._needs_statement(n)]
        events += [
            (q.at + 0.5, q)
            for q in self._variables.groups
            if q.at + 0.5 not in self._done and inside.issuperset(n for n in q.nodes if self._variables.is_operation(n))
        ]
        for at, what in sorted(events, key=lambda event: event[0]):
            if at in self._done:
                continue
            self._done.add(at)
            self._write_group(what) if isinstance(what, Group) else self._write_node(what)

    def _needs_statement(self, node: int) -> bool:
        op = self.graph.ops[node]
        return node in self._variables.named or (
            op.startswith("call ") and not self._variables.signature(node).returns_number
        )

    def _write_node(self, node: int) -> None:
        g = self.graph
        if g.ops[node].startswith("call "):
            self._write_call(node)
            return
        text = self.number(node).text
        name = self._new(self._variables.local.get(node, "v"))
        self._add("value", ((type_name(g.types[node], self.unit.real), name),), text)
        self._text[node] = Expression(token(name), ATOM)

    def _write_group(self, group: Group) -> None:
        struct = self.unit.structs.of(group.value)
        if (struct, group.nodes) in self._existing:
            return
        text = self._initialiser(group.value)
        name = self._new(group.name)
        self._add("value", ((struct.name, name),), text)
        self.know(group.value, token(name))

    def _write_call(self, call: int) -> None:
        signature = self._variables.signature(call)
        ends = self.unit.results_of(self.graph, call)
        names = []
        for (wish, like), value in zip(signature.results, ends, strict=True):
            nodes = tuple([x.node for x in numbers_in(value)])
            struct = self.unit.structs.of(like)
            wish = (
                self._variables.parts.get(
                    nodes, self._variables.local.get(nodes[0], "") if not is_nested(value) else ""
                )
                or wish
            )
            names.append((type_name(struct, self.unit.real), self._new(wish)))
        text = self._call_text(call, [f"&{token(name)}" for _, name in names] if signature.returns_many else [])
        self._add("call" if signature.returns_many else "value", tuple(names), text)
        for (_, name), value in zip(names, ends, strict=True):
            self.know(value, token(name))

    def _new(self, wish: str) -> str:
        if wish == "v":
            return self.taken.numbered("v")
        return self.taken.new(wish)

    # expressions

    def number(self, node: int) -> Expression:
        """A number as an expression."""
        g = self.graph
        op = g.ops[node]
        if op == "const":
            return Expression(literal(g.args[node][0], g.types[node], self.unit.real), ATOM)
        if node in self._text:
            return self._text[node]
        if op.startswith("out "):
            call = g.args[node][0]
            assert self._variables.signature(call).returns_number, f"a result of {op} before its call"
            return Expression(self._call_text(call, []), ATOM)
        assert op != "in", f"an input without a place: {g.args[node]}"
        operands = [self.number(a) for a in g.args[node]]
        return expression(op, g.types[node], g.types[g.args[node][0]], operands, self.unit.real)

    def _call_text(self, call: int, more: list[str]) -> str:
        signature, given = self._variables.signature(call), self.graph.args[call]
        every, used = self.unit.laws.given[self.graph, call], iter(given)
        places = set(signature.used)
        nodes = [next(used) if i in places else -1 - n for i, n in enumerate(every)]
        arguments = []
        for parameter in signature.parameters:
            mine = nodes[parameter.first : parameter.first + parameter.size]
            arguments.append(self._argument(parameter.value, mine, parameter.pointer))
        return f"{signature.name}({', '.join([*arguments, *more])})"

    def _argument(self, like: Any, nodes: list[int], pointer: bool) -> str:
        if not is_nested(like):
            return self.number(nodes[0]).within(CHOSEN)
        struct = self.unit.structs.of(like)
        existing = self._found(struct, nodes)
        if existing is not None:
            return existing.address if pointer else existing.value
        literal_text = f"{struct.name}){self._initialiser(like, nodes)}"
        return f"&(const {literal_text}" if pointer else f"({literal_text}"

    def _found(self, struct: Any, nodes: list[int]) -> StructVariable | None:
        """The struct that holds nodes, those without use among them."""
        return self._existing.get((struct, tuple([n if n >= 0 else -1 - n for n in nodes])))

    def value(self, value: Any) -> str:
        """A nested value, or a number, as an expression."""
        return self._argument(value, nodes_of(self.graph, value), pointer=False)

    def address(self, value: Any) -> str:
        """The address of a nested value, of a copy if it stands nowhere."""
        return self._argument(value, nodes_of(self.graph, value), pointer=True)

    def _initialiser(self, like: Any, nodes: list[int] | None = None) -> str:
        """Members in braces; a node below 0 is one without use."""
        if nodes is None:
            nodes = nodes_of(self.graph, like)
        struct: Struct = self.unit.structs.of(like)
        texts, first = [], 0
        for name, part in parts_of(like):
            size = len(list(numbers_in(part)))
            text = self._member(part, nodes[first : first + size])
            texts.append(text if struct.is_set or struct.size <= UNNAMED_MEMBERS else f".{name} = {text}")
            first += size
        inner = ", ".join(texts)
        return f"{{{{{inner}}}}}" if struct.is_set else f"{{{inner}}}"

    def _member(self, part: Any, nodes: list[int]) -> str:
        if not is_nested(part):
            return self.number(nodes[0]).text if nodes[0] >= 0 else "0"
        struct = self.unit.structs.of(part)
        existing = self._found(struct, nodes)
        return existing.value if existing else self._initialiser(part, nodes)
