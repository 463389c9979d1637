"""Judgement of an identification: white noise, random walks, windows that are left out, intervals."""

import math
from functools import partial
from types import SimpleNamespace

import flight_windows
import numpy as np
import pytest
from flight_windows import cut, iris
from scipy import stats

from tandemlift.analysis.identification.equations import Linearisation
from tandemlift.analysis.identification.fit import CHANCE, UNEXPLAINED, VehicleSearch
from tandemlift.analysis.identification.identification import NORMAL, Identification, Row, rows_of
from tandemlift.analysis.identification.identify import _with_derivatives
from tandemlift.analysis.identification.judgement import covariance_of, misfit_by_window, whiteness
from tandemlift.analysis.identification.prediction import (
    STARTS,
    PredictedDerivatives,
)
from tandemlift.analysis.identification.sensor_errors import SensorPriors
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION
from tandemlift.missions import load_mission

RNG = np.random.default_rng(11)
sampled = partial(flight_windows.sampled, rng=RNG)


# judgement


def test_white_residuals_are_white_and_correlated_ones_count_by_the_factor_of_their_process():
    """AR(1): the variance of a mean grows by (1 + φ)/(1 − φ)."""
    white = whiteness(RNG.normal(size=(40, 100, 3)))
    assert white.white
    assert white.factor == pytest.approx(1.0, abs=0.15)
    assert white.bound == pytest.approx(stats.norm.ppf(0.995) / math.sqrt(40 * 100 * 3) + 3.0 / 100, rel=1e-2)
    r = RNG.normal(size=(60, 600, 3))
    for k in range(1, r.shape[1]):
        r[:, k] += 0.6 * r[:, k - 1]
    found = whiteness(r)
    assert not found.white
    assert found.autocorrelation[:3] == pytest.approx([0.6, 0.36, 0.216], abs=0.02)
    assert found.factor == pytest.approx(4.0, rel=0.08)
    r[::2, ::3] = np.nan  # without some samples it is as correlated
    assert whiteness(r).autocorrelation[2] == pytest.approx(0.216, abs=0.03)


def test_a_second_lag_that_swings_back_ends_the_count_only_where_it_outweighs_the_first():
    """MA(2) with ρ₁ = 0.37 and ρ₂ = −0.11: a mean's variance grows by 1 + 2 (ρ₁ + ρ₂)."""
    e = RNG.normal(size=(80, 602, 3))
    r = e[:, 2:] + 0.6 * e[:, 1:-1] - 0.15 * e[:, :-2]
    size = 1.0 + 0.6**2 + 0.15**2
    assert whiteness(r).factor == pytest.approx(1.0 + 2.0 * (0.6 - 0.6 * 0.15 - 0.15) / size, abs=0.1)


def test_the_turns_of_joints_act_behind_the_vehicle_and_the_point():
    """Of a load along x, its sensor turned about z by φ shows −φ x along y."""
    base = {JOINTS[0]: np.zeros((2, 4, 6))}
    base[JOINTS[0]][..., 0], base[JOINTS[0]][..., 4] = 3.0, 5.0
    d = PredictedDerivatives(base, {JOINTS[0]: np.zeros((2, STARTS + 2 + 3, 4, 6))})
    priors = SensorPriors({}, {MOTION[0]: 0}, np.array([3e-3]), np.array([3e-5]), 2)
    J = Linearisation._columns(SimpleNamespace(priors=priors), d, JOINTS[0], slice(0, 0), np.zeros((2, 3)))
    assert J.shape == (2, STARTS + 1 + 2 + 3 + 6, 3, 6)
    turns = J[0, STARTS + 1 + 2 + 3 :, 0]
    expected = np.zeros((6, 6))
    expected[2, 1], expected[1, 2] = -3.0, 3.0  # first joint, along x: about z shows along y, about y along z
    expected[3, 5], expected[5, 3] = -5.0, 5.0  # second, along y: about x along z, about z along x
    assert turns == pytest.approx(expected)
    assert not J[:, : STARTS + 1 + 2 + 3].any()


