"""Pieces of an identification against closed forms: windows, derivatives by differences, intervals, random walks."""

import math
from functools import cached_property
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from tandemlift.analysis.identification import excitation_information
from tandemlift.analysis.identification.equations import ROBUST, Linearisation, _block_means
from tandemlift.analysis.identification.excitation_design import (
    PEAK,
    ExcitationDesign,
    axis_lines,
    excited_tables,
    push_rows,
    used_of,
)
from tandemlift.analysis.identification.fit import CHANCE, UNEXPLAINED, VehicleSearch
from tandemlift.analysis.identification.identification import NORMAL, Identification, Row, rows_of
from tandemlift.analysis.identification.identify import _with_derivatives
from tandemlift.analysis.identification.judgement import covariance_of, misfit_by_window, whiteness
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
from tandemlift.analysis.identification.windows import (
    FlightWindows,
    Samples,
    _clear,
    _in_flight,
    _speeds,
    _without_spikes,
    windows_of,
)
from tandemlift.analysis.logs.log import COMMANDS, IMU, JOINTS, MOTION, SPEED_COMMANDS, Log, Stream, conjugate
from tandemlift.analysis.logs.log import quaternion_product as product
from tandemlift.core.errors import InputError
from tandemlift.core.types import GRAVITY, flat
from tandemlift.engines.vehicle_unknowns import unknowns_of
from tandemlift.missions import load_mission

RNG = np.random.default_rng(11)


def iris():
    return load_mission("iris")


# windows


def cut(first=(100, 200, 300), length=100, block=10, samples=None, commands=None, count=450, step=0.002):
    """Windows of a grid that begins at 5 s."""
    commands = commands or Stream(np.array([4.0, 9.0]), np.zeros((2, 8)))
    pushes = np.zeros((count, 6))
    return FlightWindows("log", step, 5.0, count, np.array(first), length, block, commands, pushes, samples or {})


def sampled(windows, width=3, per=20, values=None):
    """Samples of each window, evenly."""
    window = np.repeat(np.arange(windows), per)
    step = np.tile(np.arange(per) * 5, windows)
    values = RNG.normal(size=(len(window), width)) if values is None else values
    return Samples(window, step, np.zeros(len(window)), values)


def test_windows_begin_when_their_steps_do():
    assert cut().times() == pytest.approx([5.2, 5.4, 5.6])


def test_chosen_windows_are_numbered_anew_and_keep_their_samples():
    s = sampled(3)
    few = cut(samples={MOTION[0]: s, IMU[1]: s.only(s.window == 0)}).chosen(np.array([False, True, True]))
    assert few.first.tolist() == [200, 300]
    assert list(few.samples) == [MOTION[0]]  # the other has none there
    own = few.samples[MOTION[0]]
    assert np.array_equal(own.values, s.values[s.window > 0])
    assert np.bincount(own.window).tolist() == [20, 20]


def test_a_command_in_steps_is_its_mean_over_each_step_of_the_grid_whatever_its_delay():
    time = 4.0 + np.cumsum(RNG.uniform(0.001, 0.006, 900))
    speeds = RNG.uniform(300.0, 900.0, (900, 8))
    w = cut(commands=Stream(time, speeds), count=200)
    for delay in (0.0, 0.0137):
        mean, slope = w.commands_at(delay)
        fine = 5.0 + (np.arange(200 * 400) + 0.5) * 0.002 / 400.0 - delay
        held = speeds[np.searchsorted(time, fine, side="right") - 1]
        assert mean == pytest.approx(held.reshape(200, 400, 8).mean(axis=1), abs=5.0)
        later, _ = w.commands_at(delay + 1e-7)
        near = np.abs((later - mean) / 1e-7 - slope) < 1e-3 * (1.0 + np.abs(slope))
        assert near.mean() > 0.99  # of commands that change within a difference the slope jumps


