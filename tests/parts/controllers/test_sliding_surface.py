"""The sliding surface and its control law, against NumPy, automatic differentiation and the model that it inverts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import array, free_body, numbers, random_vec3, seeds, vectors

from tandemlift.core.vector import Vec3, vec3
from tandemlift.parts.controllers.sliding_surface import (
    Cubic,
    Power,
    Saturation,
    Sign,
    Surface,
    Tanh,
    equivalent_control,
    reaching_control,
    saturate,
    sign,
    sliding_surface,
    surface_rate,
    surface_slope,
    switching,
    terminal,
    terminal_slope,
    wanted_acceleration,
)
from tandemlift.parts.mechanics.equations_of_motion import GeneralizedVector, drift, expanded_dynamics, response
from tandemlift.parts.mechanics.rigid_body import RigidBody

EXPONENTS = [1.0, 1.5, 3.0]
XI, ETA = Vec3(4.0, 2.0, 11.0), Vec3(0.2, 0.1, 0.7)
L1, L2 = Vec3(0.2, 0.1, 2.0), Vec3(2.0, 1.0, 3.0)


def power_of(a: float) -> Power:
    return Power(Vec3(a, a, a))


def surface(exponent, kind=Sign()) -> Surface:  # noqa: B008  (a constant)
    return Surface(XI, ETA, exponent, L1, L2, kind)


@given(numbers())
def test_the_sign_is_of_three_values(x):
    assert sign(x) == np.sign(x)
    assert sign(0.0) == sign(-0.0) == 0.0


@given(numbers(), st.floats(0.01, 1.0))
def test_saturation_is_linear_within_its_layer_and_the_sign_outside(S, width):
    assert saturate(S / width) == pytest.approx(S / width if abs(S) <= width else np.sign(S))


def test_saturation_below_its_layer_is_minus_one():
    """Erratum sat_equ: printed, the third case holds for S < Φ and contradicts the second; S/Φ is divided once."""
    width = 0.1
    assert saturate(-0.5 / width) == -1.0
    assert saturate(0.05 / width) == 0.5  # S < Φ, yet not −1
    kind = Saturation(Vec3(10.0, 10.0, 10.0))
    assert switching(kind, Vec3(0.05, -0.05, 0.02)) == pytest.approx((0.5, -0.5, 0.2))
    printed = np.clip(np.array([0.005, 0.02]) / width / width, -1.0, 1.0)  # sat(S/Φ) by a sat that divides by Φ
    assert printed == pytest.approx([0.5, 1.0])  # full already at Φ² = 0.01


@given(vectors())
def test_every_switching_is_odd_bounded_and_never_against_the_sign(S):
    width = Vec3(10.0, 5.0, 2.0)
    for kind in (Sign(), Saturation(width), Tanh(width)):
        value, mirrored = array(switching(kind, S)), array(switching(kind, -S))
        assert np.array_equal(value, -mirrored)
        assert np.abs(value).max() <= 1.0
        assert np.all(value * array(S) >= 0.0)


@pytest.mark.parametrize("a", EXPONENTS)
@given(e=vectors())
def test_the_terminal_term_is_the_signed_power(a, e):
    expected = np.abs(array(e)) ** a * np.sign(array(e))
    slope = a * np.abs(array(e)) ** (a - 1.0)
    kinds = [power_of(a), Cubic()] if a == 3.0 else [power_of(a)]
    for kind in kinds:
        assert array(terminal(kind, e)) == pytest.approx(expected, rel=1e-13, abs=1e-300)
        assert array(terminal_slope(kind, e)) == pytest.approx(slope, rel=1e-13, abs=2e-150)


@pytest.mark.parametrize("a", [1.5, "cubic"])
def test_the_surface_changes_along_a_trajectory_at_the_surface_rate(a, jax):
    """Ṡ by automatic differentiation of S along e(t)."""
    k = surface(Cubic() if a == "cubic" else power_of(a))
    w, phase = Vec3(1.3, 0.7, 2.1), Vec3(0.3, -1.1, 0.8)

    def error(t):
        return Vec3(*(jax.numpy.sin(w_i * t + p_i) * (1.0 + 0.2 * t) for w_i, p_i in zip(w, phase, strict=True)))

    def rate(f):
        return lambda t: jax.jvp(f, (t,), (1.0,))[1]

    def along(t):
        return sliding_surface(k, error(t), rate(error)(t))

    for t in (0.05, 0.4, 1.9):
        e, de, dde = error(t), rate(error)(t), rate(rate(error))(t)
        assert array(surface_rate(k, e, de, dde)) == pytest.approx(array(rate(along)(t)), rel=1e-12)


@given(vectors(), vectors())
def test_the_slope_of_the_surface_is_that_of_its_error_terms(e, de):
    k, h = surface(power_of(2.5)), 1e-6
    ahead, behind = (sliding_surface(k, e + Vec3(1.0, 1.0, 1.0) * (s * h), de) for s in (1.0, -1.0))
    assert array(surface_slope(k, e)) == pytest.approx((array(ahead) - array(behind)) / (2.0 * h), abs=1e-5)


class Case:
    """A random error on a random model under random disturbances, and what the paper's law commands there."""

    def __init__(self, seed: int, known: bool) -> None:
        rng = np.random.default_rng(seed)
        self.body: RigidBody = free_body(3.5, np.diag([3.2, 0.06, 3.3]))._replace(
            drag_force=Vec3(0.1, 0.2, 0.3),
            drag_moment=Vec3(0.4, 0.5, 0.6),
            force=random_vec3(rng),
            moment=random_vec3(rng, 0.1),
        )
        self.k = surface(Cubic())
        self.e, self.de = (GeneralizedVector(random_vec3(rng), random_vec3(rng)) for _ in range(2))
        self.velocity, self.rates = random_vec3(rng), random_vec3(rng)
        self.wanted = GeneralizedVector(random_vec3(rng), random_vec3(rng))  # χ̈_d
        self.delta = response(self.body, GeneralizedVector(self.body.force, self.body.moment))
        self.believed = self.delta if known else GeneralizedVector(vec3(np.zeros(3)), vec3(np.zeros(3)))

    def input(self, *extra: GeneralizedVector) -> GeneralizedVector:
        """u = (χ̈_d − Ϝ − δ̂ + …)/b."""
        total = self.wanted
        F = drift(self.body, self.velocity, self.rates)
        for part, factor in ((F, -1.0), (self.believed, -1.0), *((x, 1.0) for x in extra)):
            total = total + GeneralizedVector(part.position * factor, part.attitude * factor)
        return GeneralizedVector(total.position / self.body.inverse_mass, total.attitude / self.body.inverse_inertia)

    def each(self, f) -> GeneralizedVector:
        return GeneralizedVector(*(f(self.k, e, de) for e, de in zip(self.e, self.de, strict=True)))

    def surface_rate(self, u: GeneralizedVector) -> np.ndarray:
        moved = expanded_dynamics(self.body, self.velocity, self.rates, u)
        return np.concatenate(
            [
                array(surface_rate(self.k, e, de, wanted - is_))
                for e, de, wanted, is_ in zip(self.e, self.de, self.wanted, moved, strict=True)
            ]
        )


