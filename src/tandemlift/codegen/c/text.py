"""The text of functions of C: statements in lines of moderate length, and long functions in parts.

Names of variables stand between marks until the text is complete, because a variable that several parts of a function
use is a member of a struct.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from typing import Any, NamedTuple

WIDTH = 110
BRACE_LENGTH = 50  # characters in braces that stay together
MAX_LINES = 240  # lines of a function
PART = 180  # lines of a part of a longer one
BEGIN, END = "\x01", "\x02"
TOKEN = re.compile(f"{BEGIN}(\\w+){END}")
VARIABLE = re.compile(r"(?<![\w.])(?<!->)[A-Za-z]\w*")  # a name that is not a member's
JOINED = "\x03"  # a space at which no line is broken
BRACES = re.compile(r"([^{]*\{+)(.*?)(\}+[^}]*)")
AS_THEY_ARE: dict[str, Any] = {"break_long_words": False, "break_on_hyphens": False}


class Statement(NamedTuple):
    """A statement: `kind` "value" defines one variable by `text`, "call" passes variables' addresses, "raw" is a line.

    `variables`: (type, name) of each. `depth`: branches around it. `joins`: whether it belongs to the one before.
    """

    kind: str
    variables: tuple[tuple[str, str], ...]
    text: str
    depth: int = 0
    joins: bool = False


class FunctionHead(NamedTuple):
    """The head of a function: comment, type of the result, name, parameters."""

    comment: str
    result: str
    name: str
    parameters: Sequence[str]

    @property
    def text(self) -> str:
        """The lines up to the body."""
        given = ", ".join(p.replace(" ", JOINED) for p in self.parameters) or "void"
        line = f"static {self.result} {self.name}({given})"
        return self.comment + wrapped(line, "")


def token(name: str) -> str:
    """A variable's name between marks."""
    return f"{BEGIN}{name}{END}"


def wrapped(line: str, indent: str = "    ") -> str:
    """A line broken if it is too long, and indented; a list in braces has a line for each member."""
    if len(indent + line) <= WIDTH:
        return indent + line.replace(JOINED, " ")
    found = BRACES.fullmatch(line)
    if not found or len(found[2]) < BRACE_LENGTH or len(indent + found[1]) > WIDTH or not _is_balanced(found[2]):
        deeper = indent + "    "
        text = textwrap.fill(line, WIDTH, initial_indent=indent, subsequent_indent=deeper, **AS_THEY_ARE)
        return text.replace(JOINED, " ")
    items = _items(found[2])
    inner = [wrapped(item + "," * (i < len(items) - 1), indent + "    ") for i, item in enumerate(items)]
    return "\n".join([indent + found[1], *inner, indent + found[3]])


def _is_balanced(text: str) -> bool:
    depth = 0
    for c in text:
        depth += (c in "({") - (c in ")}")
        if depth < 0:
            return False
    return depth == 0


def _items(text: str) -> list[str]:
    """The parts of a text between commas that stand in no brackets."""
    items, depth = [""], 0
    for c in text:
        depth += (c in "({") - (c in ")}")
        if c == "," and depth == 0:
            items.append("")
        else:
            items[-1] += c
    return [item.strip() for item in items]


def comment(lines: Sequence[str]) -> str:
    """A comment of C."""
    safe = [line.replace("*/", "* /").replace("/*", "/ *") for line in lines]
    return "/* " + "\n * ".join(safe) + " */\n"


def without_unused(statements: Sequence[Statement], last: str) -> list[Statement]:
    """Statements without those whose variable nobody reads; `last`: the text behind them."""
    read, kept = set(TOKEN.findall(last)), list[Statement]()
    for statement in reversed(statements):
        if statement.kind == "value" and statement.variables[0][1] not in read:
            continue
        read |= set(TOKEN.findall(statement.text))
        kept.append(statement)
    return kept[::-1]


def _lines(statement: Statement, shared: set[str]) -> list[str]:
    """The lines of a statement; `shared`: variables that are members of the struct of the parts."""
    text = TOKEN.sub(lambda m: f"shared->{m[1]}" if m[1] in shared else m[1], statement.text)
    indent = "    " * (1 + statement.depth)
    if statement.kind == "raw":
        return [line for given in text.split("\n") for line in wrapped(given, indent).split("\n")]
    if statement.kind == "call":
        own = [f"{indent}{kind} {name};" for kind, name in statement.variables if name not in shared]
        return [*own, *(wrapped(text + ";", indent).split("\n") if text else [])]
    kind, name = statement.variables[0]
    if name in shared:
        line = f"shared->{name} = ({kind}){text};" if text.startswith("{") else f"shared->{name} = {text};"
    else:
        line = f"const {kind} {name} = {text};"
    return wrapped(line, indent).split("\n")


def function(head: FunctionHead, statements: Sequence[Statement], last: str) -> str:
    """A function, in parts if it is long; `last`: its last statements, as text with marks."""
    kept = without_unused(statements, last)
    end = Statement("raw", (), last)
    lines = [line for s in [*kept, end] for line in _lines(s, set())]
    if len(lines) <= MAX_LINES:
        return "\n".join([head.text, "{", *[line for line in lines if line.strip()], "}", ""])
    return _in_parts(head, kept, end)


def _in_parts(head: FunctionHead, statements: list[Statement], end: Statement) -> str:
    parts: list[list[Statement]] = [[]]
    length = 0
    for statement in statements:
        more = len(_lines(statement, set()))
        if length + more > PART and parts[-1] and not statement.joins and not statement.depth:
            parts.append([])
            length = 0
        parts[-1].append(statement)
        length += more
    home = {name: i for i, part in enumerate(parts) for s in part for _, name in s.variables}
    kinds = {name: kind for s in statements for kind, name in s.variables}
    shared = {n for i, part in enumerate(parts) for s in part for n in TOKEN.findall(s.text) if home[n] != i}
    shared |= set(TOKEN.findall(end.text))
    values = f"{head.name}_values"
    members = [f"    {kinds[n]} {n};" for n in home if n in shared]
    text = ["typedef struct {", *members, f"}} {values};", ""] if members else []
    calls = [f"    {values} shared[1];"] if members else []
    for i, part in enumerate(parts):
        body = [line for s in part for line in _lines(s, shared)]
        words = set(VARIABLE.findall("\n".join(body)))
        given = [p for p in [*head.parameters, f"{values} *shared"] if p.split()[-1].lstrip("*") in words]
        note = comment([f"Part {i + 1} of {len(parts)} of {head.name}."])
        name = f"{head.name}_part{i + 1}"
        text += [FunctionHead(note, "void", name, given).text, "{", *body, "}", ""]
        calls.append(wrapped(f"{name}({', '.join(p.split()[-1].lstrip('*') for p in given)});"))
    ending = [line for line in _lines(end, shared) if line.strip()]
    text += [head.text, "{", *calls, *ending, "}", ""]
    return "\n".join(text)
