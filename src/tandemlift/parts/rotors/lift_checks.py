"""Checks that the rotors can lift the vehicle, and hold it in hover with the allocation's distribution."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tandemlift.core.errors import CheckResult, refused, warned
from tandemlift.core.types import Array
from tandemlift.parts.mechanics.vehicle import Vehicle


def lift_checks(rotors: str, weight: float, lift: float, mass_scale: float) -> Iterator[CheckResult]:
    """Check for real rotors whose `lift` [N] is below the weight [N]; `rotors`: `actuators.model`."""
    if rotors == "rotors" and weight > lift:
        yield refused(
            f'actuators.model = "rotors": the vehicle weighs {weight:.4g} N'
            f"{f' (plant.mass_scale = {mass_scale:g})' if mass_scale != 1.0 else ''} "
            f'and its rotors lift {lift:.4g} N at most; it must be lighter, or the model "ideal"'
        )


def ideal_lift_warnings(weight: float, lift: float) -> Iterator[CheckResult]:
    """Check for ideal rotors that give more thrust than real ones could."""
    if weight > lift:
        yield warned(
            f"the vehicle weighs {weight:.4g} N and its rotors lift {lift:.4g} N; it flies only because "
            "actuators.model is ideal"
        )


def hover_thrusts(vehicle: Vehicle, weights: Sequence[Sequence[float]], weight: float) -> Array:
    """Thrusts [N] of all rotors (N × 4) in hover, by the allocation of the weight [N]."""
    return vehicle.allocation(weights)[:, 0].reshape(-1, 4) * weight


def hover_warnings(vehicle: Vehicle, thrusts: Array) -> Iterator[CheckResult]:
    """Check for rotors that cannot give their thrusts (N × 4) [N] in hover."""
    for i, (q, own) in enumerate(zip(vehicle.quadrotors, thrusts, strict=True), 1):
        worst = max(own, key=lambda f: max(-f, f - q.max_thrust))
        if not 0.0 <= worst <= q.max_thrust:
            yield warned(
                f"in hover a rotor of quadrotor {i} would give {worst:.4g} N and can give 0 to {q.max_thrust:.4g} N"
            )
