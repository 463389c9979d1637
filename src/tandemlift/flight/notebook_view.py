"""A flight as HTML for a notebook: a table of its metrics and a small picture, without external files.

The text has the colour of the notebook, so that it can be read on a light and on a dark page.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

from tandemlift.flight.data_frames import LoggedFlight
from tandemlift.flight.thumbnail import thumbnail

MOST_FINDINGS = 3
CELL = "padding:0.1em 0.8em 0.1em 0;text-align:left;vertical-align:top;white-space:nowrap"
METRICS = (  # name in metrics.json, label here, displayed unit, and that unit in SI units
    ("position_rmse_after_10s_m", "position error after 10 s (RMS)", "mm", 1e-3),
    ("position_rmse_m", "position error (RMS)", "mm", 1e-3),
    ("final_position_m", "final position", "m", 1.0),
    ("human_work_j", "work of the person", "J", 1.0),
    ("clearance_min_m", "least clearance from a wall", "m", 1.0),
    ("rotor_saturated_share", "time with a rotor at its limit", "%", 1e-2),
)


def flight_html(flight: LoggedFlight, outcome: str, failure: str, findings: Sequence[Any]) -> str:
    """The table and the picture of a flight.

    Args:
        flight: the record; it may be empty, or have diverged.
        outcome: how it ended.
        failure: why it failed, or "".
        findings: its findings.
    """
    rows = [*_facts(flight, outcome, failure, findings), *_measured(flight.metrics())]
    cells = "".join(f'<tr><th style="{CELL}">{name}</th><td style="{CELL}">{text}</td></tr>' for name, text in rows)
    table = f'<table style="border-collapse:collapse;margin:0">{cells}</table>'
    parts = "".join(f"<div>{part}</div>" for part in (table, thumbnail(flight)) if part)
    return f'<div style="display:flex;flex-wrap:wrap;gap:1em 2em;align-items:center">{parts}</div>'


def _facts(flight: LoggedFlight, outcome: str, failure: str, findings: Sequence[Any]) -> list[tuple[str, str]]:
    flown = f"{flight.time[-1]:g} s, {len(flight.time):,} samples" if len(flight.time) else "nothing logged"
    return [
        ("mission", f"<b>{escape(flight.name)}</b>"),
        ("engine", escape(flight.version.get("engine", "unknown"))),
        ("flown", flown),
        ("outcome", f"{'✗' if failure else '✓'} {escape(_wrapped(failure or outcome))}".replace("\n", "<br>")),
        ("findings", _findings(findings)),
    ]


def _findings(findings: Sequence[Any]) -> str:
    lines = [f"{escape(f.kind)} at {f.time:.4g} s" for f in findings[:MOST_FINDINGS]]
    more = [f"and {len(findings) - MOST_FINDINGS} more"] if len(findings) > MOST_FINDINGS else []
    return "<br>".join([*lines, *more]) or "none"


def _measured(metrics: dict[str, Any]) -> list[tuple[str, str]]:
    """The metrics that the flight has; the error of the whole flight only if there is none after 10 s."""
    rows = list[tuple[str, str]]()
    for name, words, unit, size in METRICS:
        text = _numbers(metrics.get(name), size)
        if text and not (name == "position_rmse_m" and rows):
            rows.append((words, f"{text} {unit}"))
    return rows


def _numbers(value: object, size: float) -> str:
    """A number, or one for each axis, in units of a size; "" if there is none."""
    values: Iterable[Any] = value if isinstance(value, (list, tuple)) else [value]
    if not all(isinstance(v, (int, float)) and math.isfinite(v) for v in values):
        return ""
    return ", ".join(_number(v / size) for v in values)


def _number(value: float) -> str:
    """A number with three digits, and 0 if it is negligible."""
    return f"{value:.3g}".replace("-", "−") if abs(value) >= 5e-4 else "0"


def _wrapped(text: str, width: int = 48) -> str:
    """A long text in lines of some 48 characters."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + len(word) >= width:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return "\n".join(lines)
