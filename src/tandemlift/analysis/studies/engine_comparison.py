"""Comparison of engines: the differences between flights of one mission, sample by sample."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.types import Array, Progress
from tandemlift.engines.registry import ENGINES
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission
from tandemlift.simulation.many import fly_each

QUANTITIES = {"position": "m", "attitude": "rad", "joint_force": "N", "joint_torque": "N m", "push_estimate": "N"}
SETTLED = 0.1  # s, start of the comparison of joints: some engines first correct joint errors of a fast start


def fly_in(mission: Mission, engines: Sequence[str], progress: Progress | None = None) -> dict[str, Flight]:
    """Fly a mission in several engines.

    Args:
        mission: from `load_mission`.
        engines: names of the engines, without repetition.
        progress: called with (flights flown, flights in all).

    Returns:
        The flights by the engine's name, in the order given.

    Raises:
        InputError: fewer than two engines are named, or one is unknown or cannot fly the mission.
    """
    if len(set(engines)) < 2 or len(set(engines)) < len(engines):
        raise InputError(f"engines = {', '.join(engines)}: must be two or more, without repetition")
    flights = fly_each([mission] * len(engines), engines, keep="flights", interrupted=True, progress=progress)
    return dict(zip(engines, flights, strict=True))


def angles_between(a: Array, b: Array) -> Array:
    """Angles (T,) [rad] between two series of quaternions (T, 4)."""
    same = np.where(np.sum(a * b, axis=1) < 0.0, -1.0, 1.0)[:, None]
    return 4.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(a - same * b, axis=1), 0.0, 1.0))


def differences(flight: Flight, first: Flight) -> dict[str, Array]:
    """Differences of two flights at their common samples, for each common quantity of `QUANTITIES`.

    Distance of positions [m], angle of attitudes [rad], largest component of the difference of forces [N] and torques
    [N·m].
    """
    count = min(len(flight.time), len(first.time))
    found = {}
    for name in QUANTITIES:
        if name in flight and name in first:
            a, b = flight[name][:count].reshape(count, -1), first[name][:count].reshape(count, -1)
            found[name] = _distance(name, a, b)
    return found


def _distance(name: str, a: Array, b: Array) -> Array:
    if name == "attitude":
        return angles_between(a, b)
    return np.linalg.norm(a - b, axis=1) if name == "position" else np.abs(a - b).max(axis=1)


def largest_differences(flight: Flight, first: Flight) -> dict[str, float]:
    """The largest value of each of `differences`; for joints from `SETTLED` on."""
    found = {}
    for name, values in differences(flight, first).items():
        late = first.time[: len(values)] > SETTLED if name.startswith("joint") else slice(None)
        found[name] = float(np.nanmax(values[late], initial=0.0))
    return found


def engine_summary(name: str) -> str:
    """The description of an engine in a sentence."""
    return ENGINES[name].summary


def summary_of(flights: Mapping[str, Flight]) -> list[dict[str, Any]]:
    """The comparison as JSON, an object for each engine; differences are relative to the first."""
    first = next(iter(flights.values()))
    return [
        {
            "engine": name,
            "difference": largest_differences(flight, first),
            "final_position_m": flight.metrics()["final_position_m"],
            "steps_per_s": speed(flight),
            "findings": [finding.as_table() for finding in flight.findings],
            "failure": flight.failure or None,
            "version": flight.version,
        }
        for name, flight in flights.items()
    ]


def speed(flight: Flight) -> float:
    """Steps per second, with the pilot."""
    metrics = flight.metrics()
    return float(metrics["steps"] / metrics["wall_s"])
