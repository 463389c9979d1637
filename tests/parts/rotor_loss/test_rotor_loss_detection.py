"""A lost rotor is found in the motion of a vehicle that SciPy integrates, and named by its number."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import StateSpace, lsim
from scipy.spatial.transform import Rotation

from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each, vec3
from tandemlift.missions import load_mission
from tandemlift.parts.guidance.guidance import PilotInput
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotor_loss.decision import decision_step, share_gone, support
from tandemlift.parts.rotor_loss.detection import (
    confirmed,
    detection_step,
    explained_by,
    followed,
    left_of,
    residual,
    start_detection,
    with_trials,
)
from tandemlift.parts.rotors.allocation import mixer_from

MISSION = load_mission("iris", {"detection.model": "residual", "actuators.start": "hover"})
VEHICLE = Vehicle.from_settings(MISSION.vehicle)
DETECTION, START = start_detection(
    MISSION.detection, VEHICLE, mixer_from(VEHICLE.effect), MISSION.mission.step, MISSION.initial, hovers=True
)
DT, LEVEL, EIGHT = 1e-3, Quat(1.0, 0.0, 0.0, 0.0), each(8)
HOVER = VEHICLE.weight / 8.0
SETTLED = START._replace(scatter=START.scatter._replace(value=START.scatter.value * 0.0))
LAG, DELAY = 0.018, 0.01  # s, as the detection believes them to be
NOISE = np.array([0.01, 0.01, 0.01, 0.01])  # m/s, rad/s


def moved(share, wind, seed):
    """Climb [m/s] and rates [rad/s] (T × 4), linear: rotors give a share (T × 8) of hover, wind a wrench (T × 4)."""
    t = np.arange(len(share)) * DT
    per_inertia = np.zeros((4, 4))
    per_inertia[0, 0], per_inertia[1:, 1:] = 1.0 / VEHICLE.mass, np.linalg.inv(VEHICLE.inertia)
    drift = np.array([GRAVITY, 0.0, 0.0, 0.0])
    into = np.hstack([per_inertia @ VEHICLE.effect, per_inertia, -drift[:, None]])
    system = StateSpace(np.zeros((4, 4)), into, np.eye(4), np.zeros((4, 13)))
    forces = np.hstack([HOVER * share, wind, np.ones((len(t), 1))])
    _, y, _ = lsim(system, forces, t)
    return y + np.random.default_rng(seed).standard_normal(y.shape) * NOISE


def lagged(commands):
    """Shares of hover that rotors give: commands through a delay and a lag."""
    late = np.vstack([np.ones((round(DELAY / DT), 8)), commands])[: len(commands)]
    rotor = StateSpace([[-1.0 / LAG]], [[1.0 / LAG]], [[1.0]], [[0.0]])
    t = np.arange(len(commands)) * DT
    return np.stack([lsim(rotor, column, t, X0=column[0])[1].ravel() for column in late.T], axis=1)


def watched(motion, memory, since=0, commands=None):
    """(time [s], rotor from 1) of every change of mind, and the memory at the end."""
    seen, before = [], 0
    for k, row in enumerate(motion, since):
        thrusts = EIGHT(*(HOVER * (np.ones(8) if commands is None else commands[k - since])))
        pilot_input = PilotInput(
            State(ZERO, Vec3(0.0, 0.0, float(row[0])), LEVEL, vec3(row[1:])), ZERO, ZERO, 0.0, Absent()
        )
        thrusts = EIGHT(*map(float, np.array(thrusts) * left_array(memory)))
        memory = detection_step(DETECTION, memory, pilot_input, thrusts, 1.0, k * DT, DT)
        number = int(np.dot(memory.verdict.lost, np.arange(1, 9)))
        if number != before:
            seen.append((k * DT, number))
            before = number
    return seen, memory


def left_array(memory):
    return np.array(left_of(DETECTION, memory))


def lost(rotor, gone, at, count):
    share = np.ones((count, 8))
    share[at:, rotor] -= gone
    return share


@pytest.mark.parametrize("rotor", [0, 3, 6])
def test_a_rotor_that_stops_is_named_within_80_ms_and_stays_named(rotor):
    motion = moved(lost(rotor, 1.0, 100, 250), np.zeros((250, 4)), rotor)  # beyond, rates are no longer linear
    seen, memory = watched(motion, SETTLED)
    assert [number for _, number in seen] == [rotor + 1]
    assert 0.1 < seen[0][0] < 0.18
    assert confirmed(DETECTION, memory.verdict, 0.9) == 1.0
    assert confirmed(DETECTION, memory.verdict, seen[0][0] + DETECTION.rules.retest_time - DT) == 0.0
    assert left_array(memory)[rotor] == 0.0
    assert left_array(memory).sum() == 7.0


def test_a_rotor_that_loses_two_thirds_is_named_and_one_that_loses_a_quarter_is_not():
    for gone, number in ((0.67, [6]), (0.25, [])):
        motion = moved(lost(5, gone, 100, 250), np.zeros((250, 4)), 1)
        assert [n for _, n in watched(motion, SETTLED)[0]] == number


def test_wind_and_a_wrong_mass_and_noise_name_no_rotor():
    count = 3000
    t = np.arange(count) * DT
    wind = np.stack([-3.0 - np.sin(2.0 * t), 0.8 * np.sin(3.0 * t), 0.02 * np.sin(4.0 * t), 0.2 * np.cos(2.0 * t)], 1)
    settled = SETTLED._replace(mean=SETTLED.mean._replace(value=type(SETTLED.mean.value)(-3.0, 0.0, 0.0, 0.2)))
    assert watched(moved(np.ones((count, 8)), wind, 2), settled)[0] == []


def named(rotor, at):
    """A memory in which a rotor was just named."""
    v = SETTLED.verdict
    one = EIGHT(*np.eye(8)[rotor].tolist())
    return SETTLED._replace(verdict=v._replace(lost=one, since=at))


def test_a_rotor_that_was_named_but_turns_on_trial_is_restored():
    seen, _ = watched(moved(np.ones((400, 8)), np.zeros((400, 4)), 3), named(4, 0.0))
    assert [number for _, number in seen] == [5, 0]
    assert 0.01 < seen[1][0] < 0.1


def test_another_rotor_that_explains_the_motion_better_is_named_instead():
    motion = moved(lost(2, 1.0, 100, 260), np.zeros((260, 4)), 4)
    found, memory = watched(motion[:170], SETTLED)
    wrong = memory._replace(verdict=named(0, 0.17).verdict)
    seen, _ = watched(motion[170:], wrong, 170)
    assert [number for _, number in found] == [3]
    assert [number for _, number in seen] == [1, 3]
    assert seen[1][0] < 0.22


def test_a_rotor_is_tried_again_for_as_long_as_is_set_and_then_left():
    commands = EIGHT(*(0.0,) * 8)
    during = np.array(with_trials(DETECTION, named(4, 0.0), commands, 0.199))
    after = np.array(with_trials(DETECTION, named(4, 0.0), commands, 0.2))
    assert during == pytest.approx(np.eye(8)[4] * HOVER)
    assert not after.any()


def test_commands_that_jump_through_lag_and_delay_name_no_rotor():
    commands = np.ones((1500, 8))
    commands[300:500, :4] += 0.3
    commands[300:500, 4:] -= 0.3
    commands[800:1000, ::2] += 0.4
    motion = moved(lagged(commands), np.zeros((1500, 4)), 5)
    assert watched(motion, SETTLED, commands=commands)[0] == []


def test_a_vehicle_that_stands_on_something_is_not_watched():
    wind = np.zeros((1500, 4))
    wind[300:800] = [20.0, 3.0, -0.3, 0.0]
    motion = moved(np.ones((1500, 8)), wind, 6)
    assert watched(motion, SETTLED)[0] == []


def unexplained(attitude, climb, rates, thrust, seconds=0.3):
    """The residual of a vehicle with an attitude (3 angles), climb(t) [m/s] and rates(t), each rotor at a thrust(t)."""
    q, memory = Quat(*Rotation.from_euler("ZXY", attitude).as_quat(scalar_first=True).tolist()), SETTLED
    for k in range(round(seconds / DT)):
        state = State(ZERO, Vec3(0.0, 0.0, climb(k * DT)), q, vec3(rates(k * DT)))
        pilot_input = PilotInput(state, ZERO, ZERO, 0.0, Absent())
        memory = followed(DETECTION, memory, pilot_input, EIGHT(*(thrust(k * DT),) * 8), k * DT)
    return np.array(residual(DETECTION, memory, pilot_input))


def test_on_a_tilted_vehicle_what_thrust_is_missing_along_its_own_axis_is_what_is_not_explained():
    """Newton's law along the vertical: m a = T cos(tilt) − m g, with the tilt from SciPy."""
    attitude, missing, up = (-2.0, 0.3, -0.7), 0.2, 1.5
    cosine = Rotation.from_euler("ZXY", attitude).as_matrix()[2, 2]
    needed = VEHICLE.mass * (GRAVITY + up) / cosine
    off = unexplained(attitude, lambda t: up * t, lambda t: (0.0, 0.0, 0.0), lambda t: needed / (1.0 - missing) / 8.0)
    assert off[0] == pytest.approx(-needed * missing / (1.0 - missing), abs=1e-3 * needed)
    assert off[1:] == pytest.approx([0.0] * 3, abs=1e-9)


