"""Checks that the rotors can lift the vehicle, and hold it in hover with the allocation's distribution."""

from __future__ import annotations

from collections.abc import Iterator

from tandemlift.core.errors import CheckResult, refused, warned
from tandemlift.parts.rotors.hover import HoverFacts


def lift_checks(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for real rotors that cannot lift the vehicle."""
    scale = hover.plant.mass_scale
    if hover.actuators.model == "rotors" and hover.weight > hover.lift:
        yield refused(
            f'actuators.model = "rotors": the vehicle weighs {hover.weight:.4g} N'
            f"{f' (plant.mass_scale = {scale:g})' if scale != 1.0 else ''} "
            f'and its rotors lift {hover.lift:.4g} N at most; it must be lighter, or the model "ideal"'
        )


def ideal_lift_warnings(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for ideal rotors that give more thrust than real ones could."""
    if hover.weight > hover.lift:
        yield warned(
            f"the vehicle weighs {hover.weight:.4g} N and its rotors lift {hover.lift:.4g} N; it flies only because "
            "actuators.model is ideal"
        )


def hover_warnings(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for rotors that cannot give their thrusts in hover."""
    for i, (q, own) in enumerate(zip(hover.vehicle.quadrotors, hover.thrusts, strict=True), 1):
        worst = max(own, key=lambda f: max(-f, f - q.thrust_limit))
        if not 0.0 <= worst <= q.thrust_limit:
            yield warned(
                f"in hover a rotor of quadrotor {i} would give {worst:.4g} N and can give 0 to {q.thrust_limit:.4g} N"
            )


def payload_warnings(hover: HoverFacts) -> Iterator[CheckResult]:
    """Check for a true mass so small that the payload would have none."""
    scale = hover.plant.mass_scale
    if hover.payload_mass <= 0.0:
        yield warned(
            f"plant.mass_scale = {scale}: the joint forces assign all of the difference to the payload, "
            f"which would weigh {hover.payload_mass:.4g} kg"
        )
