"""Wind: gusts and turbulence by the standard's own spectra, the drag of the air by energy and by what falls in it.

The turbulence is taken as what its laws do: as they are linear, unit eddies and unit whiffs show its transition F, the
factor L of its noise and its output C. What these must come to follows from the spectra of MIL-F-8785C by quadrature.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import numbers
from machine_code import Loop
from scipy.integrate import quad, quad_vec
from scipy.linalg import expm, solve_continuous_lyapunov
from scipy.signal import welch
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import ZERO, Absent, Vec3
from tandemlift.parts.mechanics.turbulence import (
    Dryden,
    TurbulenceState,
    WindNoise,
    dryden,
    start_turbulence,
    turbulence_step,
    turbulence_velocity,
)
from tandemlift.parts.mechanics.wind import AirDrag, Gust, WindModel, gust_velocity, wind_step
from tandemlift.simulation.loop.random_numbers import key_from_seed, normals

FOOT = 0.3048
NO_EDDIES, NO_WHIFFS = TurbulenceState(*[0.0] * 5), WindNoise(*[0.0] * 5)
NO_DRAG = AirDrag(ZERO, ZERO)
STEADY = WindModel(Vec3(4.0, -2.0, 0.5), Absent(), NO_DRAG)
X = (1.0, 0.0, 0.0)


def phi_u(k: float, L: float) -> float:
    """Φ_u(Ω) / σ_u² of the standard, one-sided."""
    return 2.0 * L / np.pi / (1.0 + (L * k) ** 2)


def phi_vw(k: float, L: float) -> float:
    """Φ_v(Ω) / σ_v² and Φ_w(Ω) / σ_w² of the standard, one-sided."""
    return L / np.pi * (1.0 + 3.0 * (L * k) ** 2) / (1.0 + (L * k) ** 2) ** 2


PHI = (phi_u, phi_vw, phi_vw)


def scales(height: float, wind_20ft: float) -> tuple[list[float], list[float]]:
    """σ [m/s] and L [m] of u, v, w as the standard's low-altitude model has them."""
    h = height / FOOT
    horizontal, sigma_w = h / (0.177 + 0.000823 * h) ** 1.2, 0.1 * wind_20ft
    sigma_u = sigma_w / (0.177 + 0.000823 * h) ** 0.4
    return [sigma_u, sigma_u, sigma_w], [horizontal * FOOT, horizontal * FOOT, height]


class Linear(NamedTuple):
    """x ← F x + L n, velocity of the air = C x [m/s]."""

    F: np.ndarray
    L: np.ndarray
    C: np.ndarray


def linear(d: Dryden) -> Linear:
    unit = np.eye(5).tolist()
    F = np.transpose([turbulence_step(d, TurbulenceState(*e), NO_WHIFFS) for e in unit])
    L = np.transpose([turbulence_step(d, NO_EDDIES, WindNoise(*e)) for e in unit])
    return Linear(F, L, np.transpose([turbulence_velocity(d, TurbulenceState(*e)) for e in unit]))


STEPS = pytest.mark.parametrize("step", [1e-4, 1e-2, 3.0])


@STEPS
def test_five_normal_numbers_are_the_stationary_memory_at_any_step(step):
    d = dryden(8.0, 6.0, 4.0, X, step)
    F, L, _ = linear(d)
    assert np.eye(5) == pytest.approx(F @ F.T + L @ L.T, abs=1e-14)
    assert start_turbulence(d, [0.1, 0.2, 0.3, 0.4, 0.5]) == TurbulenceState(0.1, 0.2, 0.3, 0.4, 0.5)


@STEPS
def test_samples_have_the_variance_and_the_autocorrelation_of_the_standard_at_any_step(step):
    V = 4.0
    sigmas, lengths = scales(6.0, 8.0)
    F, _, C = linear(dryden(8.0, 6.0, V, X, step))
    for count in (0, 1, 2, 7, 40):
        found = C @ np.linalg.matrix_power(F, count) @ C.T
        r = V * step * count / np.array(lengths)
        shape = np.array([1.0, 1.0 - r[1] / 2.0, 1.0 - r[2] / 2.0]) * np.exp(-r)
        assert found == pytest.approx(np.diag(np.array(sigmas) ** 2 * shape), abs=1e-11)