def test_a_vehicle_that_tumbles_freely_explains_its_turning_by_its_own_momentum():
    """Euler's equations without a moment, by SciPy: the rates change by −J⁻¹ (ω × J ω) alone."""
    J = VEHICLE.inertia

    def rate(t, w):
        return -np.linalg.solve(J, np.cross(w, J @ w))

    tumbling = solve_ivp(rate, (0.0, 0.3), [3.0, 2.0, 2.5], rtol=1e-10, atol=1e-12, dense_output=True).sol
    gyroscopic = max(np.abs(np.cross(w, J @ w)).max() for w in tumbling(np.linspace(0.0, 0.3, 50)).T)
    off = unexplained((0.0, 0.0, 0.0), lambda t: 0.0, tumbling, lambda t: HOVER)
    assert gyroscopic > 0.5
    assert np.abs(off[1:]).max() < 0.02 * gyroscopic


@pytest.mark.parametrize("rotor", [0, 3, 6])
def test_what_a_lost_rotor_explains_is_its_column_of_the_effect(rotor):
    verdict = named(rotor, 0.0).verdict
    thrusts = np.linspace(3.0, 5.0, 8)
    found = np.array(explained_by(DETECTION, verdict, EIGHT(*thrusts.tolist())))
    assert found == pytest.approx(-VEHICLE.effect[:, rotor] * thrusts[rotor], abs=1e-12)


