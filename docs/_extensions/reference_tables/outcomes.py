"""The tables of outcomes, of reasons to stop a flight, and of findings."""

from __future__ import annotations

from reference_tables.markdown import codes, linked, table
from tandemlift.core.findings import KINDS
from tandemlift.core.phases import ENDINGS, OUTCOMES


def outcomes() -> str:
    """Every outcome, with its exit code."""
    rows = [(f"`{kind.name}`", kind.meaning, "3" if kind.failed else "0") for kind in OUTCOMES]
    return table(("outcome", "meaning", "exit code"), rows)


def endings() -> str:
    """Every reason to stop a flight before its end."""
    rows = [(f"{kind.outcome}: {kind.quantity}", kind.condition) for kind in ENDINGS]
    return table(("ending", "flight is stopped when"), rows)


def findings() -> str:
    """Every kind of finding."""
    rows = [(f"`{kind.name}`", linked(kind.meaning), linked(kind.remedy), codes(kind.keys)) for kind in KINDS]
    return table(("kind", "meaning", "remedy", "keys"), rows)
