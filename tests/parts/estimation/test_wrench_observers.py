"""Observers of the external wrench: against closed forms, SciPy's bodies and Riccati solvers, and filterpy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_are, solve_discrete_are
from scipy.signal import TransferFunction, step
from scipy.spatial.transform import Rotation

from tandemlift.core.low_pass import LowPassState
from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.parts.estimation.wrench.delay import delay_of, delayed
from tandemlift.parts.estimation.wrench.kalman import natural_frequency, steady_gain, turning_gains
from tandemlift.parts.estimation.wrench.observation import NominalBody, Observation, observe
from tandemlift.parts.estimation.wrench.start_observer import OBSERVERS, SampleNoise
from tandemlift.parts.estimation.wrench.wrench_table import WrenchTable
from tandemlift.parts.mechanics.rigid_body import State, Wrench

MASS, INERTIA, GRAVITY, H = 3.5, (3.2, 0.06, 3.3), 9.81, 1e-3
BODY = NominalBody(MASS, Vec3(*INERTIA), Vec3(*[1.0 / j for j in INERTIA]))
NOISE = SampleNoise(0.03, 0.0025, 0.003, 0.01, 0.002)
FORCE, MOMENT = (5.0, 15.0, 25.0), (4.0, 20.0, 6.0)  # rad/s
TABLE = WrenchTable(force_bandwidth=FORCE, moment_bandwidth=MOMENT)
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
ALL = ("momentum", "hybrid", "disturbance-observer", "kalman", "extended-kalman", "unscented")


def started(name):
    return OBSERVERS[name].start(TABLE, BODY, NOISE, H)


def seen(state, specific_force, rotors, motion=None, fresh=1.0):
    m = motion or state
    return Observation(specific_force, state, rotors, m.position, m.velocity, m.attitude, fresh, H)


def found(name, observations):
    """The forces and moments (n, 6) of an observer at observations."""
    k, memory = started(name)
    rows = []
    for x in observations:
        wrench, memory = observe(k, memory, x)
        rows.append([*wrench.force, *wrench.moment])
    return np.array(rows)


def level_flight(force, moment, steps):
    """A level vehicle under a constant force and a moment about one axis, at rest at the start."""
    carried = Wrench(MASS * GRAVITY, ZERO)
    for k in range(steps):
        t = k * H
        state = State(force * (0.5 * t * t / MASS), force * (t / MASS), LEVEL, moment * BODY.inverse_inertia * t)
        yield seen(state, force * (1.0 / MASS) + Vec3(0.0, 0.0, GRAVITY), carried)


@pytest.mark.parametrize("name", ["momentum", "disturbance-observer"])
def test_a_constant_wrench_is_found_exponentially(name):
    force, moment = Vec3(1.0, -2.0, 0.5), Vec3(0.0, 0.2, 0.0)
    left = 1.0 - found(name, level_flight(force, moment, 300))[:, [0, 1, 2, 4]] / [1.0, -2.0, 0.5, 0.2]
    t = H * np.arange(300)[:, None]
    assert left == pytest.approx(np.exp(-np.array([*FORCE, MOMENT[1]]) * t), abs=1e-12)


def test_the_hybrid_observer_finds_a_constant_force_exponentially_from_the_first_sample():
    force = Vec3(1.0, -2.0, 0.5)
    left = 1.0 - found("hybrid", level_flight(force, ZERO, 300))[:, :3] / [1.0, -2.0, 0.5]
    assert left == pytest.approx(np.exp(-np.array(FORCE) * H * np.arange(1, 301)[:, None]), abs=1e-12)


def random_observations(rng, steps):
    """Any states, forces and thrusts, which need not belong together."""
    for _ in range(steps):
        q = rng.normal(size=4)
        vectors = [vec3(rng.normal(size=3)) for _ in range(5)]
        state = State(vectors[0], vectors[1], Quat(*(q / np.linalg.norm(q))), vectors[2])
        yield seen(state, vectors[3], Wrench(rng.uniform(0.0, 60.0), vectors[4]))


def test_the_nonlinear_observer_of_mohammadi_is_the_momentum_observer_in_these_axes():
    """ψ̇ = L (N − u − p − ψ) solved over each sample, with p by the step's exact gain; ŵ = ψ + p."""
    observations = list(random_observations(np.random.default_rng(3), 200))
    J, c = np.array(INERTIA), np.array(FORCE + MOMENT)
    psi, wrenches = None, []
    for x in observations:
        up = Rotation.from_quat(x.state.attitude, scalar_first=True).apply([0.0, 0.0, 1.0])
        w, M = np.array(x.state.rates), np.array(x.rotors.moment)
        known = np.array([*(up * x.rotors.thrust - [0.0, 0.0, MASS * GRAVITY]), *(M - np.cross(w, J * w))])
        p = np.array([*(MASS * np.array(x.state.velocity)), *(J * w)]) * (1.0 - np.exp(-c * H)) / H
        psi = -p if psi is None else psi
        wrenches.append(psi + p)
        psi = -known - p + (psi + known + p) * np.exp(-c * H)
    assert found("disturbance-observer", observations) == pytest.approx(np.array(wrenches), abs=1e-9)
    assert np.abs(wrenches).max() > 1.0


