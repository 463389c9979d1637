"""The observers of the external wrench, and how each starts before its first sample."""

from __future__ import annotations

from typing import Any, NamedTuple

from tandemlift.core.algebra import exp
from tandemlift.core.errors import InputError
from tandemlift.core.plugs import PLUGS, plug
from tandemlift.core.types import Number
from tandemlift.core.vector import ZERO, Vec3, vec3
from tandemlift.parts.estimation.wrench.extended_kalman import ExtendedKalmanFilter, start_filter
from tandemlift.parts.estimation.wrench.hybrid import HybridObserver, HybridState
from tandemlift.parts.estimation.wrench.kalman import LEAST_NOISE, kalman_observer
from tandemlift.parts.estimation.wrench.momentum import MomentumObserver, MomentumState
from tandemlift.parts.estimation.wrench.observation import ExternalWrench, NominalBody, principal
from tandemlift.parts.estimation.wrench.unscented import start_unscented
from tandemlift.parts.estimation.wrench.wrench_table import WrenchTable

Started = tuple[Any, Any]  # parameters and memory


class SampleNoise(NamedTuple):
    """Standard deviations of a sample: accelerometer [m/s²], gyroscope [rad/s], position [m], velocity, attitude."""

    accelerometer: Number
    gyroscope: Number
    position: Number
    velocity: Number
    attitude: Number


OBSERVERS = PLUGS["observer"]
"""By name: `start(table, body, noise, interval)` gives the parameters, by whose type `observe` finds the law, and the
memory. `table`: `[estimator.wrench_observer]`; `interval`: between samples [s]."""


def OwnObserver(start: Any) -> Any:
    """Refuse an observer in place of a built-in one, as version 1.0 had it.

    Raises:
        InputError: always; it names what has taken its place.
    """
    raise InputError(
        f"OwnObserver and in_place_of have gone: register {start.__name__}(table, body, noise, interval) with "
        '@plug("observer", NAME) of tandemlift.core.plugs, and choose it by estimator.wrench = NAME'
    )


def _gain(bandwidth: Vec3, interval: Number) -> Vec3:
    return Vec3(*[1.0 - exp(-w * interval) for w in bandwidth])


def _gains(table: WrenchTable, interval: Number) -> tuple[Vec3, Vec3]:
    return _gain(vec3(table.force_bandwidth), interval), _gain(vec3(table.moment_bandwidth), interval) / interval


@plug("observer", "momentum")
@plug("observer", "disturbance-observer")  # one law in these axes
def _momentum(table: WrenchTable, body: NominalBody, noise: SampleNoise, interval: Number) -> Started:
    force, moment = _gains(table, interval)
    return MomentumObserver(body, force / interval, moment), MomentumState(ExternalWrench(ZERO, ZERO), ZERO, ZERO, 0.0)


@plug("observer", "hybrid")
def _hybrid(table: WrenchTable, body: NominalBody, noise: SampleNoise, interval: Number) -> Started:
    return HybridObserver(body, *_gains(table, interval)), HybridState(ZERO, ZERO, ZERO, 0.0)


@plug("observer", "kalman")
@plug("observer", "fused")
def _kalman(table: WrenchTable, body: NominalBody, noise: SampleNoise, interval: Number) -> Started:
    changes = vec3(table.force_change), vec3(table.moment_change)
    return kalman_observer(body, *changes, noise.accelerometer, noise.gyroscope, interval)


def _filter(table: WrenchTable, body: NominalBody, noise: SampleNoise) -> ExtendedKalmanFilter:
    by_mass = vec3(table.force_change) / body.mass
    by_inertia = vec3(table.moment_change) / principal(body.inertia)
    sizes = [LEAST_NOISE + sigma for sigma in (noise.position, noise.velocity, noise.attitude, noise.gyroscope)]
    return ExtendedKalmanFilter(body, by_mass * by_mass, by_inertia * by_inertia, *[sigma * sigma for sigma in sizes])


@plug("observer", "extended-kalman")
def _extended(table: WrenchTable, body: NominalBody, noise: SampleNoise, interval: Number) -> Started:
    filtered = _filter(table, body, noise)
    return filtered, start_filter(filtered)


@plug("observer", "unscented")
def _unscented(table: WrenchTable, body: NominalBody, noise: SampleNoise, interval: Number) -> Started:
    return start_unscented(_filter(table, body, noise))