@given(seeds)
def test_equivalent_control_holds_the_surface_if_the_disturbance_is_known(seed):
    case = Case(seed, known=True)
    assert case.surface_rate(case.input(case.each(equivalent_control))) == pytest.approx(np.zeros(6), abs=1e-12)


@given(seeds)
def test_an_unknown_disturbance_drives_the_surface_by_its_own_size(seed):
    """Erratum u_hat_equ: δ is not known to the pilot; what is left over is δ − δ̂."""
    case = Case(seed, known=False)
    left = case.surface_rate(case.input(case.each(equivalent_control)))
    assert left == pytest.approx(-np.concatenate([array(d) for d in case.delta]), abs=1e-12)


@given(seeds)
def test_the_whole_law_reaches_for_the_surface(seed):
    """Ṡ = −λ₁S − λ₂ sgn S, on all six axes."""
    case = Case(seed, known=True)
    S = np.concatenate([array(s) for s in case.each(sliding_surface)])
    l1, l2 = np.tile(array(L1), 2), np.tile(array(L2), 2)
    found = case.surface_rate(case.input(case.each(wanted_acceleration)))
    assert found == pytest.approx(-l1 * S - l2 * np.sign(S), abs=1e-11)
    reaching = [reaching_control(case.k, sliding_surface(case.k, e, d)) for e, d in zip(case.e, case.de, strict=True)]
    assert found == pytest.approx(-np.concatenate([array(r) for r in reaching]), abs=1e-11)
