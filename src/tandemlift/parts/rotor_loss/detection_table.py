"""Rotor-failure detection, `[detection]`: its keys and its start."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Annotated, Literal

import numpy as np

from tandemlift.core.algebra import maximum
from tandemlift.core.arrays import largest
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import BELIEVED, Bandwidth, Fraction, NonNegative, PerAxis, Positive, Scale, Table, key
from tandemlift.core.low_pass import LowPassState, low_pass
from tandemlift.core.types import NumberSet, number
from tandemlift.core.vector import Absent, each
from tandemlift.parts.mechanics.rigid_body import InitialTable, inertia_value
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotor_loss.decision import DecisionRules, DecisionState
from tandemlift.parts.rotor_loss.detection import (
    FOUR,
    START_SCATTER,
    DetectionState,
    ObservedPush,
    RotorLossDetection,
)
from tandemlift.parts.rotors.allocation import Mixer

Positive4 = Annotated[tuple[Scale, Scale, Scale, Scale], PerAxis(4)]


class DetectionTable(Table, acts='detection.model = "residual"'):
    """`[detection]`: rotor-failure detection, from the momentum that the modelled rotors do not explain.

    With `allocation.method = "constrained"`, which it needs: a rotor that is declared failed gets no thrust, and a
    pilot with interactive guidance lands. A rotor that stops or loses more than about half of its thrust is detected,
    one at a time, from about three seconds after the lift, while nothing supports the vehicle from below.
    """

    model: Literal["none", "residual"] = key(
        "none",
        None,
        "model of the detection",
        choices={"none": "no detection", "residual": "likelihood-ratio tests of the momentum residual"},
    )
    bandwidth: Bandwidth = key(
        60.0, "rad/s", "bandwidth of the second-order low-pass filter on the residual", source="chosen"
    )
    bias_bandwidth: Bandwidth = key(
        2.0, "rad/s", "bandwidth of the residual's mean, which is subtracted: wind, or a wrong mass", source="chosen"
    )
    scatter_bandwidth: Bandwidth = key(
        3.0,
        "rad/s",
        "bandwidth of the residual's mean square, which adds to scatter²: noise, or a wrong model",
        source="chosen",
    )
    scatter: Positive4 = key(
        (0.3, 0.3, 0.03, 0.3),
        "N, N m",
        "standard deviation of the residual in thrust, roll, pitch and yaw for a well modelled vehicle",
        source="chosen",
    )
    thrust_uncertainty: Fraction = key(
        0.2, "1", "fraction by which a rotor's thrust may differ from the model", source="chosen"
    )
    threshold: Positive = key(
        40.0, "1", "detection threshold: twice the log-likelihood ratio of a failed rotor against none", source="chosen"
    )
    isolation_margin: Positive = key(
        3.0, "1", "twice the log-likelihood ratio by which the failed rotor must lead any other", source="chosen"
    )
    unexplained_fraction: Fraction = key(
        0.25,
        "1",
        "largest fraction of the residual's square that the failed rotor may leave unexplained",
        source="chosen",
    )
    dwell: NonNegative = key(0.012, "s", "time for which all these criteria must hold", source="chosen")
    retest_time: NonNegative = key(
        0.2,
        "s",
        "time for which a rotor declared failed is commanded its hover thrust on trial, and may be restored; after it, "
        "the landing begins",
        source="chosen",
    )
    rotor_lag: Positive = key(0.018, "s", "time constant of the modelled rotors, up and down", source=BELIEVED)
    rotor_delay: NonNegative = key(0.01, "s", "delay of the modelled rotors", source="actuators.delay of mission iris")


AT_ONCE = 1e-9  # s, for a dwell of 0: a timer counts as over from the first sample that it runs, not at rest
BOUND = 0.5  # of the residual after a rotor failure: the largest contribution of a sample to the scatter


def _rules(d: DetectionTable) -> DecisionRules:
    return DecisionRules(
        threshold=d.threshold,
        isolation_margin=d.isolation_margin,
        unexplained_fraction=d.unexplained_fraction,
        dwell=maximum(d.dwell, AT_ONCE),
        retest_time=d.retest_time,
        per_spread=1.0 / d.thrust_uncertainty**2,
    )


def _four(values: Iterable[float]) -> NumberSet:
    return FOUR(*map(number, values))


def start_detection(
    d: DetectionTable,
    vehicle: Vehicle,
    effect: Mixer,
    step: float,
    initial: InitialTable,
    *,
    hovers: bool,
    observed: bool = False,
) -> tuple[RotorLossDetection, DetectionState] | tuple[Absent, Absent]:
    """The detection before its first sample, and its memory; or `Absent`.

    Arguments as of `start_observer`; `observed`: whether the push is estimated from motion.
    """
    if d.model == "none":
        return Absent(), Absent()
    rotors, hover = each(vehicle.rotor_count), vehicle.weight / vehicle.rotor_count
    bound = (BOUND * hover * largest(np.abs(vehicle.effect), axis=1)) ** 2
    detection = RotorLossDetection(
        mass=vehicle.mass,
        inertia=inertia_value(vehicle.inertia),
        effect=effect,
        rotors=low_pass(2.0 / (d.rotor_lag + d.rotor_delay + step), step),
        quick=low_pass(d.bandwidth, step),
        bias_filter=low_pass(d.bias_bandwidth, step),
        scatter_filter=low_pass(d.scatter_bandwidth, step),
        scatter=_four(np.square(d.scatter)),
        bound=_four(bound),
        trial=rotors(*(hover,) * vehicle.rotor_count),
        numbers=rotors(*map(float, range(1, vehicle.rotor_count + 1))),
        rules=_rules(d),
        observed=ObservedPush() if observed else Absent(),
    )
    return detection, _at_start(detection, vehicle, initial, hovers)


def _at_start(k: RotorLossDetection, vehicle: Vehicle, initial: InitialTable, hovers: bool) -> DetectionState:
    """The memory before the first sample: consistent with rest, with a scatter that nothing exceeds."""
    rotors = each(vehicle.rotor_count)
    none, nought = rotors(*(0.0,) * vehicle.rotor_count), _four((0.0,) * 4)
    start = k.trial if hovers else none
    momentum = _four([k.mass * initial.velocity[2], *(vehicle.inertia @ np.array(initial.rates))])
    return DetectionState(
        rotors=LowPassState(start, none),
        thrusts=LowPassState(start, none),
        momentum=LowPassState(momentum, nought),
        others=LowPassState(_four([-vehicle.weight, 0.0, 0.0, 0.0]), nought),
        mean=LowPassState(nought, nought),
        scatter=LowPassState(k.bound * START_SCATTER, nought),
        verdict=DecisionState(lost=none, since=0.0, named=0.0, above=none, alive=0.0),
    )


def detection_checks(table: DetectionTable, method: str) -> Iterator[CheckResult]:
    """Check for a detection with an allocation that cannot omit rotors; `method`: `allocation.method`."""
    if table.model != "none" and method != "constrained":
        yield refused(
            f'detection.model = "{table.model}": must be "none" unless allocation.method is "constrained", '
            "which alone can omit a rotor"
        )