def test_a_command_that_begins_with_a_step_of_the_grid_acts_in_it():
    """Times are sums: what begins up to a nanosecond after a step begins with it."""
    time = np.array([4.0, 5.0 + 4e-10, 5.002 + 4e-10, 9.0])
    speeds = np.repeat([[0.0], [1.0], [3.0], [3.0]], 8, axis=1)
    mean, slope = cut(commands=Stream(time, speeds), count=3).commands_at(0.0)
    assert mean[:2, 0] == pytest.approx([1.0, 3.0], abs=1e-5)
    assert slope[:, 0] == pytest.approx([-1000.0, 0.0, 0.0])


@pytest.mark.parametrize("share", [0.0, 0.005, 0.02])
def test_commands_above_the_largest_speed_are_refused_if_there_are_more_than_one_in_a_hundred(share):
    vehicle = iris().vehicle
    most = np.repeat([q.max_speed for q in vehicle.quadrotors], 4)
    values = RNG.uniform(0.3, 0.9, (1000, 8)) * most
    values[: round(1000 * share), 5] = 1.3 * most[5]
    log = Log({SPEED_COMMANDS: Stream(np.arange(1000) * 0.01, values)}, "log")
    if share > 0.01:
        with pytest.raises(InputError, match=r"column 5 is above vehicle.quadrotors.1.max_speed .* in 2% of its"):
            _speeds(log, vehicle)
    else:
        assert _speeds(log, vehicle).values == pytest.approx(np.minimum(values, most))


def test_commanded_thrusts_are_squares_of_speeds_times_the_constants():
    vehicle, speeds = iris().vehicle, RNG.uniform(300.0, 700.0, (50, 8))
    constants = np.repeat([q.thrust_constant for q in vehicle.quadrotors], 4)
    log = Log({COMMANDS: Stream(np.arange(50) * 0.01, constants * speeds**2)}, "log")
    assert _speeds(log, vehicle).values == pytest.approx(speeds)


def test_a_spike_is_left_out_with_what_it_spoils_and_a_still_column_has_none():
    values = np.column_stack([RNG.normal(size=200), np.full(200, 2.0)])
    values[77, 0] += 80.0
    values[120, 1] += 1e-9  # a column that hardly ever changes cannot say what is usual
    kept = _without_spikes(Stream(np.arange(200.0), values))
    gone = set(range(200)) - set(kept.time.astype(int))
    assert 77 in gone
    assert gone <= {76, 77, 78}


def hovering(seconds, step=0.001):
    """A log of a hover at 3 m from the start, with noise of all sensors and commands that move."""
    vehicle, t = iris().vehicle, np.arange(0.0, seconds, step)
    mass = vehicle.payload.mass + sum(q.mass for q in vehicle.quadrotors)
    constants = np.repeat([q.thrust_constant for q in vehicle.quadrotors], 4)
    speed = np.sqrt(mass * GRAVITY / (8.0 * constants)) * (1.0 + 0.01 * np.sin(np.outer(t, 1.0 + np.arange(8.0))))

    def noisy(width, mean=0.0):
        return Stream(t, mean + 0.01 * RNG.normal(size=(len(t), width)))

    q = noisy(4, [1.0, 0.0, 0.0, 0.0])
    q.values[:] /= np.linalg.norm(q.values, axis=1, keepdims=True)
    streams = {IMU[0]: noisy(3, [0.0, 0.0, GRAVITY]), IMU[1]: noisy(3), MOTION[0]: noisy(3, [0.0, 0.0, 3.0])}
    return Log(streams | {MOTION[1]: noisy(3), MOTION[2]: q, SPEED_COMMANDS: Stream(t, speed)}, "log")


@pytest.mark.parametrize("extra", [0.0, 0.005, 0.012, 0.018, 0.022, 0.035])
def test_behind_the_last_window_there_is_a_block_for_its_end_and_one_for_a_late_clock(extra):
    w = windows_of(hovering(9.4 + extra), iris())
    assert len(w.first) >= 8
    assert w.first[-1] + w.length + 2 * w.block < w.count


