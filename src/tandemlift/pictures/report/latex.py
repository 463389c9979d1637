"""Tables in LaTeX, with the package booktabs: text and names escaped, numbers aligned at their decimal point."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable, Sequence

NOTHING = r"\multicolumn{2}{c}{--}"
NUMBER = "r@{}l"  # the column of a number: the part before its point, and the rest
SPECIAL = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "[": "{[}",  # after the end of a row it would open an argument
    "*": "{*}",
    "^": r"\textasciicircum{}",
    "·": r"$\cdot$",
    "−": "$-$",
    "–": "--",
    "’": "'",
    **{character: f"\\{character}" for character in "{}$&#_%"},
}
MOST_DIGITS = 10**9  # of a whole number that is written out
LETTERS = frozenset("ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÑÒÓÔÕÖØÙÚÛÜÝßàáâãäåæçèéêëìíîïñòóôõöøùúûüýÿ")  # that every LaTeX sets


def latex_text(text: str) -> str:
    """A text without commands; text in backquotes is set as code."""
    parts = [_escaped(part) for part in text.split("`")]
    return "".join(rf"\texttt{{{part}}}" if i % 2 else part for i, part in enumerate(parts))


def _escaped(text: str) -> str:
    return "".join(SPECIAL.get(character) or _letter(character) for character in text)


def _letter(character: str) -> str:
    if character in LETTERS or (character.isascii() and character.isprintable()):
        return character
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return _escaped(plain) if plain.isprintable() and plain else "?" if character.isprintable() else " "


def latex_number(value: float | str | None) -> str:
    """The two cells of a number, to four digits; a text or a truth value over both, and a dash for None."""
    if isinstance(value, (bool, str)):
        return rf"\multicolumn{{2}}{{c}}{{{latex_text(str(value).lower() if isinstance(value, bool) else value)}}}"
    if value is None or not math.isfinite(value):
        return NOTHING
    if float(value).is_integer() and abs(value) < MOST_DIGITS:
        value = int(value)
        return f"${re.sub(r'(?<=[0-9])(?=(?:[0-9]{3})+$)', chr(92) + ',', str(value))}$ &"
    digits, power = f"{value:.3e}".split("e")
    if -3 <= int(power) < 4:
        digits, power = f"{value:#.4g}", ""
    whole, _, rest = digits.partition(".")
    times = rf"\times 10^{{{int(power)}}}" if power else ""
    return f"${whole}$ & ${'.' + rest if rest else ''}{times}$" if rest or times else f"${whole}$ &"


def latex_table(columns: str, head: Sequence[str], rows: Iterable[Sequence[str]], note: str) -> str:
    """A table for a paper, in the size of footnotes; a row that begins with nothing belongs to the one before.

    Args:
        columns: as LaTeX takes them.
        head: cells of the first row, already in LaTeX.
        rows: cells of the others, in LaTeX; a number fills two columns.
        note: description of the table for readers of the file.
    """
    lines, said = [], note.translate(dict.fromkeys(map(ord, "\r\n"), " "))
    for row in rows:
        lines.append(" & ".join(row) + r" \\")
    body = "\n".join(lines)
    return (
        f"% {said}. In the preamble: \\usepackage{{booktabs}}\n"
        "{\\footnotesize\\setlength{\\tabcolsep}{4pt}%\n"
        f"\\begin{{tabular}}{{@{{}}{columns}@{{}}}}\n\\toprule\n{' & '.join(head)} \\\\\n\\midrule\n{body}\n"
        "\\bottomrule\n\\end{tabular}}\n"
    )
