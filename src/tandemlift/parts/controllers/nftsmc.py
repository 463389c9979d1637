"""The paper's controller: nonsingular fast terminal sliding mode control of position and attitude.

Guarantee, per axis under virtual actuation, with switching by `sign` and λ₂ > ‖δ − δ̂‖: V̇ ≤ −λ₁S² − (λ₂ − |δ|)|S|, so
S = 0 is reached within `sliding_surface.reaching_time`; with a boundary layer, |S| ≤ Φ is. It does not cover the
attitude cascade. The switching must be sampled fast enough: (λ₁ + λ₂/Φ) · step < 2.

The laws of surface and reaching are in `sliding_surface`.

Tune first: the boundary layer Φ against the step, then ξ (the bandwidth on the surface), then λ₁ and λ₂.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, NamedTuple

from pydantic import Field

from tandemlift.core.errors import CheckResult, warned
from tandemlift.core.keys import AtLeastOne6, NonNegative6, Positive6, Table, Tilt, key
from tandemlift.core.law import law
from tandemlift.core.low_pass import LowPassState, low_pass
from tandemlift.core.trajectories import Reference, Trajectory
from tandemlift.core.types import GRAVITY, Number
from tandemlift.core.vector import ZERO, Absent, Vec3, vec3
from tandemlift.parts.controllers.attitude_reference import (
    AttitudeReference,
    CommandFilter,
    CommandFilterState,
    SmoothCommandFilter,
    SmoothCommandFilterState,
    Unfiltered,
    command_filter,
    shape_reference,
    with_heading,
)
from tandemlift.parts.controllers.interface import Command, ControllerTable, Measured, NoMemory, control
from tandemlift.parts.controllers.registry import register
from tandemlift.parts.controllers.sliding_surface import (
    Cubic,
    Power,
    Saturation,
    Sign,
    Surface,
    Tanh,
    wanted_acceleration,
)
from tandemlift.parts.mechanics.rigid_body import UP, Inertia, State, Wrench, apply_inertia, gyroscopic, inertia_value
from tandemlift.parts.mechanics.rotation import (
    Euler,
    TiltLimit,
    TiltPrinted,
    TiltZXY,
    desired_orientation,
    euler_from_quaternion,
    euler_rates_from_rates,
    limit_tilt,
    tilt_limit,
    total_thrust,
    wrap_angle,
)
from tandemlift.parts.mechanics.vehicle import Vehicle

FilterMemory = CommandFilterState | SmoothCommandFilterState | NoMemory


class Gains(Table):
    """`[controller.gains]`: gains of nftsmc for x, y, z, roll, pitch, yaw; paper Table III."""

    xi: Positive6 = key(..., "1/s", "ξ, linear part of the sliding surface", example=[4.0, 2.0, 11.0, 25.0, 80.0, 25.0])
    eta: NonNegative6 = key(
        ...,
        "1/(s mᵃ⁻¹), 1/(s radᵃ⁻¹)",
        "η, terminal part of the sliding surface",
        example=[0.2, 0.1, 0.2, 0.2, 0.2, 0.2],
    )
    lambda_1: NonNegative6 = key(..., "1/s", "λ₁, proportional reaching", example=[0.2, 0.1, 200.0, 40.0, 40.0, 40.0])
    lambda_2: NonNegative6 = key(..., "m/s², rad/s²", "λ₂, switching gain", example=[2.0, 1.0, 100.0, 30.0, 30.0, 30.0])
    a: AtLeastOne6 = key(..., "1", "exponent of the terminal part", example=3.0)


class NFTSMCSettings(
    ControllerTable,
    keys_act={
        "filter_bandwidth smoothing_bandwidth": 'controller.attitude_reference_derivatives = "filtered"',
        "boundary_layer": 'controller.switching = "saturation" or "tanh"',
    },
):
    """`[controller]`: settings of nftsmc, the paper's controller."""

    name: Literal["nftsmc"] = "nftsmc"
    gains: Gains
    switching: Literal["sign", "saturation", "tanh"] = key(
        "tanh",
        None,
        "the switching function, in place of sgn(S)",
        choices={"sign": "sgn(S)", "saturation": "sat(S/Φ)", "tanh": "tanh(S/Φ)"},
    )
    boundary_layer: Positive6 = key(
        (0.1, 0.1, 0.1, 0.1, 0.1, 0.1),
        "m/s, rad/s",
        "boundary layer Φ; where (λ₁ + λ₂/Φ) · step ≥ 2, it chatters, and a warning says so",
        source="chosen; the paper leaves 0 < Φ < 1 open",
    )
    attitude_reference_derivatives: Literal["zero", "filtered"] = key(
        "zero",
        None,
        "derivatives of the attitude reference",
        choices={"zero": "taken to be zero", "filtered": "of a second-order command filter, which the law then tracks"},
    )
    filter_bandwidth: Annotated[float, Field(gt=0.0, le=1e4)] = key(
        60.0, "rad/s", "bandwidth of the command filter of attitude_reference_derivatives", source="chosen"
    )
    smoothing_bandwidth: Annotated[float, Field(ge=0.0, le=1e4)] = key(
        0.0,
        "rad/s",
        "bandwidth of a low-pass before this filter, which keeps noise out of the reference's accelerations; 0: none",
        source="the paper has none",
    )
    euler_rates: Literal["exact", "body"] = key(
        "exact",
        None,
        "the Euler rates of the attitude law",
        choices={"exact": "from body rates by the exact relation", "body": "body rates (the paper's Assumption 4)"},
    )
    tilt_inverse: Literal["zxy", "printed"] = key(
        "zxy",
        None,
        "conversion of a desired force to roll and pitch",
        choices={"zxy": "exactly, for Z-X-Y angles", "printed": "as the paper prints it"},
    )
    human_force_feedforward: bool = key(False, None, "true: the position law compensates the measured push")
    max_tilt: Tilt | None = key(
        None, "rad", "largest angle of the desired force from the vertical", unset="there is no limit", example=0.5
    )

    def checks(self, step: float) -> Iterator[CheckResult]:
        """A warning where the switching may chatter: (λ₁ + λ₂/Φ) · step ≥ 2 on an axis."""
        if self.switching == "sign":
            return
        gains, widths = self.gains, self.boundary_layer
        slopes = [l1 + l2 / w for l1, l2, w in zip(gains.lambda_1, gains.lambda_2, widths, strict=True)]
        worst = max(range(6), key=slopes.__getitem__)
        if slopes[worst] * step >= 2.0:
            axis = ("x", "y", "z", "roll", "pitch", "yaw")[worst]
            yield warned(
                f"(lambda_1 + lambda_2/boundary_layer) * step = {slopes[worst] * step:.3g} on {axis} is not below 2: "
                f"the switching may chatter; widen controller.boundary_layer or shorten mission.step"
            )