def test_a_window_flies_where_rotors_carry_the_weight_clear_of_where_it_rested():
    mission = iris()
    vehicle, clear = mission.vehicle, _clear(mission.vehicle)
    assert clear == pytest.approx(6.0 * max(q.rotor_radius for q in vehicle.quadrotors))
    mass = vehicle.payload.mass + sum(q.mass for q in vehicle.quadrotors)
    constants = np.repeat([q.thrust_constant for q in vehicle.quadrotors], 4)
    hover, t = np.sqrt(mass * GRAVITY / (8.0 * constants)), np.arange(4.0, 9.0, 0.01)
    on = np.clip((t - 4.5) / 0.1, 0.0, 1.0)
    height = 0.3 + np.where(t < 5.35, 0.9, 1.1) * clear * on
    log = Log({"measured_position": Stream(t, np.column_stack([0.0 * t, 0.0 * t, height]))}, "log")
    w = cut(commands=Stream(t, on[:, None] * hover))
    flies, rested = _in_flight(w, log, vehicle)
    assert rested == pytest.approx(0.3, abs=1e-6)
    assert flies.tolist() == [False, True, True]  # the first is too near the floor until 5.35 s
    low = cut(commands=Stream(t, 0.6 * on[:, None] * hover))  # a third of the weight
    assert not _in_flight(low, log, vehicle)[0].any()


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


# excitation


def test_pushes_go_to_and_fro_along_each_axis_and_turn_the_arm_to_the_outermost_quadrotor():
    places = [(0.3, 0.4, 0.0), (-0.1, 0.0, 0.0)]
    rows = push_rows(places, 20.0, 2.0)
    assert [push["time"] for push in rows] == pytest.approx(20.0 + 3.0 * (np.arange(8) + 0.5))
    assert np.array([push["force"] for push in rows[:6]]) == pytest.approx(np.kron(2.0 * np.eye(3), [[1.0], [-1.0]]))
    for push, sign in zip(rows[6:], (1.0, -1.0), strict=True):
        force, point = np.array(push["force"]), np.array(push["point"])
        assert point == pytest.approx([0.15, 0.2, 0.0])
        assert np.linalg.norm(force) == pytest.approx(2.0)
        assert np.cross(point, force)[2] == pytest.approx(-sign * 2.0 * 0.25)  # across the arm
    assert len(push_rows([(0.0, 0.0, 0.0)], 20.0, 2.0)) == 6


@pytest.mark.parametrize("push", [0.0, 2.0])
def test_an_excited_mission_lands_after_its_sines_and_pushes(push):
    t = excited_tables(iris(), 30.0, (2.0, 2.0, 1.0), push)
    begin = t["excitation"]["begin"]
    assert begin >= iris().phases.lift_start + iris().phases.lift_duration + 2.0
    assert len(t["pushes"]) == (8 if push else 0)
    assert t["phases"]["land_start"] == pytest.approx(begin + 30.0 + 2.0 + 3.0 * len(t["pushes"]))
    assert t["mission"]["duration"] >= t["phases"]["land_start"] + iris().phases.land_duration
    for one in t["pushes"]:
        assert begin + 30.0 < one["time"] < t["phases"]["land_start"]


def test_the_phases_of_an_axis_keep_its_peak_low():
    f, A = np.arange(2, 12) / 20.0, np.linspace(1.0, 2.0, 10)
    A[3] = 0.0
    rows = axis_lines("roll", f, A)
    assert [row["frequency"] for row in rows] == pytest.approx(np.delete(f, 3))
    assert [row["amplitude"] for row in rows] == pytest.approx(np.delete(A, 3))
    t = np.linspace(0.0, 20.0, 20_001)
    wave = sum(row["amplitude"] * np.sin(2.0 * np.pi * row["frequency"] * t + row["phase"]) for row in rows)
    assert np.abs(wave).max() < PEAK * math.sqrt((A**2).sum())
    one = [row["amplitude"] * np.sin(2.0 * np.pi * row["frequency"] * t) for row in rows]
    assert np.abs(wave).max() < np.abs(sum(one)).max()


