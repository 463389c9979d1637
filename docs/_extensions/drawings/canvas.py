"""Boxes, arrows and words as an SVG within a page; the style sheet of the site has the colours."""

from __future__ import annotations

from html import escape
from typing import NamedTuple

LINE = 15  # px between the lines of a text


class Box(NamedTuple):
    """A box with a title and a text below it; `kind` is its class in the style sheet."""

    x: float
    y: float
    width: float
    height: float
    title: str
    text: str = ""
    kind: str = "box"

    @property
    def left(self) -> tuple[float, float]:
        """The middle of its left side."""
        return self.x, self.y + self.height / 2

    @property
    def right(self) -> tuple[float, float]:
        """The middle of its right side."""
        return self.x + self.width, self.y + self.height / 2

    @property
    def top(self) -> tuple[float, float]:
        """The middle of its upper side."""
        return self.x + self.width / 2, self.y

    @property
    def bottom(self) -> tuple[float, float]:
        """The middle of its lower side."""
        return self.x + self.width / 2, self.y + self.height

    def svg(self) -> str:
        """The box, its title in the middle, or at its top if it is a `frame`."""
        rect = (
            f'<rect class="{self.kind}" x="{self.x}" y="{self.y}" width="{self.width}" height="{self.height}" rx="6"/>'
        )
        if self.kind == "frame":
            return rect + words(self.x + 10, self.y + 18, self.title, "title", "start")
        lines = self.text.split("\n") if self.text else []
        first = self.y + self.height / 2 + 5 - LINE * len(lines) / 2
        middle = self.x + self.width / 2
        below = first + LINE if self.title else first + LINE / 2
        return rect + words(middle, first, self.title, "title") + words(middle, below, self.text)


def words(x: float, y: float, text: str, kind: str = "text", anchor: str = "middle") -> str:
    """Lines of text, the first with its base line at y."""
    return "".join(
        f'<text class="{kind}" x="{x}" y="{y + LINE * i}" text-anchor="{anchor}">{escape(line)}</text>'
        for i, line in enumerate(text.split("\n") if text else [])
    )


def arrow(*points: tuple[float, float], kind: str = "arrow") -> str:
    """A line through points, with a head at the last."""
    path = " ".join(f"{x},{y}" for x, y in points)
    return f'<polyline class="{kind}" points="{path}" marker-end="url(#head)"/>'


def drawing(width: float, height: float, title: str, parts: list[str]) -> str:
    """The whole drawing, as raw HTML of a Markdown page; `title` says what it shows to who cannot see it."""
    head = (
        '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
        '<path class="head" d="M0,0 L8,4 L0,8 z"/></marker></defs>'
    )
    size = f'viewBox="0 0 {width} {height}" style="min-width:{0.8 * width:.0f}px"'
    svg = f'<svg {size} role="img" aria-label="{escape(title)}">{head}{"".join(parts)}</svg>'
    return f'<div class="drawing">{svg}</div>\n'
