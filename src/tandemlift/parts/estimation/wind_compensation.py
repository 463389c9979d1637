"""The wind on the payload, estimated from its force on the quadrotors, so that it is not misclassified as a push.

The horizontal external force on quadrotor i, f_i + m_i s_i with s_i its specific force (`push_estimate`), is drag
alone, because its rotors push along z. Drag is ½ ρ C A |v| v by body axis, with the same velocity v through the air for
payload and quadrotors, as long as the vehicle rotates slowly. So along x and y the payload's drag is the mean over the
quadrotors times the ratio of their C A, whatever the wind. Along z nothing is known.

The ratio also multiplies the sensors' errors. For noise σ per sample, taken every T, in the mean of N joints, a
low-pass of bandwidth ω leaves ratio · σ √(ω T/4N); it delays gusts by 2/ω. A drift of d in √s becomes ratio · d √(t/N):
on `iris`, 11 · 0.005 √(50/2) = 0.3 N along x after 50 s.

A floor's friction and a wall would be taken for wind as well, and the push for its opposite, which the pilot then
follows. So nothing is subtracted in lift, landing and contact, and never more than the drag of `FASTEST_WIND`.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.core.algebra import chosen, clip, maximum
from tandemlift.core.arrays import array
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPass, LowPassState, low_pass, low_pass_step
from tandemlift.core.types import Number, PerQuadrotor, number
from tandemlift.core.vector import ZERO, Absent, Vec3, total, vec3
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.mechanics.vehicle_table import Quadrotor

FASTEST_WIND, DENSITY = 8.0, 1.225  # m/s, of a wind beyond that of the tare; kg/m³


class PayloadDrag(NamedTuple):
    """Drag of the payload over that of all quadrotors together, along body x and y; its largest [N]; the low-pass."""

    ratio_x: Number
    ratio_y: Number
    largest: Vec3
    low_pass: LowPass


class PayloadDragState(NamedTuple):
    """Memory: sum and count of the tare's samples of the wind force, and the low-pass [N, body axes]."""

    sum: Vec3
    count: Number  # type: ignore[assignment]  # hides a method of tuples
    force: LowPassState[Vec3]


@law
def tare_mean(memory: PayloadDragState) -> Vec3:
    """The mean over the tare [N]."""
    return memory.sum * (1.0 / maximum(memory.count, 1.0))


@law(absent=(ZERO, "memory"))
def wind_on_payload(
    k: PayloadDrag,
    memory: PayloadDragState,
    x: PerQuadrotor,
    y: PerQuadrotor,
    begun: Number,
    taken: Number,
    armed: Number,
    free: Number,
) -> tuple[Vec3, PayloadDragState]:
    """(force of the wind on the payload beyond the tare's [N, body axes], the new memory).

    `x`, `y`: forces from outside on every quadrotor [N], body axes; 1 or 0: the tare has `begun`, the sample is `taken`
    for it, it is over (`armed`), neither floor nor wall may touch (`free`).
    """
    force = Vec3(total(x) * k.ratio_x, total(y) * k.ratio_y, 0.0)
    summed = PayloadDragState(memory.sum * begun + force * taken, memory.count * begun + taken, memory.force)
    beyond = (force - tare_mean(summed)) * armed
    after = chosen(free, low_pass_step(k.low_pass, memory.force, beyond), LowPassState(ZERO, ZERO))
    # behind the low-pass: single samples go beyond the limit by their noise, whose mean a limit before it would move
    return clip(after.value, -k.largest, k.largest), PayloadDragState(summed.sum, summed.count, after)


@law(absent=ZERO)
def subtracted_wind(memory: PayloadDragState) -> Vec3:
    """The force that was subtracted from the push at the last sample [N, body axes]."""
    return memory.force.value


def start_payload_drag(windage: PayloadDrag | Absent) -> PayloadDragState | Absent:
    """The memory before the first step."""
    return windage if isinstance(windage, Absent) else PayloadDragState(ZERO, 0.0, LowPassState(ZERO, ZERO))


def payload_drag_from(vehicle: Vehicle, bandwidth: float, step: float) -> PayloadDrag:
    """The windage of the nominal vehicle, with a low-pass of a bandwidth [rad/s]."""
    beam = array(vehicle.payload.areas) * vehicle.payload.drag_coefficient
    quadrotors = np.sum([array(q.areas) * q.drag_coefficient for q in vehicle.quadrotors], axis=0)
    x, y = beam[:2] / quadrotors[:2]
    largest = vec3(0.5 * DENSITY * FASTEST_WIND**2 * beam)
    return PayloadDrag(number(x), number(y), largest, low_pass(bandwidth, step))


def compensation_checks(model: str, quadrotors: Sequence[Quadrotor]) -> Iterator[CheckResult]:
    """Check for quadrotors without drag along an axis, which do not measure its wind; `model`: `wind_compensation`."""
    for axis, name in enumerate("xy"):
        if model != "none" and not any(q.areas[axis] * q.drag_coefficient > 0.0 for q in quadrotors):
            yield refused(
                'estimator.wind_compensation = "quadrotors": must be "none" where no quadrotor has drag along body '
                f"{name}: there the wind is not measured"
            )