@pytest.mark.parametrize("turns", [1e-6, 1e-2, 10.0])
def test_the_noise_of_a_step_is_that_of_the_forming_filter(turns):
    """(1 + √3 s)/(1 + s)² in companion form with its noise by quadrature, brought to the coordinates (v, h).

    The determinant, (det [b, Nb])² θ⁴/12 = 16 θ⁴/12 to leading order, shows that Q's small eigenvalue (of θ³) is there.
    """
    height = 20.0
    F, L, _ = (M[3:, 3:] for M in linear(dryden(8.0, height, 1.0, X, turns * height)))
    A, B, C = np.array([[0.0, 1.0], [-1.0, -2.0]]), np.array([[0.0], [1.0]]), np.array([1.0, np.sqrt(3.0)])
    P = solve_continuous_lyapunov(A, -B @ B.T)
    beside = np.array([[0.0, 1.0], [-1.0, 0.0]]) @ P @ C  # its number is not correlated with that of C
    T = np.array([x / np.sqrt(x @ P @ x) for x in (C, beside)])
    T[1] *= np.sign((T @ A @ np.linalg.inv(T))[1, 0])
    assert T @ expm(A * turns) @ np.linalg.inv(T) == pytest.approx(F, abs=1e-12)
    Q, _ = quad_vec(lambda s: T @ expm(A * s) @ B @ B.T @ expm(A.T * s) @ T.T, 0.0, turns, epsrel=1e-12)
    assert pytest.approx(Q, rel=1e-9) == L @ L.T
    if turns < 1e-3:
        assert np.linalg.det(L) ** 2 == pytest.approx(16.0 * turns**4 / 12.0, rel=3.0 * turns)


def test_turbulence_at_a_thousand_feet_is_the_same_in_all_directions():
    """There the ground's layer ends: every σ is a tenth of W₂₀ and every L a thousand feet."""
    F, _, C = linear(dryden(15.0, 1000.0 * FOOT, 10.0, X, 1.0))
    assert np.sqrt(np.diag(C @ C.T)) == pytest.approx([1.5, 1.5, 1.5])
    assert F[0, 0] == pytest.approx(np.exp(-10.0 / (1000.0 * FOOT)))
    assert F[1:3, 1:3] == pytest.approx(F[3:, 3:])


def test_turbulence_near_the_ground_is_flat():
    """At 20 ft: σ_u = 1.929 σ_w and L_u = 143.6 ft, worked out by hand from the standard."""
    sigmas, lengths = scales(20.0 * FOOT, 10.0)
    assert sigmas == pytest.approx([1.929, 1.929, 1.0], rel=1e-4)
    assert np.array(lengths) / FOOT == pytest.approx([143.59, 143.59, 20.0], rel=1e-4)
    _, _, C = linear(dryden(10.0, 20.0 * FOOT, 3.0, X, 1e-3))
    assert np.sqrt(np.diag(C @ C.T)) == pytest.approx(sigmas)


def test_heights_out_of_the_standards_range_are_held_within():
    assert dryden(8.0, 0.1, 4.0, X, 1e-3) == dryden(8.0, 10.0 * FOOT, 4.0, X, 1e-3)
    assert dryden(8.0, 900.0, 4.0, X, 1e-3) == dryden(8.0, 1000.0 * FOOT, 4.0, X, 1e-3)
    assert dryden(8.0, 9.9 * FOOT, 4.0, X, 1e-3) != dryden(8.0, 10.1 * FOOT, 4.0, X, 1e-3)


@given(st.floats(-np.pi, np.pi), st.floats(0.1, 20.0), numbers(5.0))
def test_components_lie_along_the_mean_wind_across_it_and_up(yaw, speed, rise):
    d = dryden(8.0, 6.0, 4.0, (speed * np.cos(yaw), speed * np.sin(yaw), rise), 1e-3)
    axes = np.transpose([d.along, d.across, d.up])
    R = axes / np.linalg.norm(axes, axis=0)
    assert Rotation.from_euler("z", yaw).as_matrix() == pytest.approx(R, abs=1e-12)


def test_without_a_horizontal_mean_wind_the_eddies_pass_along_x():
    assert dryden(8.0, 6.0, 4.0, (0.0, 0.0, 0.0), 1e-3) == dryden(8.0, 6.0, 4.0, X, 1e-3)


class Blowing(NamedTuple):
    """A wind, and the key of its turbulence."""

    wind: WindModel
    key0: Any
    key1: Any


class Step(NamedTuple):
    number: Any


def blown(fixed: Blowing, eddies: TurbulenceState, given: Step) -> Any:
    x, y = normals(given.number, 0, fixed.key0, fixed.key1), normals(given.number, 1, fixed.key0, fixed.key1)
    return wind_step(fixed.wind, eddies, ZERO, WindNoise(x.first, x.second, x.third, x.fourth, y.first))