@pytest.mark.parametrize("name", ["momentum", "hybrid", "disturbance-observer"])
def test_a_found_wrench_stays_as_it_is_when_the_bandwidth_changes_in_flight(name):
    force, moment = Vec3(1.0, -2.0, 0.5), Vec3(0.0, 0.2, 0.0)
    k, memory = started(name)
    for i, x in enumerate(level_flight(force, moment, 4000)):
        if i == 3500:
            k, _ = OBSERVERS[name].start(WrenchTable(moment_bandwidth=(8.0, 8.0, 8.0)), BODY, NOISE, H)
        wrench, memory = observe(k, memory, x)
        if i >= 3500:
            assert (*wrench.force, *wrench.moment) == pytest.approx((*force, *moment), abs=1e-5)


FORCE_ON, MOMENT_ON, THRUST, ROTORS = (0.6, -0.4, 0.8), (0.15, 0.02, -0.1), 33.0, (0.3, 0.01, -0.2)


@pytest.fixture(scope="module")
def tumbling():
    """A body by SciPy: constant force in world axes and moment in body axes, thrust and moment of the rotors."""
    J, u = np.array(INERTIA), np.array(ROTORS) + MOMENT_ON

    def rate(t, y):
        v, q, w = y[3:6], y[6:10], y[10:]
        up = Rotation.from_quat(q, scalar_first=True).apply([0.0, 0.0, 1.0])
        a = (up * THRUST + FORCE_ON) / MASS - [0.0, 0.0, GRAVITY]
        turn = 0.5 * np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))])
        return [*v, *a, *turn, *((u - np.cross(w, J * w)) / J)]

    times = H * np.arange(2001)
    start = [0.0, 0.0, 0.0, 0.1, 0.2, 0.0, 1.0, 0.0, 0.0, 0.0, 0.1, -0.2, 0.3]
    rows = solve_ivp(rate, (0.0, times[-1]), start, t_eval=times, rtol=1e-9, atol=1e-9).y.T
    observations = []
    for row in rows:
        state = State(vec3(row[:3]), vec3(row[3:6]), Quat(*row[6:10]), vec3(row[10:]))
        R = Rotation.from_quat(row[6:10], scalar_first=True)
        specific = np.add(R.inv().apply(FORCE_ON), [0.0, 0.0, THRUST]) / MASS
        observations.append(seen(state, vec3(specific), Wrench(THRUST, vec3(ROTORS))))
    return observations


@pytest.mark.parametrize("name", ALL)
def test_the_wrench_on_a_tumbling_body_is_found(name, tumbling):
    """The observers' steps take thrust and gyroscopic moment as constant over a sample; the rest of 5 mN is of that."""
    last = found(name, tumbling)[-1]
    assert last[:3] == pytest.approx(FORCE_ON, abs=0.03)
    assert last[3:] == pytest.approx(MOMENT_ON, abs=0.03)


