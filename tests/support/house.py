"""Shared by the tests of rules about the source: its files."""

import ast
import functools
from pathlib import Path

from repository import ROOT

PACKAGE, TESTS = ROOT / "src" / "tandemlift", ROOT / "tests"


@functools.cache
def python_files(folder: Path) -> dict[str, tuple[int, ast.Module]]:
    """Each Python file below a folder, by its path from the root: its number of lines, and its syntax tree."""
    texts = {str(p.relative_to(ROOT)): p.read_text("utf-8") for p in sorted(folder.rglob("*.py"))}
    return {name: (len(text.splitlines()), ast.parse(text)) for name, text in texts.items()}


def assert_none(found, advice):
    """Nothing breaks a rule; `advice` says what to do where something does."""
    assert sorted(found) == [], f"{advice}\n" + "\n".join(sorted(found))
