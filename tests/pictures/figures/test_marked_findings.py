"""Figures mark the times at which findings begin, and only those."""

from dataclasses import replace

import numpy as np

import tandemlift as tl
from tandemlift.core.findings import Finding
from tandemlift.pictures.figures import tracking

FLIGHT = tl.fly(tl.load_mission("one-push", {"mission.duration": 3.0}))


def marks(flight):
    lines = [line for ax in tracking.draw(flight).axes for line in ax.get_lines() if line.get_marker() == "v"]
    return [np.asarray(line.get_xdata()).tolist() for line in lines]


def test_the_figure_of_tracking_marks_findings():
    found = [
        Finding("off-track", t, 0.5, None, "tilt", 0.6, "rad", 0.5, "tilted by 34° (promised: 29°)") for t in (1.0, 2.5)
    ]
    assert marks(FLIGHT) == []
    assert marks(replace(FLIGHT, findings=tuple(found))) == [[1.0, 2.5]] * 3
