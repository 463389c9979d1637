"""What makes saving quick leaves a figure as the drawing library would draw, lay out and write it."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import tandemlift as tl
from tandemlift.pictures.drawing import style
from tandemlift.pictures.figures.registry import figures, figures_for

NAMES = ("reference", "tracking", "inputs", "interaction")  # of the paper's figures; with a second axis at the right


@pytest.fixture(scope="module")
def flight():
    return tl.fly("paper")


@pytest.fixture(scope="module", params=NAMES)
def figure(request, flight):
    return figures_for(flight)[request.param].draw(flight)


def places(figure, labels=False):
    """The extents of what a figure draws [dots]: of its axes with all around them, or of the labels of axes."""
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw(renderer)
    if not labels:
        return np.array([ax.get_tightbbox(renderer).extents for ax in figure.axes])
    texts = [axis.label for ax in figure.axes for axis in (ax.xaxis, ax.yaxis) if axis.label.get_text()]
    return np.array([text.get_window_extent(renderer).extents for text in texts])


@pytest.mark.thorough
def test_labels_of_axes_stay_where_the_drawing_library_puts_them_also_in_other_resolutions(flight):
    for name in NAMES:
        figure = figures()[name].draw(flight)
        for dots in (72.0, 300.0):
            figure.dpi = dots
            before = places(figure, labels=True)
            twin = figures()[name].draw(flight)
            twin.fix_labels()
            twin.dpi = dots
            assert len(before) >= 3
            # hinting of the type moves a label by a dot or so in 72 dots an inch
            assert np.abs(places(twin, labels=True) - before).max() < 2.0


@pytest.mark.thorough
def test_axes_measured_once_are_laid_out_as_those_measured_twice(flight, monkeypatch):
    for name in NAMES:
        once = figures()[name].draw(flight)
        monkeypatch.setattr(style, "_measured_once", lambda axes, labels: axes.get_tightbbox)
        twice = figures()[name].draw(flight)
        monkeypatch.undo()
        # a tick's label at the end of an axis reaches farther out the shorter the axis is
        assert np.abs(places(once) - places(twice)).max() < 0.012 * once.bbox.width
        inside = places(once)
        assert (inside[:, :2] > -1.0).all()
        assert (inside[:, 2:] < np.array(once.bbox.size) + 1.0).all()