class ExactRates(NamedTuple):
    """Euler rates from body rates by the exact relation."""


class BodyRates(NamedTuple):
    """Euler rates taken to be the body rates (the paper's Assumption 4)."""


class NFTSMC(NamedTuple):
    """Gains: the vehicle as the controller believes it to be, the two surfaces, and the variants by type.

    `feedforward` is 1 to feed the measured push forward as δ̂ in the position law, else 0.
    """

    mass: Number
    inertia: Inertia
    drag_force: Vec3
    drag_moment: Vec3
    position: Surface
    attitude: Surface
    derivatives: Unfiltered | CommandFilter | SmoothCommandFilter
    rates: ExactRates | BodyRates
    inverse: TiltZXY | TiltPrinted
    tilt: TiltLimit | Absent
    feedforward: Number


@law(instead={BodyRates: "rates"})
def euler_rates(kind: ExactRates, e: Euler, rates: Vec3) -> Vec3:
    """(φ̇, θ̇, ψ̇) for the attitude law, from body rates [rad/s]."""
    return euler_rates_from_rates(e, rates)


@law
def position_law(k: NFTSMC, state: State, desired: Trajectory, push: Vec3) -> Vec3:
    """The force (u_x, u_y, u_z) [N, world axes] commanded by the position surface.

    Erratum: the paper leaves m_t out on ÿ_d and on the last line of u_z; it multiplies both.
    """
    # paper: pos_cont_equ, error_equ
    e, de = desired.position - state.position, desired.velocity - state.velocity
    acceleration = desired.acceleration + wanted_acceleration(k.position, e, de) + UP * GRAVITY
    return acceleration * k.mass + k.drag_force * state.velocity - push * k.feedforward


