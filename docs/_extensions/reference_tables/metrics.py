"""The tables of metrics."""

from __future__ import annotations

from reference_tables.markdown import table
from tandemlift.analysis.studies.metric_descriptions import METRIC_GROUPS, Metric, MetricGroup


def metric_tables() -> str:
    """A table for each group of metrics."""
    return "\n".join(map(_section, METRIC_GROUPS))


def _section(group: MetricGroup) -> str:
    rows = [_row(name, metric) for name, metric in group.metrics.items()]
    return f"### {group.when}\n\n{table(('metric', 'unit', 'components', 'meaning'), rows)}"


def _row(name: str, metric: Metric) -> tuple[str, ...]:
    return (f"`{name}`", metric.unit, ", ".join(metric.components), metric.meaning)
