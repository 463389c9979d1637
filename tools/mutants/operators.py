"""All small mistakes that can be made in the functions of a source file: each a `Mutant`.

A mistake replaces one expression: + by −, < by <= or >, a number by another, min by max; it swaps the branches of a
`where`, leaves out a term, a factor, a sign or a clip, mixes up two arguments or two components, or negates a
condition. Numbers below `GUARD` keep roots and divisions from zero, whatever they are, and are left alone.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import NamedTuple

GUARD = 1e-6
MARKS = {"law", "choice", "elementwise", "linear"}  # decorators of laws, beside NAME.register(…)
APART = (
    ast.FunctionDef,
    ast.ClassDef,
    ast.JoinedStr,
    ast.Raise,
    ast.Import,
    ast.ImportFrom,
)  # left alone in a function
PAIRS = [
    (ast.Add, ast.Sub), (ast.Mult, ast.Div), (ast.And, ast.Or), (ast.Eq, ast.NotEq), (ast.In, ast.NotIn),
    (ast.Is, ast.IsNot), ("minimum", "maximum"), ("min", "max"), ("floor", "ceil"), ("any", "all"),
]  # fmt: skip
OTHER: dict = {**dict(PAIRS), **{b: a for a, b in PAIRS}, ast.FloorDiv: ast.Mult}
COMPARED = {
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.LtE),
}
CLIPS = {"clip", "minimum", "maximum", "absolute", "bounded"}  # of their first argument
ALIKE = {"where", "minimum", "maximum", "min", "max", "dot", "isinstance", "zip", "getattr", "range"}  # in either order


class Mutant(NamedTuple):
    """A small mistake: `file` from the package's folder, `function` by its qualified name, whether that is a law.

    `new` stands in the file from byte `begin` to `end`, which read `old` as Python writes it; `number` tells apart what
    reads alike in one function.
    """

    file: str
    function: str
    is_law: bool
    old: str
    new: str
    number: int
    begin: int
    end: int

    @property
    def name(self) -> str:
        """The name of the mistake, whatever else changes in the file."""
        return f"{self.file}: {self.function}: {self.old} -> {self.new}" + f" #{self.number}" * (self.number > 1)

    def made_in(self, source: bytes) -> bytes:
        """The source with the mistake."""
        return source[: self.begin] + f"({self.new})".encode() + source[self.end :]


def mutants(file: str, source: bytes) -> Iterator[Mutant]:
    """All mutants of a file, from its name and content."""
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for function, name, is_law in _functions(ast.parse(source), "", False):
        seen = Counter[tuple[str, str]]()
        for node in _expressions(function):
            old, begin = ast.unparse(node), starts[node.lineno - 1] + node.col_offset
            end = starts[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
            for new in sorted({ast.unparse(other) for other in _mistakes(node)} - {old}):
                seen[old, new] += 1
                yield Mutant(file, name, is_law, old, new, seen[old, new], begin, end)


def _functions(node: ast.AST, within: str, is_law: bool) -> Iterator[tuple[ast.FunctionDef, str, bool]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.FunctionDef):
            bare = [d.func if isinstance(d, ast.Call) else d for d in child.decorator_list]
            marked = any(getattr(d, "attr", "") == "register" or getattr(d, "id", "") in MARKS for d in bare)
            yield child, within + child.name, is_law or marked
            yield from _functions(child, f"{within}{child.name}.<locals>.", is_law or marked)
        else:
            yield from _functions(
                child, f"{within}{child.name}." if isinstance(child, ast.ClassDef) else within, is_law
            )


def _expressions(function: ast.FunctionDef) -> Iterator[ast.expr]:
    rest: list[ast.AST] = list(function.body)
    while rest:
        node = rest.pop(0)
        if isinstance(node, ast.expr):
            yield node
        if isinstance(node, ast.AnnAssign):
            rest += [node.value] if node.value else []
        elif not isinstance(node, APART):
            rest += ast.iter_child_nodes(node)


def _mistakes(node: ast.expr) -> Iterable[ast.expr]:
    match node:
        case ast.BinOp(left, op, right) if not _is_text(left) and not _is_text(right):
            if type(op) in OTHER:
                yield ast.BinOp(left, OTHER[type(op)](), right)
            if isinstance(op, (ast.Add, ast.Sub, ast.Mult, ast.Div)):
                yield left
                yield right if isinstance(op, (ast.Add, ast.Mult)) else ast.BinOp(right, op, left)
        case ast.BoolOp(op, values):
            yield from [ast.BoolOp(OTHER[type(op)](), values), *values]
        case ast.Compare(left, [op], [right]):
            yield from [ast.Compare(left, [o()], [right]) for o in COMPARED.get(type(op)) or [OTHER[type(op)]]]
        case ast.UnaryOp(ast.USub() | ast.Not(), operand):
            yield operand
        case ast.IfExp(test, body, orelse):
            yield ast.IfExp(test, orelse, body)
        case ast.Constant(bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(int(value) | float(value)) if value == 0 or abs(value) >= GUARD:
            yield ast.Constant(value + 1 if isinstance(value, int) or value == 0 else 2.0 * value)
        case ast.Attribute(value, "x" | "y" | "z" as axis):
            yield ast.Attribute(value, {"x": "y", "y": "z", "z": "x"}[axis])
        case ast.Call(ast.Name("where"), [condition, one, other]):
            yield ast.Call(node.func, [condition, other, one], [])
        case ast.Call(func, [first, *others]):
            name = getattr(func, "id", getattr(func, "attr", ""))
            if name in OTHER and isinstance(func, ast.Name):
                yield ast.Call(ast.Name(OTHER[name]), node.args, node.keywords)
            if name in CLIPS:
                yield first
            if name not in ALIKE and others and not isinstance(first, ast.Constant) and not _is_starred(first, *others):
                yield ast.Call(func, [others[0], first, *others[1:]], node.keywords)


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, (ast.JoinedStr, ast.List, ast.Tuple)) or isinstance(getattr(node, "value", None), str)


def _is_starred(*nodes: ast.expr) -> bool:
    return any(isinstance(node, ast.Starred) for node in nodes[:2])