@law
def attitude_law(k: NFTSMC, e: Euler, rates: Vec3, desired: AttitudeReference) -> Vec3:
    """The moments (U₂, U₃, U₄) [N·m] commanded by the attitude surface; `rates` are Euler rates [rad/s].

    Errata: J is the whole vehicle's; sat(S_ψ/Φ), not sat(S_ψ)/Φ.
    """
    # paper: orient_cont_equ, control_final_equ, error_equ
    error, error_rate = wrap_angle(desired.angles - e.angles), desired.rates - rates
    acceleration = desired.accelerations + wanted_acceleration(k.attitude, error, error_rate)
    return apply_inertia(k.inertia, acceleration) - gyroscopic(k.inertia, rates) + k.drag_moment * rates


@control.register(NFTSMC)
def nftsmc(k: NFTSMC, memory: FilterMemory, measured: Measured, reference: Reference) -> tuple[Command, FilterMemory]:
    """The whole controller at one sample."""
    e = euler_from_quaternion(measured.state.attitude)
    force = position_law(k, measured.state, reference.trajectory, measured.push)
    # lead and observer are not in the paper: they stay outside its law, and the limit holds for all together
    u = limit_tilt(k.tilt, force + reference.lead * k.mass - measured.disturbance.force)
    desired, memory = shape_reference(k.derivatives, memory, desired_orientation(k.inverse, u, e, reference.yaw))
    tracked = with_heading(desired, reference)
    rates = euler_rates(k.rates, e, measured.state.rates)
    moment = attitude_law(k, e, rates, tracked) - measured.disturbance.moment
    return Command(Wrench(total_thrust(e, u), moment), tracked.angles), memory


def _surface(s: NFTSMCSettings, first: int) -> Surface:
    """The surface of the three axes from number `first` on."""

    def pick(values: Sequence[float]) -> Vec3:
        return vec3(values[first : first + 3])

    g, widths = s.gains, pick(s.boundary_layer)
    per_width = Vec3(1.0 / widths.x, 1.0 / widths.y, 1.0 / widths.z)
    kinds: dict[str, Sign | Saturation | Tanh]
    kinds = {"sign": Sign(), "saturation": Saturation(per_width), "tanh": Tanh(per_width)}
    exponent = Cubic() if all(a == 3.0 for a in pick(g.a)) else Power(pick(g.a))
    return Surface(pick(g.xi), pick(g.eta), exponent, pick(g.lambda_1), pick(g.lambda_2), kinds[s.switching])


def _derivatives(
    s: NFTSMCSettings, step: float
) -> tuple[Unfiltered | CommandFilter | SmoothCommandFilter, FilterMemory]:
    """The filter of the attitude reference, and its memory at rest at zero."""
    if s.attitude_reference_derivatives == "zero":
        return Unfiltered(), NoMemory()
    own, level = command_filter(s.filter_bandwidth, step), CommandFilterState(ZERO, ZERO)
    if s.smoothing_bandwidth == 0.0:
        return own, level
    smooth = SmoothCommandFilterState(LowPassState(ZERO, ZERO), level)
    return SmoothCommandFilter(low_pass(s.smoothing_bandwidth, step), own), smooth


@register("nftsmc", NFTSMCSettings)
def start(s: NFTSMCSettings, vehicle: Vehicle, step: float) -> tuple[NFTSMC, FilterMemory]:
    """Nonsingular fast terminal sliding mode control of position and attitude (the paper's)."""
    derivatives, memory = _derivatives(s, step)
    gains = NFTSMC(
        mass=vehicle.mass,
        inertia=inertia_value(vehicle.inertia),
        drag_force=vec3(vehicle.drag.force),
        drag_moment=vec3(vehicle.drag.moment),
        position=_surface(s, 0),
        attitude=_surface(s, 3),
        derivatives=derivatives,
        rates=ExactRates() if s.euler_rates == "exact" else BodyRates(),
        inverse=TiltZXY() if s.tilt_inverse == "zxy" else TiltPrinted(),
        tilt=tilt_limit(s.max_tilt),
        feedforward=1.0 if s.human_force_feedforward else 0.0,
    )
    return gains, memory