def walking_search(W=4, P=2, blocks=5):
    """A search of two coordinates and a bias that walks, with what its equations say."""
    priors = SensorPriors(
        {IMU[1]: slice(0, 3)}, {MOTION[0]: 3}, np.array([0.5, 0.4, 0.3, 1e-3]), np.array([0.2, 0.1, 0.3, 0.0]), 0
    )
    w = cut(first=100 * np.arange(W), length=10 * blocks)
    C, size = STARTS + 4 + P + 3, P + 3 + 4
    part = SimpleNamespace(windows=w, used=np.array([True, True, False, True]))
    places = np.tile([*range(P + 3, size), *range(P + 3)], (W, 1))
    M = RNG.normal(size=(size, size))
    information = M @ M.T + np.eye(size)
    prior = np.diag(RNG.uniform(0.1, 0.5, size))
    columns, to_start = RNG.normal(size=(W, C, blocks, 3)), RNG.normal(size=(W, STARTS, C - STARTS))
    columns[:, STARTS : STARTS + 3] = np.eye(3)[:, None, :]
    normal = SimpleNamespace(
        information=information, prior=prior, noises={IMU[1]: information - prior}, back=[(None, to_start)]
    )
    search = SimpleNamespace(priors=priors, unknowns=range(P), parts=[part], places=lambda part: places)
    return search, SimpleNamespace(columns={IMU[1]: columns}), normal, places, columns, to_start


@pytest.mark.parametrize("factor", [1.0, 2.5])
def test_the_covariance_is_that_of_a_sandwich_and_of_biases_that_walk(factor):
    """A walk has the covariance bias² + walk² (the earlier of two times): what the estimate hears of it, h K hᵀ."""
    search, own, normal, places, columns, to_start = walking_search()
    P, part, priors = 2, search.parts[0], search.priors
    inverse = np.linalg.inv(normal.information)
    middle = normal.prior.copy()
    middle[5:8] = middle[:, 5:8] = 0.0  # biases walk; a clock does not
    expected = inverse[:P] @ (middle + factor * normal.noises[IMU[1]]) @ inverse[:, :P]
    time = (part.windows.times()[part.used, None] + np.arange(5) * 0.02).ravel()
    for i in range(3):
        h = []
        for k in np.flatnonzero(part.used):
            to = inverse[:P][:, places[k]]
            gain = np.hstack([-to @ to_start[k].T, to])
            h.append(gain @ columns[k, :, :, i])  # a sample of the axis in each block
        h = np.hstack(h)
        K = priors.bias[i] ** 2 + priors.walk[i] ** 2 * (np.minimum.outer(time, time) - time[0])
        expected = expected + h @ K @ h.T
    found = covariance_of(search, [own], normal, {IMU[1]: factor})
    assert found.covariance == pytest.approx(expected)
    assert found.bound == pytest.approx(inverse[:P, :P])


def test_the_misfit_of_a_window_is_the_root_mean_square_of_its_residuals_at_its_time():
    r = RNG.normal(size=(3, 10, 3))
    r[0, :4] = np.nan
    r[1] = np.nan
    part = SimpleNamespace(windows=cut(), used=np.ones(3, bool))
    found = misfit_by_window(SimpleNamespace(parts=[part]), [{IMU[1]: r}])
    sizes = [math.sqrt(np.mean(r[0, 4:] ** 2)), math.sqrt(np.mean(r[2] ** 2))]
    assert np.array(found[IMU[1]]) == pytest.approx(np.column_stack([[5.2, 5.6], sizes]))


def left_out(sizes, per):
    """The windows that stay of 40 whose mean squares are given, one after the other, with as many samples each."""
    search, count = object.__new__(VehicleSearch), len(sizes)
    w = cut(first=100 * np.arange(count), samples={IMU[1]: sampled(count, per=per)})
    part = SimpleNamespace(windows=w, used=np.ones(count, bool), crowded=False)
    search.parts = [part]
    search._leave_out([SimpleNamespace(misfit={IMU[1]: np.array(sizes)})])
    return part


