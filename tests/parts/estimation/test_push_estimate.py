"""The push from the sensors, against Newton and Euler of payload and quadrotors as one linear system."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from law_values import array, random_attitude, seeds
from newton_euler import Flight, Given, Parts, flown, paper_parts, random_parts, solved, unit, vehicle_of
from perceived import STEP, happening, onboard, perceived, rows, sensors
from scipy import stats
from scipy.spatial.transform import Rotation

from tandemlift.core.vector import Absent, Vec3, vec3
from tandemlift.parts.estimation.estimator_table import EstimatorTable
from tandemlift.parts.estimation.push_estimate import (
    PushEstimator,
    estimate,
    external_forces,
    inertial_force,
    less_mean,
    moment_on_payload,
    point_of_application,
    push_estimator,
    start_push,
)
from tandemlift.parts.sensors.noise_bias_drift import SensorGrade

NOISE = {
    "force": SensorGrade(noise=0.05),
    "torque": SensorGrade(noise=0.01),
    "accelerometer": SensorGrade(noise=0.03),
    "gyroscope": SensorGrade(noise=0.001),
}


def estimator(p: Parts, length: float | None = None, **keys: Any) -> PushEstimator:
    """The estimator that knows the parts as they are."""
    return push_estimator(EstimatorTable(**keys), vehicle_of(p, length), STEP)


def moment(rng: np.random.Generator, N: int) -> tuple[Rotation, np.ndarray, Given]:
    """Any attitude, rates and loads."""
    R = Rotation.from_quat(array(random_attitude(rng)), scalar_first=True)
    loads = Given(
        rng.uniform(5.0, 25.0, N), rng.standard_normal((N, 3)), 3.0 * rng.standard_normal(3), rng.standard_normal(3),
        np.zeros((N, 3)),
    )  # fmt: skip
    return R, 2.0 * rng.standard_normal(3), loads


@given(seeds, st.integers(1, 4))
def test_force_and_moment_of_the_push_are_what_newton_and_euler_leave(seed, N):
    rng = np.random.default_rng(seed)
    p = random_parts(rng, N)
    R, w, x = moment(rng, N)
    answer = solved(p, R, w, x)
    k, said = estimator(p), unit(R, w, answer)
    push, _ = estimate(k, start_push(k, said), said, 0.0)
    assert array(push.measured) == pytest.approx(x.push, abs=1e-11)
    found = moment_on_payload(k, said, vec3(answer.angular))
    assert array(found) == pytest.approx(np.cross(x.at, R.inv().apply(x.push)), abs=1e-11)


@given(seeds, st.floats(-0.95, 0.95))
def test_a_push_on_the_beam_is_found_where_it_acts(seed, y):
    rng = np.random.default_rng(seed)
    p = paper_parts()
    R, w, x = moment(rng, 2)
    x = x._replace(at=np.array([0.0, y, 0.0]))
    answer = solved(p, R, w, x)
    k, said = estimator(p, length=2.0, min_force=0.01), unit(R, w, answer)
    push = R.inv().apply(x.push)
    assume(np.hypot(push[0], push[2]) > 0.01)  # N: of a smaller one no place is given
    about = moment_on_payload(k, said, vec3(answer.angular))
    at = point_of_application(k.off_center, k.reach, k.least, vec3(push), about)
    assert at == pytest.approx(y, abs=1e-9 / np.hypot(push[0], push[2]) ** 2)


def test_a_point_is_held_on_the_beam_and_not_given_for_small_forces():
    def at(force: Vec3, moment: Vec3) -> Any:
        return point_of_application(Absent(), 1.0, 0.25, force, moment)

    assert at(Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, -7.0)) == 1.0
    assert at(Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 7.0)) == -1.0
    assert at(Vec3(0.3, 5.0, -0.39), Vec3(0.2, 0.0, 0.3)) == 0.0
    assert at(Vec3(0.3, 0.0, -0.41), Vec3(-0.41 * 0.7, 0.0, -0.3 * 0.7)) == pytest.approx(0.7)


@given(seeds, st.integers(2, 4))
def test_wind_and_wrong_sensors_show_as_what_differs_between_quadrotors(seed, N):
    rng = np.random.default_rng(seed)
    p = random_parts(rng, N)
    R, w, x = moment(rng, N)
    x = x._replace(winds=rng.standard_normal((N, 3)))
    answer, wrong = solved(p, R, w, x), rng.standard_normal((N, 3))
    said = unit(R, w, answer._replace(force=answer.force + wrong))
    found = np.array(less_mean(estimator(p), external_forces(estimator(p), said, vec3(answer.angular)))).T
    outside = (R.inv().apply(x.winds) + wrong)[:, :2]
    assert found == pytest.approx(outside - outside.mean(axis=0), abs=1e-11)


def settled(k: PushEstimator, said: Any, angular: Any) -> Any:
    """The push after a second of the same sample, with the angular acceleration known."""
    memory = start_push(k, said)._replace(angular=vec3(angular))
    for _ in range(1000):
        push, memory = estimate(k, memory, said._replace(fresh=0.0), 10.0)
    return push


@pytest.mark.parametrize("N", [2, 5])
def test_the_disagreement_is_the_error_of_the_one_sensor_that_is_wrong(N):
    rng = np.random.default_rng(N)
    p = random_parts(rng, N)
    R, w, x = moment(rng, N)
    answer = solved(p, R, w, x)
    answer.force[1] += [0.6, -0.8, 5.0]
    said = unit(R, w, answer)
    push = settled(estimator(p, disagreement_limit=0.99), said, answer.angular)
    assert push.disagreement == pytest.approx(1.0, abs=1e-9)
    assert (push.trusted, push.usable) == (0.0, (0.0, 0.0, 0.0))
    assert array(push.force) == pytest.approx(x.push - R.apply([0.6, -0.8, 5.0]), abs=1e-9)  # said all the same
    assert settled(estimator(p, disagreement_limit=1.01), said, answer.angular).trusted == 1.0


def test_one_quadrotor_has_nobody_to_disagree_with():
    p = random_parts(np.random.default_rng(0), 1)
    answer = solved(p, Rotation.identity(), np.zeros(3), moment(np.random.default_rng(1), 1)[2])
    answer.force[0] += [3.0, 0.0, 0.0]
    assert settled(estimator(p), unit(Rotation.identity(), np.zeros(3), answer), answer.angular).trusted == 1.0


def nothing(t: float) -> np.ndarray:
    return np.zeros(3)


def hover(extra: float = 0.0, steps: int = 4000) -> Flight:
    """At rest in the air, the payload heavier by `extra` [kg]."""
    still = flown(paper_parts(extra), STEP, STEP, nothing, (0.0, 0.0, 0.0))
    return Flight(np.tile(still.truth, (steps, 1)), still.attitudes, np.zeros((steps, 3)))


def seen(flight: Flight, k: PushEstimator, seed: int = 0, **grades: Any) -> Any:
    """What the push is estimated to be over a flight, with sensors of these grades."""
    return perceived(onboard(happening(flight.truth[0]), sensors(2, STEP, **grades), k), flight.truth, seed)


def test_noise_on_the_measured_push_is_that_of_the_sensors():
    """Var = N σ_f² + (m_L σ_a)² on each axis."""
    push = seen(hover(steps=30000), estimator(paper_parts()), **NOISE).push
    off = rows(push.measured)
    variance = 2 * 0.05**2 + (0.5 * 0.03) ** 2
    low, high = stats.chi2.ppf([1e-4, 1.0 - 1e-4], len(off))
    for axis in range(3):
        assert low < np.sum(off[:, axis] ** 2) / variance < high
    assert rows(push.force)[1000:].std(axis=0) == pytest.approx(np.sqrt(variance * 36.0 * STEP / 4.0), rel=0.1)


def test_the_point_stays_right_while_force_and_vehicle_turn():
    """Without noise the force that is low-passed in body axes has its moment at the same point, whatever happens."""

    def stirring(t: float) -> np.ndarray:
        return np.array([2.0 * np.cos(9.0 * t), 1.0, 2.0 * np.sin(9.0 * t)])

    p = paper_parts()
    flight = flown(p, 1.5, STEP, stirring, (0.0, -0.8, 0.0), sway=0.2)
    push = seen(flight, estimator(p, length=2.0)).push
    assert np.ptp(rows(push.moment)[500:], axis=0).max() > 0.5
    assert np.abs(push.point[500:] + 0.8).max() < 0.005  # the difference of rates is half a sample late


BIASED = {
    "force": SensorGrade(noise=0.05, bias=[[0.3, -0.2, 0.4], [-0.1, 0.25, -0.3]]),
    "torque": SensorGrade(noise=0.01, bias=[[0.05, 0.02, -0.04], [0.1, -0.03, 0.02]]),
    "accelerometer": SensorGrade(noise=0.03, bias=(0.05, -0.04, 0.03)),
    "gyroscope": SensorGrade(noise=0.001, bias=(0.01, 0.0, -0.01)),
}


def test_the_tare_takes_out_the_bias_of_all_sensors():
    flight, p = hover(), paper_parts()
    raw = seen(flight, estimator(p), **BIASED).push
    push = seen(flight, estimator(p, tare_start=1.0, tare_duration=1.0), **BIASED).push
    before, after = slice(0, 2000), slice(2200, None)
    assert np.all(push.armed[before] == 0.0)
    assert np.all(push.armed[2000:] == 1.0)
    assert np.all(rows(push.usable)[before] == 0.0)
    assert np.all(rows(push.force)[before] == 0.0)
    assert rows(push.measured)[before] == pytest.approx(rows(raw.measured)[before], abs=1e-12)
    assert np.abs(rows(raw.measured).mean(axis=0)).max() > 0.1
    assert np.abs(rows(push.measured)[after].mean(axis=0)).max() < 4.0 * 0.0724 / np.sqrt(1000.0)
    assert np.abs(rows(push.force)[after]).max() < 0.04
    assert np.abs(rows(push.moment)[after]).max() < 0.06
    assert push.disagreement[after].max() < 0.1 < raw.disagreement[after].min()


def test_a_weighed_payload_is_not_felt_as_a_push_when_it_is_heaved():
    """The tare alone would feel the unknown mass in every acceleration."""
    heaved = flown(paper_parts(0.3), 1.5, STEP, lambda t: np.array([0.0, 0.0, 6.0 * np.sin(4.0 * t)]), (0.0, 0.0, 0.0))
    still = hover(0.3, 1000)
    flight = Flight(np.vstack([still.truth, heaved.truth]), heaved.attitudes, np.vstack([still.pushes, heaved.pushes]))
    worst = {}
    for identify in (True, False):
        k = estimator(paper_parts(), tare_start=0.0, tare_duration=1.0, identify_mass=identify)
        worst[identify] = np.abs(rows(seen(flight, k).push.measured)[1000:] - heaved.pushes).max()
    assert worst[True] < 1e-3
    assert worst[False] > 0.3


@given(seeds, st.floats(0.0, 2.0))
def test_a_mass_beyond_the_nominal_at_the_system_s_centre_turns_without_looking_like_a_push(seed, extra):
    rng = np.random.default_rng(seed)
    p = random_parts(rng, 2)
    R, w, x = moment(rng, 2)
    mass = p.mass + extra
    shift = extra / mass * p.centre  # of the payload's centre of mass, with the extra mass in it
    arms = p.mass * (shift @ shift * np.eye(3) - np.outer(shift, shift))
    rest = p.centre - shift
    arms += extra * (rest @ rest * np.eye(3) - np.outer(rest, rest))
    real = p._replace(mass=mass, inertia=p.inertia + arms, joints=p.joints - shift, quadrotors=p.quadrotors - shift)
    answer = solved(real, R, w, x._replace(at=x.at - shift))
    k, said = estimator(p), unit(R, w, answer)
    at_nominal = array(said.specific_force) - np.cross(answer.angular, shift) - np.cross(w, np.cross(w, shift))
    force = inertial_force(k, vec3(at_nominal), vec3(w), vec3(answer.angular), mass)
    assert array(force) - answer.force.sum(axis=0) == pytest.approx(R.inv().apply(x.push), abs=1e-9)


def test_a_tare_that_is_begun_anew_forgets_the_one_before_and_one_without_a_sample_is_none():
    """Told another window in flight, the estimator comes to what one comes to that has seen that window alone."""
    rng, p = np.random.default_rng(3), paper_parts()
    windows = [estimator(p, tare_start=at, tare_duration=0.02, identify_mass=True) for at in (0.01, 0.05)]
    said = []
    for _ in range(90):
        R, w, x = moment(rng, 2)
        said.append(unit(R, w, solved(p, R, w, x)))
    twice = once = never = start_push(windows[0], said[0])
    for k, now in enumerate(said):
        first, twice = estimate(windows[k >= 40], twice, now, k * STEP)
        second, once = estimate(windows[1], once, now, k * STEP)
        untared, never = estimate(windows[1], never, now, k * STEP, 0.0)  # a floor may carry it all the time
        if k == 39:
            assert first.armed == 1.0
            assert first.payload_mass != pytest.approx(second.payload_mass)
    assert twice.sums == once.sums
    assert twice.sums.count == 20.0
    assert (first.measured, first.payload_mass, first.armed) == (second.measured, second.payload_mass, 1.0)
    assert (never.sums.count, untared.armed) == (0.0, 0.0)
