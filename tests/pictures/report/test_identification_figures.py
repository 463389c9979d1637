"""The figures of an identification: named, and nothing of them hidden or cut off."""

import numpy as np

from tandemlift.pictures.report.identification_report import draw_correlation

KEYS = ["vehicle.payload.mass", "vehicle.drag.force.x", "actuators.delay"]


def test_the_map_of_correlations_names_its_rows_and_columns():
    axes = draw_correlation(KEYS, np.eye(3).tolist()).axes[0]
    for labels in (axes.get_xticklabels(), axes.get_yticklabels()):
        assert [label.get_text() for label in labels] == KEYS
