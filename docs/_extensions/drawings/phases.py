"""The phases of interactive guidance."""

from __future__ import annotations

from drawings.canvas import Box, arrow, drawing, words


def phases() -> str:
    """The phases and their transitions."""
    idle, lift = Box(10, 100, 90, 46, "idle"), Box(220, 100, 90, 46, "lift", kind="body")
    air = Box(420, 10, 330, 232, "in the air, the first that applies:", kind="frame")
    rows = [
        ("limited", "cannot follow its reference"),
        ("hold", "disabled, no tare, a fault “hold”"),
        ("contact", "a wall is touched"),
        ("guided", "else: follows pushes"),
    ]
    inside = [Box(434, 38 + 50 * i, 84, 40, name, kind="pilot") for i, (name, _) in enumerate(rows)]
    land, stopped = Box(220, 270, 90, 46, "land", kind="body"), Box(220, 340, 90, 40, "stopped")
    parts = [b.svg() for b in (idle, lift, air, *inside, land, stopped)]
    parts += [words(528, 63 + 50 * i, text, "text", "start") for i, (_, text) in enumerate(rows)]
    parts += [
        arrow(idle.right, lift.left),
        words(160, 96, "lift requested,\nchecks passed", "text"),
        arrow(lift.right, (air.x, lift.right[1])),
        words(365, 114, "lift complete", "text"),
        arrow(lift.bottom, land.top),
        words(257, 200, "any fault,\nland requested", "text", "end"),
        arrow((585, 242), (585, land.right[1]), land.right),
        words(322, 268, "land requested, a fault “land”, or\ntoo long in hold, contact, limited", "text", "start"),
        arrow(land.left, (55, land.left[1]), (55, 146)),
        words(62, 286, "landed", "text", "start"),
        words(322, 364, "from every phase: stop requested, a fault “stop”", "text", "start"),
    ]
    return drawing(760, 390, "Phases: idle, lift, in the air (limited, hold, contact or guided), land, stopped.", parts)
