"""The detection of rotor failures of a mission."""

from __future__ import annotations

from typing import Any

import numpy as np

from tandemlift.core.algebra.arrays import largest
from tandemlift.core.algebra.types import number
from tandemlift.core.algebra.vector import Nothing, each
from tandemlift.core.settings import DetectionTable, Mission
from tandemlift.parts.estimation.rotor_loss_decision import DecisionRules, DecisionState
from tandemlift.parts.estimation.rotor_loss_detection import FOUR, START_SCATTER, DetectionState, RotorLossDetection
from tandemlift.parts.mechanics.inertia import inertia_value
from tandemlift.parts.rotors.allocation import Mixer
from tandemlift.parts.signals.low_pass import LowPassState, low_pass
from tandemlift.parts.vehicle import Vehicle

BOUND = 0.5  # of the residual after a rotor failure: the largest contribution of a sample to the scatter


def _rules(d: DetectionTable) -> DecisionRules:
    return DecisionRules(
        threshold=d.threshold,
        isolation_margin=d.isolation_margin,
        unexplained_fraction=d.unexplained_fraction,
        dwell=d.dwell,
        retest_time=d.retest_time,
        per_spread=1.0 / d.thrust_uncertainty**2,
    )


def _four(values: Any) -> Any:
    return FOUR(*map(number, values))


def start_detection(mission: Mission, vehicle: Vehicle, effect: Mixer) -> tuple[Any, Any]:
    """The detection of a mission before its first sample, and its memory; or `Nothing`."""
    d, step = mission.detection, mission.mission.step
    if d.model == "none":
        return Nothing(), Nothing()
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
    )
    return detection, _at_start(mission, vehicle, detection)


def _at_start(mission: Mission, vehicle: Vehicle, k: RotorLossDetection) -> DetectionState:
    """The memory before the first sample: consistent with rest, with a scatter that nothing exceeds."""
    i, rotors = mission.initial, each(vehicle.rotor_count)
    none, nought = rotors(*(0.0,) * vehicle.rotor_count), _four((0.0,) * 4)
    start = k.trial if mission.actuators.start == "hover" else none
    momentum = _four([k.mass * i.velocity[2], *(vehicle.inertia @ np.array(i.rates))])
    return DetectionState(
        rotors=LowPassState(start, none),
        thrusts=LowPassState(start, none),
        momentum=LowPassState(momentum, nought),
        others=LowPassState(_four([-vehicle.weight, 0.0, 0.0, 0.0]), nought),
        mean=LowPassState(nought, nought),
        scatter=LowPassState(k.bound * START_SCATTER, nought),
        verdict=DecisionState(lost=none, since=0.0, named=0.0, above=none, alive=0.0),
    )
