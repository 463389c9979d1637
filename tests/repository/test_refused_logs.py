"""The page "My log is refused" has the words that the code prints."""

import ast
import re
from pathlib import Path

from tandemlift.core.errors import unknown

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "how-to" / "my-log-is-refused.md"
SPEAKING = [  # modules whose refusals a log can meet
    *sorted((ROOT / "src" / "tandemlift" / "analysis" / "logs").glob("*.py")),
    *sorted((ROOT / "src" / "tandemlift" / "apps" / "export").glob("*.py")),
    *sorted((ROOT / "src" / "tandemlift" / "analysis" / "identification").glob("*.py")),
    ROOT / "src" / "tandemlift" / "parts" / "mechanics" / "payload_shape.py",
]
OTHERS = [str(unknown("column", "x", ["y"])), "could not convert string to float: 'x'"]  # as `float("x")` says


def said(path):
    """The texts of a module's strings, with … where a value stands."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.JoinedStr):
            yield "".join(part.value if isinstance(part, ast.Constant) else "…" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def rows():
    """The first cell of each row of the page's tables."""
    lines = [line for line in PAGE.read_text("utf-8").splitlines() if line.startswith("| ")]
    return [re.split(r"(?<!\\) \| ", line[2:])[0] for line in lines if not line.startswith("| it says")]


def test_each_row_of_refused_logs_has_words_that_the_code_says():
    texts = [text for path in SPEAKING for text in said(path)] + OTHERS
    cells = rows()
    assert len(cells) > 30
    strange = [
        (cell, part)
        for cell in cells
        for part in (piece.strip(" .,?") for piece in cell.split("…"))
        if part and not any(part in text for text in texts)
    ]
    assert strange == []
