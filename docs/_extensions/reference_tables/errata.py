"""The errata of the paper, with their formulas as mathematics.

In `data/paper/errata.toml` a formula stands between dollars as one would type it: `$φ_d = atan(Q/u_z)$`.
"""

from __future__ import annotations

import re
import unicodedata
from itertools import groupby

from tandemlift.pictures.report.paper_figures import Erratum, errata, future_work

ACCENTS = {"\u0307": "dot", "\u0308": "ddot", "\u0302": "hat"}
FUNCTIONS = ("atan", "cos", "ln", "sat")
SYMBOLS = {"·": r"\cdot ", "×": r"\times ", "−": "-", "≤": r"\le ", "≥": r"\ge ", "‖": r"\Vert ", "|": r"\vert "}
SYMBOLS |= {"Σ": r"\sum ", "²": "^2", "ᵀ": "^T", "°": r"^\circ ", "%": r"\%"} | {
    d: f"_{i}" for i, d in enumerate("₀₁₂₃₄")
}
MARKED = re.compile(rf"(\w)([{''.join(ACCENTS)}])")
INDEXED = re.compile(r"_([^\W_]+)")
NAMED = re.compile(rf"\b({'|'.join(FUNCTIONS)})\b")


def errata_markdown() -> str:
    """A table of all errata with their classes, a section for each group, and one for each erratum."""
    rows = "\n".join(f"| `{one.about}` | {one.kind} | {typeset(one.title)} |" for one in errata())
    parts = [f"| label | class | error |\n|---|---|---|\n{rows}"]
    for group, members in groupby(errata(), key=lambda erratum: erratum.group):
        parts += [f"### {group}", *(_section(erratum) for erratum in members)]
    return "\n\n".join(parts) + "\n"


def future_markdown() -> str:
    """What the paper leaves to future work, and where we are, as a table."""
    rows = "\n".join(f"| {one['direction']} | {one['here']} | {one['missing']} |" for one in future_work())
    return f"| there | here | missing |\n|---|---|---|\n{rows}\n"


def _section(erratum: Erratum) -> str:
    setting = f" Setting: `{erratum.setting}`." if erratum.setting else ""
    return "\n".join(
        (
            f"#### `{erratum.about}`: {typeset(erratum.title)}",
            "",
            f"- Class: {erratum.kind}",
            f"- Printed: {typeset(erratum.printed)}",
            f"- Right: {typeset(erratum.right)}",
            f"- Shows: {typeset(erratum.shows)}{setting}",
            f"- Evidence: {', '.join(f'`{test}`' for test in erratum.evidence)}",
        )
    )


def typeset(text: str) -> str:
    """A text with its formulas in LaTeX."""
    parts = text.split("$")
    parts[1::2] = [f"${latex(formula)}$" for formula in parts[1::2]]
    return "".join(parts)


def latex(formula: str) -> str:
    """A typed formula in LaTeX: accents, indices, functions and operators."""
    whole = NAMED.sub(r"\\operatorname{\1}", formula)
    whole = MARKED.sub(lambda m: rf"\{ACCENTS[m[2]]}{{{m[1]}}}", _apart(whole))
    whole = INDEXED.sub(lambda m: f"_{{{m[1]}}}" if len(m[1]) == 1 else rf"_{{\mathrm{{{m[1]}}}}}", whole)
    return "".join(SYMBOLS.get(letter, letter) for letter in whole)


def _apart(text: str) -> str:
    """A text with accents after their letters; superscripts and indices stay as they are."""
    return "".join(unicodedata.normalize("NFD", letter) for letter in text)