def test_what_a_flight_used_is_its_largest_tilt_thrust_and_speed_and_its_room_until_it_lands():
    t = np.arange(0.0, 10.0, 0.5)
    within = (t >= 3.0) & (t <= 7.0)
    channels = {
        "euler": np.column_stack([0.1 + 0.0 * t, 0.2 * (t == 5.0), 3.0 + 0.0 * t]),
        "rotor_thrusts": np.where(t == 6.0, 4.0, 3.0)[:, None] * np.ones(8),
        "velocity": np.column_stack([0.3 * (t == 4.0), 0.4 * (t == 4.0), 0.0 * t]),
        "position": np.column_stack([t, 0.5 * t, 0.0 * t]),
    }
    for values in channels.values():
        values[~within] += 50.0
    about = {"time": t, "mission": {"excitation": {"begin": 3.0}, "phases": {"land_start": 7.0}}}
    flight = type("Flown", (), {"__getitem__": lambda self, name: channels[name]} | about)()
    limits = {"tilt": 0.5, "rotor thrust": 6.0, "speed": 1.0, **{f"room along {axis}": 9.0 for axis in "xyz"}}
    found = used_of(flight, limits)
    tilt = math.acos(math.cos(0.1) * math.cos(0.2))
    assert [value for value, _ in found.values()] == pytest.approx([tilt, 4.0, 0.5, 4.0, 2.0, 0.0])
    assert [limit for _, limit in found.values()] == list(limits.values())


def test_a_promise_is_in_percent_and_of_delays_and_places_in_thousandths():
    rows = (
        Row("mass", 4.0, 3.98, 4.02, "kg", 4.0, True, 1.0),
        Row("actuators.delay", 0.01, 0.009, 0.011, "s", 0.01, True, 1.0),
        Row("center_of_mass.x", 0.1, 0.098, 0.102, "m", 0.1, False, 1.0),
    )
    said = "\n".join(ExcitationDesign(iris(), rows, {"tilt": (0.1, 0.3)}, "").lines())
    assert "± 0.5 %" in said
    assert "± 1 ms" in said
    assert "± 2 mm, not excited" in said
    assert "0.1 of 0.3 rad" in said


def test_a_heavier_body_looks_like_weaker_rotors_and_one_that_is_late_like_none(monkeypatch):
    """Responses in proportion to 1/mass: their slope by the mass is the opposite of that by the thrust constant."""
    mission, f = iris(), np.array([0.5, 2.0])
    body = RNG.normal(size=(2, 12, 8)) + 1j * RNG.normal(size=(2, 12, 8))
    motion = RNG.normal(size=(2, 12, 8)) + 1j * RNG.normal(size=(2, 12, 8))
    monkeypatch.setattr(
        excitation_information, "body_response", lambda calm, at, frequencies: body / calm.plant.mass_scale
    )
    monkeypatch.setattr(
        excitation_information, "linearize", lambda *_, **__: SimpleNamespace(connected=lambda: "the loop")
    )
    asked = []
    monkeypatch.setattr(
        excitation_information, "frequency_response", lambda model, hertz: asked.append((model, hertz)) or motion
    )
    found = excitation_information.excited_hover(mission, f)
    assert [model for model, _ in asked] == ["the loop"]
    assert np.array_equal(asked[0][1], f)
    names = [p.name for p in excitation_information.PARAMETERS]
    mass, constant = names.index("mass"), names.index("thrust constant")
    I = found.information  # noqa: E741
    assert I[..., mass, mass] == pytest.approx(I[..., constant, constant], rel=3e-3)
    assert I[..., mass, constant] == pytest.approx(-I[..., constant, constant], rel=3e-3)
    assert (I[..., constant, constant] > 0.0).all()
