"""The figures of an identification: named, and nothing of them hidden or cut off."""

import numpy as np

from tandemlift.pictures.drawing.style import PAPER
from tandemlift.pictures.report.identification_report import draw_correlation, draw_estimates, draw_misfit

KEYS = ["vehicle.payload.mass", "vehicle.drag.force.x", "actuators.delay"]


def test_the_map_of_correlations_names_its_rows_and_columns():
    axes = draw_correlation(KEYS, np.eye(3).tolist()).axes[0]
    for labels in (axes.get_xticklabels(), axes.get_yticklabels()):
        assert [label.get_text() for label in labels] == KEYS


def test_the_markers_of_numbers_that_are_not_excited_are_hollow_above_their_intervals():
    row = {"low": 0.9, "value": 1.1, "high": 1.3, "start": 1.0}
    axes = draw_estimates([row | {"key": key, "excited": key == KEYS[0]} for key in KEYS[:2]]).axes[0]
    hollow, filled = (line for line in axes.lines if line.get_marker() == "o")
    interval = next(line for line in axes.lines if line.get_marker() == "None")
    assert hollow.get_markerfacecolor() == PAPER != filled.get_markerfacecolor()
    assert hollow.get_zorder() > interval.get_zorder()
    assert hollow.get_markersize() > 2.0 * hollow.get_markeredgewidth() + interval.get_linewidth()


def test_the_marks_of_the_first_and_the_last_window_are_whole():
    used, held = {"measured_rates": [[6.4, 1.0], [9.0, 1.1]]}, {"measured_rates": [[12.0, 0.9]]}
    figure = draw_misfit(used, held)
    axes = figure.axes[0]
    left, right = (axes.transData.transform((time, 1.0))[0] for time in (6.4, 12.0))
    size = figure.dpi / 72.0 * max(line.get_markersize() for line in axes.lines)
    assert axes.bbox.x0 + size < left < right < axes.bbox.x1 - size