def test_windows_that_no_vehicle_explains_are_left_out_with_those_beside_them():
    sizes = np.full(40, 0.9)
    sizes[17] = 0.9 * (1.0 + 1.2 * UNEXPLAINED)
    many = round(2.0 * (CHANCE / UNEXPLAINED) ** 2)  # samples with which chance adds less than half of that
    part = left_out(sizes, many)
    assert np.flatnonzero(~part.used).tolist() == [16, 17, 18]
    assert not part.crowded
    assert left_out(sizes, 5).used.all()  # as much is chance with few samples
    sizes[17] = 0.9 * (1.0 + 1.2 * CHANCE * math.sqrt(2.0 / 15.0))
    assert np.flatnonzero(~left_out(sizes, 5).used).tolist() == [16, 17, 18]


def test_if_more_than_half_is_disturbed_the_worst_are_left_out_and_eight_stay():
    sizes = np.full(40, 0.9)
    sizes[::3] = 0.9 * (20.0 + np.arange(14))
    part = left_out(sizes, 500)
    assert part.crowded
    assert part.used.sum() == 8
    assert not part.used[::3].any()


# results


def test_intervals_are_of_the_delta_method_and_positive_ones_by_their_logarithm():
    C, least, wide = np.diag([0.04, 0.09]), np.diag([0.01, 0.09]), np.diag([4.0, 0.1])
    J = np.array([[2.0, 0.0], [0.0, 1.0]])
    far, near = rows_of({"place": (np.array([9.0, 0.5]), J, "m", np.array([8.0, 0.0]))}, C, least, wide)
    assert (far.key, near.key, far.start) == ("place.x", "place.y", 8.0)
    half = NORMAL * 0.4
    assert (far.low, far.high) == pytest.approx((9.0 * math.exp(-half / 9.0), 9.0 * math.exp(half / 9.0)))
    assert (near.low, near.high) == pytest.approx((0.5 - NORMAL * 0.3, 0.5 + NORMAL * 0.3))
    assert (far.efficiency, near.efficiency) == pytest.approx((0.25, 1.0))
    assert (far.excited, near.excited) == (True, False)


def test_derivatives_of_keys_are_those_of_their_functions():
    def keys(q):
        return {"a": (np.array([q[0] ** 2, q[0] * q[1]]), "m"), "b": (np.array([np.sin(q[1])]), "1")}

    found = _with_derivatives(keys, np.array([3.0, 0.5]))
    assert found["a"][1] == pytest.approx(np.array([[6.0, 0.0], [0.5, 3.0]]), abs=1e-6)
    assert found["b"][1] == pytest.approx(np.array([[0.0, math.cos(0.5)]]), abs=1e-6)
    assert found["a"][0] == pytest.approx([9.0, 1.5])


def row(key, value=1.5, half=0.01, excited=True):
    return Row(key, value, value - half, value + half, "kg", 1.4, excited, 0.9)


def test_a_saved_vehicle_has_the_interval_of_each_quadrotors_own_key_in_a_folder_that_is_made(tmp_path):
    rows = (
        row("vehicle.quadrotors.1.mass"),
        row("vehicle.payload.mass", excited=False),
        row("vehicle.quadrotors.*.lag_up"),
    )
    found = Identification(iris(), rows, (), (), {})
    for _ in range(2):
        mission, about = found.save(tmp_path / "one" / "two")
    lines, masses = mission.read_text("utf-8").splitlines(), []
    for line in lines:
        masses += [line] if line.startswith("mass = ") and "mass = [" not in line else []
    marked = [line for line in lines if line.endswith("  # ± 0.01")]
    assert sum(line.startswith("mass = ") for line in marked) == 1
    assert sum(line.startswith("lag_up = ") for line in marked) == 2
    quadrotors = "\n".join(lines).split("[[vehicle.quadrotors]]")[1:]
    assert "# ± 0.01" not in quadrotors[0].split("mass = ")[1].split("\n")[0]
    assert "# ± 0.01" in quadrotors[1].split("mass = ")[1].split("\n")[0]
    assert any(line.startswith("mass = ") and line.endswith("# not excited: prior") for line in lines)
    assert "±" not in about.read_text("utf-8")
    assert load_mission(mission).vehicle == iris().vehicle
