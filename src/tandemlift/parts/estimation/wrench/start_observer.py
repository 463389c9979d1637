"""The observer of the external wrench that a mission selects, before its first sample."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from tandemlift.core.algebra import exp
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, vec3
from tandemlift.parts.estimation.wrench.extended_kalman import ExtendedKalmanFilter, start_filter
from tandemlift.parts.estimation.wrench.hybrid import HybridObserver, HybridState
from tandemlift.parts.estimation.wrench.kalman import LEAST_NOISE, kalman_observer
from tandemlift.parts.estimation.wrench.momentum import MomentumObserver, MomentumState
from tandemlift.parts.estimation.wrench.observation import ExternalWrench, NominalBody, principal
from tandemlift.parts.estimation.wrench.unscented import start_unscented
from tandemlift.parts.estimation.wrench.wrench_table import WrenchTable


class SampleNoise(NamedTuple):
    """Standard deviations of a sample: accelerometer [m/s²], gyroscope [rad/s], position [m], velocity, attitude."""

    accelerometer: Number
    gyroscope: Number
    position: Number
    velocity: Number
    attitude: Number


Start = Callable[[NominalBody, SampleNoise, float], tuple[Any, Any]]
_standing_in: dict[str, Start] = {}


class OwnObserver(NamedTuple):
    """An observer of one's own: `start(body, noise, interval)` gives its parameters and memory, by whose type `observe`
    finds its law. `interval`: between samples [s]."""

    start: Start

    @contextmanager
    def in_place_of(self, name: str) -> Iterator[None]:
        """In this process, flights with `estimator.wrench` = `name` that are begun meanwhile fly this observer."""
        _standing_in[name] = self.start
        try:
            yield
        finally:
            del _standing_in[name]


def _gain(bandwidth: Vec3, interval: Number) -> Vec3:
    return Vec3(*[1.0 - exp(-w * interval) for w in bandwidth])


def start_wrench_observer(
    name: str, table: WrenchTable, body: NominalBody, noise: SampleNoise, interval: Number
) -> tuple[Any, Any]:
    """(the observer, its memory); `name`: `estimator.wrench`; `interval`: between samples [s]."""
    if name in _standing_in:
        return _standing_in[name](body, noise, interval)
    force = _gain(vec3(table.force_bandwidth), interval)
    moment = _gain(vec3(table.moment_bandwidth), interval) / interval
    changes = vec3(table.force_change), vec3(table.moment_change)
    if name in ("momentum", "disturbance-observer"):  # one law in these axes
        return MomentumObserver(body, force / interval, moment), MomentumState(
            ExternalWrench(ZERO, ZERO), ZERO, ZERO, 0.0
        )
    if name == "hybrid":
        return HybridObserver(body, force, moment), HybridState(ZERO, ZERO, ZERO, 0.0)
    if name in ("kalman", "fused"):
        return kalman_observer(body, *changes, noise.accelerometer, noise.gyroscope, interval)
    by_mass, by_inertia = changes[0] / body.mass, changes[1] / principal(body.inertia)
    sizes = [LEAST_NOISE + sigma for sigma in (noise.position, noise.velocity, noise.attitude, noise.gyroscope)]
    position, velocity, attitude, rates = (sigma * sigma for sigma in sizes)
    filtered = ExtendedKalmanFilter(
        body, by_mass * by_mass, by_inertia * by_inertia, position, velocity, attitude, rates
    )
    if name == "unscented":
        return start_unscented(filtered)
    return filtered, start_filter(filtered)
