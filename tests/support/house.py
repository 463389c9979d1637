"""Shared by the tests of rules about the source: its files, and lists of known exceptions."""

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


def assert_none_but(known, found, advice):
    """All exceptions are known, and all known ones are still exceptions: the list can only shrink."""
    new, gone = sorted(set(found) - set(known)), sorted(set(known) - set(found))
    assert new == [], f"{advice}\n" + "\n".join(new)
    assert gone == [], "these keep the rule now: take them out of KNOWN\n" + "\n".join(gone)
