"""A small picture of a flight as SVG, without a drawing library: path from above, push and tracking error over time."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from tandemlift.common.types import Array
from tandemlift.flight.data_frames import LoggedFlight
from tandemlift.settings import wall_tables

BLUE, VERMILLION, GREY = "#2a8bcc", "#e0701f", "#8c8c8c"  # that are seen on white and on black
POINTS = 240  # at most, of a line
SIDE = 190.0  # px, of the path
WIDTH, HEIGHT, GAP = 250.0, 76.0, 38.0  # px, of a plot over time, and between the two
LEFT, TOP, BOTTOM = 12.0, 20.0, 20.0  # px
LEAST = 0.5  # m, the shortest side that the path's picture shows
NEAR = 3.0  # m around the path in which walls are drawn


class Window(NamedTuple):
    """Where a rectangle of numbers lies in a picture: the lower left numbers, px for each, and the corner in px."""

    low: tuple[float, float]
    scale: tuple[float, float]
    corner: tuple[float, float]

    def points(self, xy: Array) -> str:
        """Numbers (n, 2) as the points of a line in the picture."""
        x = self.corner[0] + (xy[:, 0] - self.low[0]) * self.scale[0]
        y = self.corner[1] - (xy[:, 1] - self.low[1]) * self.scale[1]
        return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))

    def line(self, xy: Array, color: str, width: float = 1.5, more: str = "") -> str:
        """A line through numbers (n, 2)."""
        look = f'fill="none" stroke="{color}" stroke-width="{width:g}"'
        return f'<polyline points="{self.points(xy)}" {look} {more}/>' if len(xy) else ""


def thumbnail(flight: LoggedFlight) -> str:
    """The picture; "" for a flight without two samples that can be drawn."""
    position, time = flight.channels.get("position"), flight.time
    if position is None or position.ndim != 2 or position.shape[1] < 3:
        return ""
    sound = np.isfinite(position).all(axis=1) & (np.abs(position) < 1e6).all(axis=1)
    if sound.sum() < 2 or time[-1] <= time[0]:
        return ""
    left = _path(flight, sound)
    push = _length(flight.channels.get("push_force"))
    desired = flight.channels.get("reference_position")
    error = None if desired is None else _length(desired - position)
    x, base = LEFT + SIDE + 3.0 * LEFT, TOP + HEIGHT
    right = _over_time(time, push, (x, base), "push", "N", VERMILLION)
    millimetres = None if error is None else 1e3 * error
    right += _over_time(time, millimetres, (x, base + HEIGHT + GAP), "position error", "mm", BLUE)
    right += _text(x + WIDTH, base + HEIGHT + GAP + 15.0, f"{time[-1]:g} s", "end")
    size = (x + WIDTH + LEFT, base + HEIGHT + GAP + BOTTOM)
    about = "path from above; push and position error over time"
    width, height = (round(side) for side in size)
    head = f'viewBox="0 0 {width} {height}" width="{width}" height="{height}" style="max-width:100%;height:auto"'
    font = 'font-family="sans-serif" font-size="11" fill="currentColor"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{about}" {head} {font}>{left}{right}</svg>'


def _path(flight: LoggedFlight, sound: Any) -> str:
    """Path, reference, walls, and the beam at start and end, to one scale; x to the right, y up."""
    path = _thinned(flight.channels["position"][sound, :2])
    beams = [b for k in (0, -1) for b in _beam(flight, int(np.flatnonzero(sound)[k]))]
    around = np.concatenate([path, *beams])
    walls = _walls(flight.mission, around)
    corners = np.concatenate([around, *walls])
    low, high = corners.min(0), corners.max(0)
    span = max(float((high - low).max()), LEAST) * 1.08
    middle, side = 0.5 * (low + high), 2.0 * HEIGHT + GAP
    scale = SIDE / span
    corner = (LEFT, TOP + side)
    window = Window((middle[0] - 0.5 * SIDE / scale, middle[1] - 0.5 * side / scale), (scale, scale), corner)
    desired = flight.channels.get("reference_position")
    drawn = [window.line(wall, GREY, 2.5) for wall in walls]
    drawn += [window.line(beam, "currentColor", 3.0, 'opacity="0.55" stroke-linecap="round"') for beam in beams]
    if desired is not None:
        wanted = desired[np.isfinite(desired).all(axis=1), :2]
        drawn.append(window.line(_thinned(wanted), VERMILLION, 1.2, 'stroke-dasharray="4 3"'))
    drawn.append(window.line(path, BLUE, 1.8))
    for place, fill in ((path[:1], "none"), (path[-1:], BLUE)):
        x, y = window.points(place).split(",")
        drawn.append(f'<circle cx="{x}" cy="{y}" r="3.2" stroke="{BLUE}" fill="{fill}"/>')
    return "".join(drawn) + _text(LEFT, TOP - 7.0, "path from above") + _scale_bar(scale, (LEFT, TOP + side + 8.0))


def _beam(flight: LoggedFlight, k: int) -> list[Array]:
    """The beam at a sample, as a line (2, 2) [m]; none if it cannot be known."""
    length = flight.mission.get("vehicle", {}).get("payload", {}).get("length")
    attitude = flight.channels.get("attitude")
    if not length or attitude is None or not np.isfinite(attitude[k]).all():
        return []
    w, x, y, z = attitude[k]
    half = 0.5 * length * np.array([2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z)])  # of the body's y axis
    centre = flight.channels["position"][k, :2]
    return [np.array([centre - half, centre + half])]


def _walls(mission: dict[str, Any], around: Array) -> list[Array]:
    """Walls near the path, each as a line (2, 2) [m]."""
    low, high = around.min(0) - NEAR, around.max(0) + NEAR
    walls = [np.array([wall["start"], wall["end"]], float) for wall in wall_tables(mission)]
    return [w for w in walls if (w.max(0) >= low).all() and (w.min(0) <= high).all()]


def _scale_bar(scale: float, place: tuple[float, float]) -> str:
    """A bar of 1, 2 or 5 times a power of ten metres, about a quarter of the picture."""
    about = 0.25 * SIDE / scale
    power = 10.0 ** math.floor(math.log10(about))
    length = next(m * power for m in (5.0, 2.0, 1.0) if m * power <= about)
    x, y = place
    bar = f'<path d="M{x:.1f} {y:.1f}h{length * scale:.1f}" stroke="currentColor" stroke-width="1.5"/>'
    return bar + _text(x + length * scale + 5.0, y + 4.0, f"{length:g} m")


def _over_time(
    time: Array, values: Array | None, corner: tuple[float, float], title: str, unit: str, color: str
) -> str:
    """A plot over time with the largest value written beside it."""
    x, y = corner
    axes = f'<path d="M{x:.1f} {y - HEIGHT:.1f}v{HEIGHT:.0f}h{WIDTH:.0f}" stroke="{GREY}" fill="none"/>'
    above = y - HEIGHT - 7.0
    if values is None or not (sound := np.isfinite(values)).any():
        return axes + _text(x, above, f"{title}: not in this flight")
    at, shown = time[sound], values[sound]
    most = float(shown.max())
    window = Window((float(time[0]), 0.0), (WIDTH / float(time[-1] - time[0]), HEIGHT / (most or 1.0)), corner)
    largest = f"{most:,.0f}" if 1e3 <= most < 1e7 else f"{most:.3g}"
    line = window.line(_highest(at, shown), color) if most else ""
    return axes + line + _text(x, above, f"{title}, at most {largest} {unit}" if most else f"no {title}")


def _highest(time: Array, values: Array) -> Array:
    """A series as at most `POINTS` points (n, 2): of each stretch of time, the highest."""
    parts = np.array_split(np.arange(len(time)), min(POINTS, len(time)))
    chosen = [int(part[np.argmax(values[part])]) for part in parts]
    return np.column_stack([time[chosen], values[chosen]])


def _thinned(path: Array) -> Array:
    """At most `POINTS` of the points (n, 2) of a path, its ends among them."""
    if len(path) <= POINTS:
        return path
    return path[np.linspace(0, len(path) - 1, POINTS).round().astype(int)]


def _length(vectors: Array | None) -> Array | None:
    """The lengths of vectors (T, 3)."""
    with np.errstate(over="ignore", invalid="ignore"):
        return None if vectors is None else np.linalg.norm(vectors, axis=1)


def _text(x: float, y: float, text: str, anchor: str = "start") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{text}</text>'