@pytest.mark.parametrize("name", ["extended-kalman", "unscented"])
def test_either_sign_of_a_measured_quaternion_is_the_same_attitude(name, tumbling):
    flipped = [x._replace(attitude=x.attitude * (-1.0) ** (i // 10)) for i, x in enumerate(tumbling[:40])]
    assert (found(name, flipped) == found(name, tumbling[:40])).all()


def test_the_gain_of_the_force_is_that_of_the_riccati_equation():
    q, sigma, T = 0.1, 0.105, 0.002
    prior = solve_discrete_are(np.eye(1), np.eye(1), [[q * q * T]], [[sigma * sigma]])[0, 0]
    assert steady_gain(q, sigma, T) == pytest.approx(prior / (prior + sigma * sigma), rel=1e-9)


def test_poles_and_covariance_of_the_moment_are_those_of_the_kalman_bucy_filter():
    q, noise, T = 0.1, 0.008, 1e-3  # N·m/√s, kg·m²/s
    A, C, r = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[1.0, 0.0]]), noise * noise * T
    P = solve_continuous_are(A.T, C.T, np.diag([0.0, q * q]), np.array([[r]]))
    assert P[1, 1] == pytest.approx(math.sqrt(2.0) * q**1.5 * (noise * math.sqrt(T)) ** 0.5, rel=1e-6)
    frequency = natural_frequency(q, noise, T)
    wanted = np.linalg.eigvals(A - P @ C.T @ C / r)
    rates, turning = turning_gains(frequency, T)
    transition = (np.eye(2) - np.array([[rates], [turning]]) @ C) @ np.array([[1.0, T], [0.0, 1.0]])
    assert np.sort_complex(np.log(np.linalg.eigvals(transition)) / T) == pytest.approx(
        np.sort_complex(wanted), rel=1e-6
    )


@pytest.mark.parametrize("name", ["extended-kalman", "unscented"])
def test_a_filter_of_one_axis_is_that_of_filterpy_for_samples_at_random_times(name):
    """One axis each of translation and rotation, level: position and angle measured at random samples."""
    kalman = pytest.importorskip("filterpy.kalman")
    rng, sizes = np.random.default_rng(5), np.array([MASS, INERTIA[0]])
    changes = np.array([TABLE.force_change[0], TABLE.moment_change[0]])
    value_noise, rate_noise = np.array([0.003, 0.002]), np.array([0.01, 0.0025])
    filters = []
    for size, change, value, rate in zip(sizes, changes, value_noise, rate_noise, strict=True):
        f = kalman.KalmanFilter(dim_x=3, dim_z=1)
        f.x, f.P = np.zeros((3, 1)), np.diag([value**2, rate**2, 1.0])
        f.F = np.array([[1.0, H, 0.5 * H * H], [0.0, 1.0, H], [0.0, 0.0, 1.0]])
        f.Q = np.diag([0.0, 0.0, (change / size) ** 2 * H])
        filters.append(f)
    carried, k, memory = Wrench(MASS * GRAVITY, ZERO), *started(name)
    for i in range(400):
        t, fresh = i * H, float(i == 0 or rng.random() < 0.3)
        value = 0.5 * np.array([0.3, 0.1]) * t * t + value_noise * rng.normal(size=2) * (i > 0)
        rate = np.array([0.3, 0.1]) * t + rate_noise * rng.normal(size=2) * (i > 0)
        half = 0.5 * value[1]
        motion = State(
            Vec3(value[0], 0.0, 0.0), Vec3(rate[0], 0.0, 0.0), Quat(math.cos(half), math.sin(half), 0, 0), ZERO
        )
        state = State(ZERO, ZERO, LEVEL, Vec3(rate[1], 0.0, 0.0))
        wrench, memory = observe(k, memory, seen(state, ZERO, carried, motion, fresh))
        for j, f in enumerate(filters):
            updates = [([[1.0, 0.0, 0.0]], value[j], value_noise[j]), ([[0.0, 1.0, 0.0]], rate[j], rate_noise[j])]
            for n, (H_row, z, sigma) in enumerate(updates):
                if fresh or (j == 1 and n == 1):  # the gyroscope is read at every sample
                    f.update(z, R=sigma**2, H=np.array(H_row))
        wanted = [f.x[2, 0] * size for f, size in zip(filters, sizes, strict=True)]
        assert [wrench.force.x, wrench.moment.x] == pytest.approx(wanted, abs=1e-5)
        for f in filters:
            f.predict()
    assert filters[0].x[2, 0] * MASS == pytest.approx(0.3 * MASS, abs=0.5)


@pytest.mark.thorough
def test_the_unscented_filter_is_that_of_filterpy_with_rotations_by_scipy(tumbling):
    """Attitude and rates of the tumbling body with noise, the attitude at random samples."""
    kalman = pytest.importorskip("filterpy.kalman")
    J, M, rng = np.array(INERTIA), np.array(ROTORS), np.random.default_rng(7)
    points = kalman.JulierSigmaPoints(9, kappa=1.0)
    f = kalman.UnscentedKalmanFilter(9, 6, H, hx=None, fx=None, points=points)
    f.Q = np.diag([0.0] * 6 + list((np.array(TABLE.moment_change) / J) ** 2 * H))
    noise = np.diag([NOISE.attitude**2] * 3 + [NOISE.gyroscope**2] * 3)
    f.P, q = np.diag([*np.diag(noise), 1.0, 1.0, 1.0]), None

    def turned(x):
        """(the rotation in a step, the rates after it)."""
        angular = (M - np.cross(x[3:6], J * x[3:6])) / J + x[6:]
        return Rotation.from_mrp((x[3:6] * H + angular * 0.5 * H * H) / 4.0), x[3:6] + angular * H

    k, memory = started("unscented")
    for i, x in enumerate(tumbling[:300]):
        fresh = i == 0 or rng.random() < 0.3
        true = Rotation.from_quat(x.state.attitude, scalar_first=True)
        seen_at = true * Rotation.from_rotvec(rng.normal(size=3) * NOISE.attitude * (i > 0))
        rates = np.array(x.state.rates) + rng.normal(size=3) * NOISE.gyroscope * (i > 0)
        motion = x.state._replace(attitude=Quat(*seen_at.as_quat(scalar_first=True)))
        state = (motion if i == 0 else x.state)._replace(rates=vec3(rates))
        wrench, memory = observe(k, memory, seen(state, x.specific_force, x.rotors, motion, float(fresh)))
        if q is None:
            q, f.x = seen_at, np.array([0.0, 0.0, 0.0, *rates, 0.0, 0.0, 0.0])
        f.sigmas_f = points.sigma_points(f.x, f.P)
        start = 0 if fresh else 3
        z = np.array([*(4.0 * (q.inv() * seen_at).as_mrp()), *rates])[start:]
        f.update(z, R=noise[start:, start:], hx=lambda x, start=start: x[start:6])
        assert wrench.moment == pytest.approx(tuple(J * f.x[6:]), abs=1e-5)
        q, f.x[:3] = q * Rotation.from_mrp(f.x[:3] / 4.0), 0.0
        ahead = q * turned(f.x)[0]

        def moved(x, dt, q=q, ahead=ahead):
            turn, after = turned(x)
            return np.array(
                [*(4.0 * (ahead.inv() * q * Rotation.from_mrp(x[:3] / 4.0) * turn).as_mrp()), *after, *x[6:]]
            )

        f.predict(fx=moved)
        q, f.x[:3] = ahead * Rotation.from_mrp(f.x[:3] / 4.0), 0.0
    assert np.abs(np.array(wrench.moment) - MOMENT_ON).max() < 0.1


def test_the_delay_of_the_thrusts_is_an_all_pass_of_that_delay():
    """Against a delayed sine, in steps, by amplitude and phase; and SciPy's response of the Padé approximant."""
    T = 0.0105
    k, frequency, memory, found = delay_of(T, H), 60.0, LowPassState(0.0, 0.0), []
    for i in range(3000):
        y, memory = delayed(k, memory, math.sin(frequency * (i + 0.5) * H))
        found.append(y)
    t = H * np.arange(1, 3001)
    fit = np.linalg.lstsq(np.stack([np.sin(frequency * t), np.cos(frequency * t)], 1)[1000:], found[1000:])[0]
    assert np.hypot(*fit) == pytest.approx(1.0, abs=0.02)
    assert -math.atan2(fit[1], fit[0]) / frequency == pytest.approx(T, abs=5e-4)
    memory, rising = LowPassState(0.0, 0.0), []
    for _ in range(60):
        y, memory = delayed(k, memory, 1.0)
        rising.append(y)
    pade = TransferFunction([T * T / 12.0, -T / 2.0, 1.0], [T * T / 12.0, T / 2.0, 1.0])
    assert rising == pytest.approx(step(pade, T=H * np.arange(61))[1][1:], abs=1e-9)


def test_a_constant_thrust_stays_as_it_is_when_the_believed_delay_changes():
    memory = LowPassState(0.0, 0.0)
    for T in (0.01, 0.02, 0.005):
        k, found = delay_of(T, H), []
        for _ in range(200):
            y, memory = delayed(k, memory, 34.0)
            found.append(y)
        assert found[-1] == pytest.approx(34.0, abs=1e-9)
        assert T == 0.01 or found == pytest.approx([34.0] * 200, abs=1e-6)