@pytest.fixture(scope="module")
def flown() -> tuple[np.ndarray, float, float]:
    """Seven hours of compiled turbulence (3 × samples), its step [s] and airspeed [m/s]."""
    step, V, count = 0.05, 10.0, 2**19
    wind = WindModel(ZERO, dryden(8.0, 6.0, V, X, step), NO_DRAG)
    fixed, (x, y) = Blowing(wind, *key_from_seed(1)), (normals(0, draw, *key_from_seed(1)) for draw in (2, 3))
    loop = Loop(blown, fixed, NO_EDDIES, Step(0.0))
    return loop(fixed, TurbulenceState(*x, y.first), np.arange(count)[:, None]).T, step, V


@pytest.mark.parametrize("axis", range(3), ids="uvw")
def test_the_spectrum_of_a_long_flight_is_that_of_the_standard(flown, axis):
    """By Welch's method, in twelve bands from 20 mHz to a twentieth of the sampling rate, each within 15 %."""
    out, step, V = flown
    f, found = welch(out[axis], 1.0 / step, nperseg=2**12)
    sigmas, lengths = scales(6.0, 8.0)
    wanted = sigmas[axis] ** 2 * PHI[axis](2.0 * np.pi * f / V, lengths[axis]) * 2.0 * np.pi / V
    edges = np.geomspace(0.02, 0.05 / step, 13)
    for low, high in pairwise(edges):
        band = (f >= low) & (f < high)
        assert np.mean(found[band] / wanted[band]) == pytest.approx(1.0, abs=0.15)


def test_wind_without_turbulence_is_steady():
    gust = Vec3(1.0, 2.0, 3.0)
    assert wind_step(STEADY, Absent(), gust, Absent()) == (Vec3(5.0, 0.0, 3.5), Absent())
    assert start_turbulence(Absent(), [0.0] * 5) == Absent()


def test_noise_moves_the_turbulence_of_the_next_step_and_not_that_of_now():
    wind = WindModel(Vec3(4.0, 0.0, 0.0), dryden(8.0, 6.0, 4.0, X, 1e-3), NO_DRAG)
    whiffs = WindNoise(1.0, -1.0, 1.0, -1.0, 1.0)
    air, eddies = wind_step(wind, NO_EDDIES, ZERO, whiffs)
    assert air == Vec3(4.0, 0.0, 0.0)
    assert wind_step(wind, eddies, ZERO, whiffs)[0] != air


durations = st.floats(0.05, 5.0)


@given(numbers(10.0), numbers(5.0), durations, st.floats(0.0, 5.0))
def test_a_gust_carries_its_peak_over_its_rise_and_its_hold(V, start, rise, hold):
    g = Gust(Vec3(V, -V, 2.0 * V), start, 1.0 / rise, hold)
    corners = [start, start + rise, start + rise + hold, start + 2.0 * rise + hold]
    whole = sum(quad(lambda t: gust_velocity(g, t).x, a, b)[0] for a, b in pairwise(corners))
    assert whole == pytest.approx(V * (rise + hold), abs=1e-9)
    assert gust_velocity(g, start + rise + 0.5 * hold) == pytest.approx((V, -V, 2.0 * V), abs=1e-9)
    assert gust_velocity(g, start + 0.5 * rise).x == pytest.approx(V / 2.0, abs=1e-9)
    assert gust_velocity(g, start + rise / 3.0).x == pytest.approx(V / 4.0, abs=1e-9)


@given(durations, st.floats(0.0, 5.0), st.floats(0.0, 1.0))
def test_a_gust_falls_as_it_rose_and_is_exactly_zero_before_and_after(rise, hold, part):
    g = Gust(Vec3(3.0, 0.0, 0.0), 2.0, 1.0 / rise, hold)
    mirrored = gust_velocity(g, 2.0 + 2.0 * rise + hold - part * rise)
    assert gust_velocity(g, 2.0 + part * rise) == pytest.approx(mirrored, abs=1e-9)
    assert gust_velocity(g, 2.0 - part) == ZERO
    assert gust_velocity(g, (2.0 + 2.0 * rise + hold) * (1.0 + 1e-12) + part) == ZERO


@pytest.mark.parametrize("hold", [1e12, np.inf])
def test_a_gust_that_holds_for_ever_is_a_change_of_the_wind(hold):
    g = Gust(Vec3(3.0, 1.0, 0.0), 2.0, 1.0, hold)
    assert gust_velocity(g, 3.0) == gust_velocity(g, 1e6) == g.velocity
