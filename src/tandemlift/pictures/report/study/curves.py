"""The groups of rows that a study's figures compare, so few that they can be distinguished."""

from __future__ import annotations

import numpy as np

from tandemlift.analysis.studies.study_rows import RowGroup, StudyRows

BY = ("controller", "case", "mission", "engine")  # the comparison if there are too many groups


def compared(rows: StudyRows, most: int) -> list[RowGroup]:
    """Groups of rows, at most that many: all, those of one controller, case, mission or engine each, or one of all."""
    if len(rows.groups) <= most:
        return rows.groups
    for name in BY:
        codes, names = rows.labels[name]
        if 1 < len(names) <= most:
            return [RowGroup(text, np.flatnonzero(codes == i)) for i, text in enumerate(names)]
    return [RowGroup("all rows", np.arange(len(rows)))]
