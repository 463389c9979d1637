"""Interactive guidance: motion of the reference by a push, and compensation of the push."""

from __future__ import annotations

from itertools import pairwise

from drawings.canvas import Box, arrow, drawing, words


def guidance() -> str:
    """The path of a push through the pilot, with feedforward and disturbance observer."""
    chain = [
        Box(10, 90, 92, 56, "push", "measured", "body"),
        Box(134, 90, 112, 56, "gate", "low-pass, dead\nband, low-pass"),
        Box(278, 90, 112, 56, "admittance", "within limits"),
        Box(422, 90, 92, 56, "reference", "and heading"),
        Box(546, 90, 92, 56, "controller"),
        Box(670, 90, 80, 56, "allocation"),
    ]
    push, _, admittance, reference, *_ = chain
    observer = Box(422, 196, 216, 50, "disturbance observer", "wind, model error")
    phases = Box(278, 10, 236, 40, "phases, supervision")
    parts = [b.svg() for b in (*chain, observer, phases)]
    parts += [arrow(a.right, b.left) for a, b in pairwise(chain)]
    parts += [
        arrow((334, 50), admittance.top),
        arrow((468, 50), reference.top),
        arrow(push.bottom, (56, 272), (660, 272), (660, 160), (616, 160), (616, 146)),
        words(64, 264, "the push is compensated", "text", "start"),
        arrow((570, 196), (570, 146)),
        words(564, 180, "is compensated", "text", "end"),
        arrow(observer.left, (334, observer.left[1]), admittance.bottom),
        words(326, 200, "available acceleration", "text", "end"),
    ]
    return drawing(
        760, 284, "A measured push moves the reference and is compensated; the observer compensates the rest.", parts
    )
