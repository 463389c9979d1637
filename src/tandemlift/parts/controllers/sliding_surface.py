"""The nonsingular fast terminal sliding surface, its control law, and its stability by Lyapunov's method.

Per axis, with e = desired − actual: S = ė + ξe + η|e|ᵃ sgn e. These laws hold for vectors of axes and for single
numbers. With the exponent a ≥ 1 of the paper the approach on S = 0 is exponential near zero, not finite-time.
"""

from typing import NamedTuple

from tandemlift.core.algebra import absolute, clip, log, power, tanh, where
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.types import Number
from tandemlift.core.vector import Vec3


class Sign(NamedTuple):
    """Switching by sgn(S): the paper's discontinuous law."""


class Saturation(NamedTuple):
    """Switching by sat(S; Φ); `per_width` is 1/Φ per axis, in the unit of 1/S."""

    per_width: Vec3


class Tanh(NamedTuple):
    """Switching by tanh(S/Φ); `per_width` is 1/Φ per axis, in the unit of 1/S."""

    per_width: Vec3


class Cubic(NamedTuple):
    """The exponent a = 3, by multiplication."""


class Power(NamedTuple):
    """Any exponent a ≥ 1, per axis."""

    a: Vec3


class Surface(NamedTuple):
    """Gains of one set of axes: ξ [1/s], η, the exponent, λ₁ [1/s], λ₂ and the switching function."""

    xi: Vec3
    eta: Vec3
    exponent: Cubic | Power
    lambda_1: Vec3
    lambda_2: Vec3
    switching: Sign | Saturation | Tanh


@elementwise
def sign(x: Number) -> Number:
    """sgn x: 1, 0 or −1."""
    # paper: sgn_equ
    return where(x > 0.0, 1.0, where(x < 0.0, -1.0, 0.0))


@elementwise
def saturate(x: Number) -> Number:
    """x within [−1, 1]. Erratum: sat(S; Φ) divides by Φ once, and its third case is S < −Φ."""
    # paper: sat_equ
    return clip(x, -1.0, 1.0)


@choice
def switching(kind: Sign | Saturation | Tanh, S: Vec3) -> Vec3:
    """sgn(S), or its substitute in the boundary layer."""


@switching.register(Sign)
def _sign(kind: Sign, S: Vec3) -> Vec3:
    return sign(S)


@switching.register(Saturation)
def _saturation(kind: Saturation, S: Vec3) -> Vec3:
    return saturate(S * kind.per_width)


@switching.register(Tanh)
def _tanh(kind: Tanh, S: Vec3) -> Vec3:
    return tanh(S * kind.per_width)


@elementwise
def signed_power(e: Number, a: Number) -> Number:
    """sgn(e)ᵃ = |e|ᵃ sgn e."""
    return sign(e) * power(absolute(e), a)


@elementwise
def power_slope(e: Number, a: Number) -> Number:
    """a |e|ᵃ⁻¹, the derivative of |e|ᵃ sgn e."""
    return a * power(absolute(e), a - 1.0)


@choice
def terminal(exponent: Cubic | Power, e: Vec3) -> Vec3:
    """|e|ᵃ sgn e."""


@choice
def terminal_slope(exponent: Cubic | Power, e: Vec3) -> Vec3:
    """a |e|ᵃ⁻¹."""


@terminal.register(Cubic)
def _cube(exponent: Cubic, e: Vec3) -> Vec3:
    return e * e * e


@terminal_slope.register(Cubic)
def _cube_slope(exponent: Cubic, e: Vec3) -> Vec3:
    return e * e * 3.0


@terminal.register(Power)
def _power(exponent: Power, e: Vec3) -> Vec3:
    return signed_power(e, exponent.a)


@terminal_slope.register(Power)
def _power_slope(exponent: Power, e: Vec3) -> Vec3:
    return power_slope(e, exponent.a)


@law
def sliding_surface(k: Surface, e: Vec3, de: Vec3) -> Vec3:
    """S = ė + ξe + η|e|ᵃ sgn e."""
    # paper: sliding_surface_equ
    return de + k.xi * e + k.eta * terminal(k.exponent, e)


@law
def surface_slope(k: Surface, e: Vec3) -> Vec3:
    """ξ + ηa|e|ᵃ⁻¹: the factor of ė in Ṡ − ë."""
    return k.xi + k.eta * terminal_slope(k.exponent, e)


@law
def surface_rate(k: Surface, e: Vec3, de: Vec3, dde: Vec3) -> Vec3:
    """Ṡ = ë + (ξ + ηa|e|ᵃ⁻¹) ė."""
    # paper: sliding_surface_dot_equ, and sdot_equ with ë = χ̈_d − Ϝ − δ − b u
    return dde + surface_slope(k, e) * de


@law
def equivalent_control(k: Surface, e: Vec3, de: Vec3) -> Vec3:
    """The acceleration beyond the reference's and the model's that holds Ṡ = 0 with δ̂ = 0: (ξ + ηa|e|ᵃ⁻¹) ė."""
    # paper: u_hat_equ
    return surface_slope(k, e) * de


@law
def reaching_control(k: Surface, S: Vec3) -> Vec3:
    """The acceleration that drives S to zero: λ₁S + λ₂ sw(S/Φ)."""
    # paper: control_final1_equ
    return k.lambda_1 * S + k.lambda_2 * switching(k.switching, S)


@law
def wanted_acceleration(k: Surface, e: Vec3, de: Vec3) -> Vec3:
    """(ξ + ηa|e|ᵃ⁻¹)ė + λ₁S + λ₂ sw(S/Φ), to be added to the reference acceleration."""
    # paper: control_final1_equ
    return equivalent_control(k, e, de) + reaching_control(k, sliding_surface(k, e, de))


@law
def lyapunov(S: Vec3) -> Vec3:
    """V = S²/2 per axis. Erratum: for six axes the paper's V is this of each axis, or SᵀS/2."""
    # paper: lyap_fun_equ
    return S * S * 0.5


@law
def lyapunov_rate(S: Vec3, dS: Vec3) -> Vec3:
    """V̇ = S Ṡ per axis."""
    # paper: vdot_equ, and vsdot_equ with the Ṡ of sdot_equ
    return S * dS


@elementwise
def lyapunov_rate_bound(lambda_1: Number, lambda_2: Number, S: Number, disturbance: Number) -> Number:
    """−λ₁S² − (λ₂ − |δ|)|S|, never below V̇ with `sign`. Erratum: the paper's has no |δ|."""
    # paper: vsdot_f_equ
    return -lambda_1 * S * S - (lambda_2 - absolute(disturbance)) * absolute(S)


@elementwise
def reaching_time(lambda_1: Number, lambda_2: Number, S0: Number, disturbance: Number) -> Number:
    """The time [s] by which S reaches 0 from S₀ when |δ| < λ₂: ln(1 + λ₁|S₀|/(λ₂ − |δ|))/λ₁; exact for δ = 0."""
    # paper: reach_time_equ
    return log(1.0 + lambda_1 * absolute(S0) / (lambda_2 - absolute(disturbance))) / lambda_1
