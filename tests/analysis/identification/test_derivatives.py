"""Predictions and equations of an identification against differences and sums."""

from functools import cached_property, partial
from types import SimpleNamespace

import flight_windows
import numpy as np
import pytest
from flight_windows import cut, iris

from tandemlift.analysis.identification.equations import ROBUST, Linearisation, _block_means
from tandemlift.analysis.identification.prediction import (
    OUTPUTS,
    STARTS,
    PredictedDerivatives,
    Predictor,
    _in_blocks,
    _start_direction,
    moved_starts,
)
from tandemlift.analysis.identification.sensor_errors import SensorPriors
from tandemlift.analysis.identification.vehicle_unknowns import unknowns_of
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Stream, conjugate
from tandemlift.analysis.logs.log import quaternion_product as product
from tandemlift.core.types import flat

RNG = np.random.default_rng(11)
sampled = partial(flight_windows.sampled, rng=RNG)


# predictions


class LinearPredictor(Predictor):
    """A predictor whose readings are sums of starts, parameters and inputs; the attitude is that of the start."""

    @cached_property
    def models(self):
        P, U = len(flat(self.unknowns.start.vehicle)) + 4, 4 * self.joints + 6
        outputs = 3 * 5 + 4 + 2 * 3 * (self.joints - 1) + 3
        A, B, C = (np.random.default_rng(k).normal(size=(outputs, n)) for k, n in enumerate((13, P, U)))
        A[6:10], B[6:10], C[6:10] = np.eye(13)[6:10], 0.0, 0.0

        def of(x, p, u):
            y = (x @ A.T)[:, None] + B @ p + u @ C.T
            return np.concatenate([y, y[:, -1:]], axis=1)[:, : u.shape[1]]

        def seen(x, p, u, dx, dp, du):
            return of(x, p, u), of(dx, dp, du)

        return SimpleNamespace(
            body=lambda x, p, u: (of(x, p, u), None),
            body_tangents=SimpleNamespace(tangent=seen),
            rotors=self._rotors,
            rotor_tangents=SimpleNamespace(tangent=lambda x, p, u, dx, dp, du: (u + 0.0, dx[:, None, :1] + du)),
        )

    def _rotors(self, x, p, u):
        self.__dict__["asked"] = x
        return u + 0.0, None


def predictor(first=(100, 200)):
    mission, s = iris(), sampled(2)
    samples = dict.fromkeys((*MOTION, *IMU, *JOINTS), s)
    speeds = Stream(np.linspace(4.0, 9.0, 400), RNG.uniform(300.0, 700.0, (400, 8)))
    w = cut(first, samples=samples, commands=speeds)
    return LinearPredictor(w, unknowns_of(mission.vehicle, mission.actuators.delay), mission)


def starts(count=2):
    found = RNG.normal(size=(count, 13))
    found[:, 6:10] /= np.linalg.norm(found[:, 6:10], axis=1, keepdims=True)
    return found


def test_means_over_blocks_are_those_of_their_rows():
    rows = RNG.normal(size=(2, 12, 5))
    found = _in_blocks(rows, 3)
    assert found.shape == (2, 4, 5)
    assert found[1, 2] == pytest.approx(rows[1, 6:9].mean(axis=0))


@pytest.mark.parametrize("i", range(STARTS))
def test_the_direction_of_a_start_is_the_difference_of_moved_ones(i):
    x, by = starts(), np.zeros((2, STARTS))
    by[:, i] = 1e-6
    difference = (moved_starts(x, by) - moved_starts(x, -by)) / 2e-6
    assert _start_direction(x, i) == pytest.approx(difference, abs=1e-8)


@pytest.mark.thorough
def test_derivatives_of_predictions_are_their_differences_by_starts_vehicle_and_point():
    p, x, point = predictor(), starts(), np.array([0.01, -0.02, 0.03])
    n0, P = len(flat(p.unknowns.start.vehicle)), len(p.unknowns)
    base = RNG.uniform(1e5, 4e5, (p.windows.count, 8))
    moved = [RNG.normal(size=base.shape) for _ in range(5)]  # by two lags up, two down, and the delay

    def at(by):
        n = p.unknowns.numbers(by[STARTS : STARTS + P])
        late = np.array([*n.up, *n.down, n.delay])
        squares = base + sum(k * m for k, m in zip(late, moved, strict=True))
        begun = moved_starts(x, np.broadcast_to(by[:STARTS], (2, STARTS)))
        return p.derivatives(begun, by[STARTS : STARTS + P], n, squares, moved, point + by[STARTS + P :]).base

    zero = np.zeros(STARTS + P + 3)
    n = p.unknowns.numbers(zero[:P])
    late = np.array([*n.up, *n.down, n.delay])
    squares = base + sum(k * m for k, m in zip(late, moved, strict=True))
    found = p.derivatives(x, zero[:P], n, squares, moved, point)
    assert n0 > 10
    for i in (0, 4, 5, 6, 7, 8, 9, 11, *range(STARTS, STARTS + P + 3)):
        by = zero.copy()
        by[i] = 1e-6
        ahead, behind = at(by), at(-by)
        for name in (MOTION[0], IMU[0], JOINTS[1]):
            slope = (ahead[name] - behind[name]) / 2e-6
            assert found.streams[name][:, i] == pytest.approx(
                slope, rel=1e-4, abs=1e-3 + 1e-7 * np.abs(ahead[name]).max()
            )
        turn = 2.0 * product(conjugate(found.base[MOTION[2]]), ahead[MOTION[2]] - behind[MOTION[2]])[..., 1:] / 2e-6
        assert found.streams[MOTION[2]][:, i] == pytest.approx(turn, abs=1e-6)