@pytest.mark.parametrize(("explained", "names"), [(1.05, True), (0.95, False)])
def test_only_a_rotor_that_explains_nearly_all_of_the_residual_is_named(explained, names):
    rules, verdict = DETECTION.rules, SETTLED.verdict
    evidence = EIGHT(*np.where(np.arange(8) == 3, 10.0 * rules.threshold, 0.0).tolist())
    square = 10.0 * rules.threshold / (1.0 - rules.unexplained_fraction) / explained
    for k in range(100):
        verdict = decision_step(rules, verdict, evidence, square, 1.0, k * DT, DT)
    assert np.array(verdict.lost).tolist() == (np.eye(8)[3] * names).tolist()


def test_without_a_dwell_a_rotor_is_named_once_at_the_first_sample_and_stays_lost():
    mission = load_mission("iris", {"detection.model": "residual", "detection.dwell": 0.0})
    start = mission.detection, VEHICLE, mixer_from(VEHICLE.effect), DT, mission.initial
    rules, verdict = start_detection(*start, hovers=True)[0].rules, SETTLED.verdict
    evidence = EIGHT(*(10.0 * rules.threshold * np.eye(8)[3]).tolist())
    for k in range(20):
        verdict = decision_step(rules, verdict, evidence, 10.0 * rules.threshold, 1.0, k * DT, DT)
        assert (list(verdict.lost), verdict.named, verdict.since) == (np.eye(8)[3].tolist(), 1.0, 0.0)


@pytest.mark.parametrize(("fit", "size"), [(3.0, 4.0), (0.5, 2.0), (9.0, 4.0), (20.0, 21.0)])
def test_the_fraction_that_is_taken_for_lost_has_the_most_evidence(fit, size):
    """Against a search over all fractions; without a spread it is fit/size, within its bounds."""
    shares = np.linspace(0.5, 1.5, 10_001)
    for per_spread in (0.0, 2.0, 50.0):
        wanted = shares[np.argmax([support(share, fit, size, per_spread) for share in shares.tolist()])]
        assert share_gone(fit, size, per_spread) == pytest.approx(wanted, abs=1e-4)
    assert support(1.0, fit, size, 7.0) == pytest.approx(2.0 * fit - size)


def test_modelled_rotors_explain_the_change_of_momentum_that_they_make_about_every_axis():
    """Level, with thrusts that differ: the momentum changes by their wrench, from the effect, and by what else acts."""
    thrusts = np.random.default_rng(5).uniform(2.0, 5.0, 8)
    made, others = VEHICLE.effect @ thrusts, np.array([-30.0, 0.6, -0.4, 0.7])
    memory = SETTLED._replace(
        thrusts=SETTLED.thrusts._replace(value=EIGHT(*thrusts.tolist())),
        momentum=SETTLED.momentum._replace(rate=each(4)(*(made + others + [0.5, 0.1, 0.2, 0.3]).tolist())),
        others=SETTLED.others._replace(value=each(4)(*others.tolist())),
    )
    level = PilotInput(State(ZERO, ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO), ZERO, ZERO, 0.0, Absent())
    assert np.abs(made).min() > 0.05  # about every axis
    assert np.array(residual(DETECTION, memory, level)) == pytest.approx([0.5, 0.1, 0.2, 0.3])
