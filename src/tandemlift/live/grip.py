"""How a page holds the beam."""

from __future__ import annotations

from dataclasses import dataclass, field

from tandemlift.algebra.vector import ZERO, Vec3


@dataclass
class Grip:
    """How the page holds the beam: what is to be added to its targets [m], and the last word it said."""

    offset: Vec3 = ZERO
    seq: int = 0
    wishes: dict[str, int] = field(default_factory=dict)  # until which step each is said

    def ended(self, step: int) -> list[str]:
        """The wishes that have been said for long enough at a step, which are forgotten."""
        over = [wish for wish, until in self.wishes.items() if step >= until]
        for wish in over:
            del self.wishes[wish]
        return over
