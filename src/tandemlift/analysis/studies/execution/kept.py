"""Check of the data that a study keeps, before any flight."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tandemlift.analysis.studies.design.plan import TRIED, StudyPlan
from tandemlift.analysis.studies.execution.columns import NOT_KEPT
from tandemlift.core.errors import InputError, unknown
from tandemlift.flight.channels import DERIVED
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import channel_names, metric_names


def check_kept(plan: StudyPlan) -> None:
    """Check that each metric and channel that `[keep]` names comes from some flight of a study.

    Raises:
        InputError: none has it; the message lists the existing ones.
    """
    keep = plan.settings.keep
    if not keep.metrics and not keep.channels:
        return
    flights = list(_samples(plan))
    metrics = [name for name in _together(map(metric_names, flights)) if name not in NOT_KEPT]
    _check("metric of keep.metrics", keep.metrics, metrics)
    if keep.channels:
        _check("channel of keep.channels", keep.channels, [*_together(map(channel_names, flights)), *DERIVED])


def _check(what: str, chosen: Iterable[str], known: Sequence[str]) -> None:
    for name in chosen:
        if name not in known:
            raise unknown(what, name, known)


def _together(names: Iterable[Sequence[str]]) -> list[str]:
    return list(dict.fromkeys(name for some in names for name in some))


def _samples(plan: StudyPlan) -> Iterator[FlightPlan]:
    """A flight of each variant and case that is not refused."""
    cells = len(plan.variants) * len(plan.cases)
    each = plan.count // cells
    templates = [variant.template() for variant in plan.variants]
    for cell in range(cells):
        for row in plan.rows(cell * each, cell * each + min(TRIED, each)):
            try:
                yield FlightPlan(templates[row.variant].mission(row.changes))
            except InputError:
                continue
            break
