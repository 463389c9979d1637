"""What changes while a mission is flown."""

from __future__ import annotations

from typing import Any

from tandemlift.settings.leaves import NonNegative, Table


class ChangeTable(Table):
    """One of `[[changes]]`: a key of the mission that takes another value in flight."""

    time: NonNegative  # s, from which on
    key: str  # dotted, as of --set
    value: Any  # as the key takes it
    duration: NonNegative = 0.0  # s, over which its numbers go there, in a straight line