def test_rotors_begin_at_their_command_with_the_lags_of_their_quadrotor():
    p = predictor()
    n = p.unknowns.start._replace(up=(0.01, 0.02), down=(0.03, 0.04))
    squares, none = p.squares(n, False)
    commands, _ = p.windows.commands_at(n.delay)
    assert none == []
    assert p.asked == pytest.approx(np.column_stack([commands[0], [0.01] * 4 + [0.02] * 4, [0.03] * 4 + [0.04] * 4]))
    assert squares == pytest.approx(commands)


def test_streams_of_joints_are_quadrotor_by_quadrotor_and_the_attitude_is_always_there():
    p = predictor()
    y = np.arange(2 * 3 * 28, dtype=float).reshape(2, 3, 28)
    found = p._streams(y)
    assert set(found) == set(OUTPUTS)
    force = y[..., 16:22]  # x of both, y of both, z of both
    assert np.array_equal(found[JOINTS[0]], force[..., [0, 2, 4, 1, 3, 5]])
    few = LinearPredictor(cut(samples={IMU[1]: sampled(2)}), p.unknowns, p.mission)._streams(y)
    assert set(few) == {IMU[1], "measured_attitude"}


# equations


def test_block_means_weigh_residuals_and_know_when_they_were_sampled():
    w, s = cut(first=(0, 100), length=40, block=10), sampled(2, per=8)
    r, weight = RNG.normal(size=(16, 3)), RNG.uniform(0.1, 1.0, (16, 3))
    mean, count, late = _block_means(w, s, r, weight)
    assert mean.shape == (2, 4, 3)
    for window in range(2):
        for block in range(4):
            own = (s.window == window) & (s.step // 10 == block)
            assert count[window, block] == pytest.approx(weight[own].sum(axis=0))
            assert mean[window, block] == pytest.approx((weight[own] * r[own]).sum(axis=0) / weight[own].sum(axis=0))
            assert late[window, block] == pytest.approx((s.step[own] % 10).mean() / 10.0)


class Known:
    """A predictor whose readings and derivatives are given; two coordinates of the vehicle."""

    def __init__(self, windows, streams):
        W, blocks = len(windows.first), windows.length // windows.block
        self.windows = windows
        self.base = {name: RNG.normal(size=(W, blocks + 1, width)) for name, width in streams.items()}
        self.by = {name: RNG.normal(size=(W, STARTS + 2 + 3, blocks + 1, width)) for name, width in streams.items()}

    def starts(self):
        return starts(len(self.windows.first))

    def squares(self, n, tangents):
        return None, []

    def predicted(self, begun, n, squares, point):
        return {name: np.zeros((len(begun), self.windows.length + 1, y.shape[-1])) for name, y in self.base.items()}

    def derivatives(self, *_):
        return PredictedDerivatives(self.base, self.by)


class TwoUnknowns:
    """Two coordinates that stand for any vehicle."""

    sd, unknowns = np.ones(2), ()

    def __len__(self):
        return 2

    def numbers(self, q):
        return None


def linearised(spread, noise):
    """The equations of rates with a bias, and of positions with a clock, whose residuals are noise of a spread."""
    s = sampled(12, per=20, values=spread * RNG.normal(size=(240, 3)))
    w = cut(first=100 * np.arange(12), samples={IMU[1]: s, MOTION[0]: s})
    priors = SensorPriors({IMU[1]: slice(0, 3)}, {MOTION[0]: 3}, np.array([0.02] * 3 + [3e-3]), np.full(4, 1e-3), 0)
    lines = Linearisation([Known(w, {IMU[1]: 3, MOTION[0]: 3})], TwoUnknowns(), priors)
    lines.estimate.noise = dict.fromkeys(lines.estimate.noise, noise)
    (own,), _ = lines.linearised(ROBUST)
    return lines, lines.parts[0].predictor, own


def test_the_spread_of_residuals_is_that_of_the_samples_whatever_noise_was_believed():
    for noise in (0.1, 1.0):
        _, _, own = linearised(0.5, noise)
        assert own.spread[IMU[1]] == pytest.approx(0.5, rel=0.15)
    _, _, own = linearised(0.05, 0.1)  # no residual is large: their mean square, whitened
    assert np.mean(own.misfit[IMU[1]]) == pytest.approx(0.25, rel=0.2)


def test_a_bias_adds_to_its_own_axis_a_clock_by_the_change_and_a_parameter_by_its_derivative():
    lines, known, own = linearised(0.05, 0.1)
    root = np.sqrt(20 * 5 / 100.0 * 2.0)  # two samples in each block of ten steps
    assert set(own.columns) == {IMU[1]}
    J = own.columns[IMU[1]] * 0.1 / root
    for axis in range(3):
        assert J[:, STARTS + axis, :, axis] == pytest.approx(1.0)
        assert not J[:, STARTS + axis, :, (axis + 1) % 3].any()
    late = 0.25  # of a block: samples at its begin and amid it
    along = known.by[IMU[1]]
    expected = along[:, :, :-1] + late * (along[:, :, 1:] - along[:, :, :-1])
    assert J[:, :STARTS] == pytest.approx(expected[:, :STARTS])
    assert J[:, STARTS + 4 :] == pytest.approx(expected[:, STARTS:])
    clock = np.diff(known.base[MOTION[0]], axis=1) / 0.02 * root / 0.1
    assert own.matrices[MOTION[0]][:, STARTS + 3, STARTS + 3] == pytest.approx((clock**2).sum(axis=(1, 2)))
    assert not own.matrices[IMU[1]][:, STARTS + 3].any()
    assert len(lines.parts[0].groups) == 12
