"""BibTeX entries of the paper and of the software, from CITATION.cff."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from textwrap import fill
from typing import Any

import yaml

FILE = Path(__file__).parents[3] / "CITATION.cff"


def bibtex() -> str:
    """A block of code with both entries."""
    cited = yaml.safe_load(FILE.read_text("utf-8"))
    (paper,) = cited["references"]
    article = {
        "author": _authors(paper["authors"]),
        "title": _title(paper["title"]),
        "journal": paper["journal"],
        "volume": paper["volume"],
        "pages": paper["start"],
        "year": paper["year"],
        "doi": paper["doi"],
    }
    software = {
        "author": _authors(cited["authors"]),
        "title": _title(cited["title"]),
        "version": cited["version"],
        "year": str(cited["date-released"])[:4],
        "note": f"{cited['license']} licence",
    }
    first = paper["authors"][0]["family-names"].lower()
    entries = _entry("article", f"{first}{paper['year']}", article), _entry("misc", cited["title"], software)
    return "```bibtex\n" + "\n\n".join(entries) + "\n```\n"


def _entry(kind: str, key: str, fields: Mapping[str, Any]) -> str:
    lines = [fill(f"  {name:8}= {{{value}}},", 80, subsequent_indent=" " * 13) for name, value in fields.items()]
    return "\n".join([f"@{kind}{{{key},", *lines, "}"])


def _authors(people: Iterable[Mapping[str, str]]) -> str:
    """`Family, Given` of persons; the name of a group in braces, so that it is not taken apart."""
    names = (f"{p['family-names']}, {p['given-names']}" if "family-names" in p else f"{{{p['name']}}}" for p in people)
    return " and ".join(names)


def _title(title: str) -> str:
    """The title, with braces around words in capitals, which BibTeX would lower."""
    return " ".join(f"{{{word}}}" if sum(map(str.isupper, word)) > 1 else word for word in title.split())
