"""A flight as HTML for a notebook: a table of its metrics and a small picture, without external files.

The text has the colour of the notebook, so that it can be read on a light and on a dark page.
"""

from __future__ import annotations

import io
import math
import textwrap
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.core.vector import Quat
from tandemlift.flight.data_frames import LoggedFlight
from tandemlift.parts.contact.corridor import wall_tables
from tandemlift.parts.mechanics.rotation import rotation_from_quaternion
from tandemlift.parts.mechanics.vehicle import Vehicle

if TYPE_CHECKING:
    from matplotlib.axes import Axes


MOST_FINDINGS = 3
LINE_WIDTH = 48  # characters of a line
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
    lines = textwrap.wrap(failure or outcome, LINE_WIDTH, break_long_words=False)
    flown = f"{flight.time[-1]:g} s, {len(flight.time):,} samples" if len(flight.time) else "nothing logged"
    return [
        ("mission", f"<b>{escape(flight.name)}</b>"),
        ("engine", escape(flight.version.get("engine", "unknown"))),
        ("flown", flown),
        ("outcome", f"{'✗' if failure else '✓'} {'<br>'.join(map(escape, lines))}"),
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


BLUE, VERMILLION, GREY = "#2a8bcc", "#e0701f", "#8c8c8c"  # visible on white and on black
INK = "#123456"  # stands for the colour of the notebook's text
POINTS = 240  # at most, of a line
SIZE = (6.4, 2.8)  # in
WALL_DISTANCE = 3.0  # m around the path in which walls are drawn
SHORTEST_SIDE = 0.5  # m, the shortest side that the path's picture shows
STYLE = {
    **{"svg.fonttype": "none", "font.family": "sans-serif", "font.size": 8.0, "axes.titlesize": 8.0},
    **{f"axes.spines.{side}": False for side in ("top", "right")},
    **dict.fromkeys(("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color"), INK),
}


def thumbnail(flight: LoggedFlight) -> str:
    """The picture; "" for a flight with fewer than two samples that can be drawn."""
    position, time = flight.channels.get("position"), flight.time
    if position is None or position.ndim != 2 or position.shape[1] < 3:
        return ""
    sound = np.isfinite(position).all(axis=1) & (np.abs(position) < 1e6).all(axis=1)
    if sound.sum() < 2 or time[-1] <= time[0]:
        return ""
    import matplotlib
    from matplotlib.figure import Figure

    desired = flight.channels.get("reference_position")
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=SIZE, layout="constrained")
        panels: dict[str, Axes] = figure.subplot_mosaic([["path", "push"], ["path", "error"]])
        _draw_path(panels["path"], flight, sound)
        _draw_over_time(panels["push"], time, _length(flight.channels.get("push_force")), "push", "N", VERMILLION)
        error = None if desired is None else _length(desired - position)
        _draw_over_time(panels["error"], time, None if error is None else 1e3 * error, "position error", "mm", BLUE)
        panels["error"].set_xlabel("time (s)")
        text = io.StringIO()
        figure.savefig(text, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    svg = text.getvalue()
    return svg[svg.index("<svg") :].replace(INK, "currentColor")


def _draw_path(ax: Axes, flight: LoggedFlight, sound: Any) -> None:
    """Path, reference, walls, and the payload at start and end, to one scale."""
    path = flight.channels["position"][sound, :2]
    desired = flight.channels.get("reference_position")
    for wall in _walls(flight.mission, path):
        ax.plot(*wall.T, color=GREY, lw=2.0)
    for payload in (b for k in (0, -1) for b in _payload(flight, int(np.flatnonzero(sound)[k]))):
        ax.plot(*payload.T, color=INK, lw=2.5 if len(payload) == 2 else 1.0, alpha=0.55)
    if desired is not None:
        wanted = desired[np.isfinite(desired).all(axis=1) & (np.abs(desired) < 1e6).all(axis=1), :2]
        ax.plot(*_thinned(wanted).T, "--", color=VERMILLION, lw=1.0)
    ax.plot(*_thinned(path).T, color=BLUE, lw=1.5)
    ax.plot(*path[0], "o", ms=4.0, mfc="none", mec=BLUE)
    ax.plot(*path[-1], "o", ms=4.0, color=BLUE)
    ax.set_aspect("equal", adjustable="datalim")
    if np.ptp(path, axis=0).max() < SHORTEST_SIDE:
        ax.set_xlim(*(path[0, 0] + np.array([-SHORTEST_SIDE, SHORTEST_SIDE])))
    ax.set_title("path from above (m)", loc="left")


def _payload(flight: LoggedFlight, k: int) -> list[Array]:
    """The outline of the payload at a sample (n, 2) [m]; none if its shape or attitude is unknown."""
    attitude = flight.channels.get("attitude")
    try:
        vehicle = Vehicle.from_mission(flight.mission)
    except InputError:
        return []
    outline = vehicle.payload.outline
    if len(outline) < 2 or attitude is None or not np.isfinite(attitude[k]).all():
        return []
    R = np.array(rotation_from_quaternion(Quat(*attitude[k])))
    return [flight.channels["position"][k, :2] + (vehicle.origin + outline) @ R[:2].T]


def _walls(mission: dict[str, Any], around: Array) -> list[Array]:
    """Walls near the path, each as a line (2, 2) [m]."""
    low, high = around.min(0) - WALL_DISTANCE, around.max(0) + WALL_DISTANCE
    walls = [np.array([wall["start"], wall["end"]], float) for wall in wall_tables(mission)]
    return [w for w in walls if (w.max(0) >= low).all() and (w.min(0) <= high).all()]


def _draw_over_time(ax: Axes, time: Array, values: Array | None, title: str, unit: str, color: str) -> None:
    """A plot over time with the largest value written above it."""
    if values is None or not (sound := np.isfinite(values)).any():
        ax.set_title(f"{title}: not in this flight", loc="left")
        return
    at, shown = time[sound], values[sound]
    most = float(shown.max())
    largest = f"{most:,.0f}" if 1e3 <= most < 1e7 else f"{most:.3g}"
    ax.set_title(f"{title}, at most {largest} {unit}" if most else f"no {title}", loc="left")
    if most:
        parts = np.array_split(np.arange(len(at)), min(POINTS, len(at)))
        highest = [int(part[np.argmax(shown[part])]) for part in parts]  # of each stretch of time
        ax.plot(at[highest], shown[highest], color=color, lw=1.2)
    ax.set_xlim(time[0], time[-1])


def _thinned(path: Array) -> Array:
    """At most `POINTS` of the points (n, 2) of a path, its ends among them."""
    if len(path) <= POINTS:
        return path
    return path[np.linspace(0, len(path) - 1, POINTS).round().astype(int)]


def _length(vectors: Array | None) -> Array | None:
    """The lengths of vectors (T, 3)."""
    with np.errstate(over="ignore", invalid="ignore"):
        return None if vectors is None else np.linalg.norm(vectors, axis=1)
