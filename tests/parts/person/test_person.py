"""Persons: forces within bounds, hands as springs with lags, the path of a led vehicle, delayed sight."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from law_values import array, random_state, seeds
from scipy.integrate import solve_ivp
from scipy.signal import lsim, lti, welch
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.low_pass import LowPassState
from tandemlift.core.vector import ZERO, Quat, Vec3, mat3, vec3
from tandemlift.engines.compiled import start_state
from tandemlift.parts.mechanics.push import PointPush, PushSamples, push_moment
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.person.passage import APART, TURNING, trailing, turning
from tandemlift.parts.person.person import (
    PathFollowing,
    PathLeg,
    PersonSettings,
    PersonState,
    PersonView,
    guided_point,
    hand_target,
    landing_request,
    person_step,
    person_view,
    pursue,
)
from tandemlift.parts.person.person_table import Walk, path_legs_from, start_person
from tandemlift.parts.person.tremor import STILL, TremorNoise, tremor, tremor_step

DT = 0.001
NOBODY = PointPush(ZERO, mat3([[0.0] * 3] * 3))
NO_PUSH = PushSamples(NOBODY, NOBODY, NOBODY)
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)
CALM = TremorNoise(ZERO, ZERO)
MODELS = pytest.mark.parametrize("model", ["pull", "steer", "two-hands", "hold"])


def company(model: str, path: Any = ((5.0, 0.0),), **changes: Any) -> tuple[Any, PersonState, list[PathLeg]]:
    """A person, their memory and the legs of their path, beside a vehicle that stands at 0."""
    points = [p if isinstance(p, dict) else {"point": list(p)} for p in path]
    keys = {f"person.{k}": v for k, v in {"model": model, "path": points, "height_fraction": 0.0, **changes}.items()}
    mission = tl.load_mission("hover", keys)
    vehicle, state = Vehicle.from_settings(mission.vehicle), start_state(mission.initial)
    walk = Walk(mission.person.path, state, mission.initial.euler[2], mission.phases.height)
    person, memory = start_person(mission.person, vehicle, mission.mission.step, walk)
    return person, memory, path_legs_from(mission.person, person, walk)


def at(position: Any, velocity: Any = (0.0, 0.0, 0.0), yaw: float = 0.0) -> State:
    return State(vec3(position), vec3(velocity), Quat(np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)), ZERO)


def shaken(rng: np.random.Generator) -> TremorNoise:
    return TremorNoise(vec3(rng.normal(size=3)), vec3(rng.normal(size=3)))


@MODELS
@settings(max_examples=30)
@given(seed=seeds)
def test_force_and_couple_never_exceed_their_bounds(model, seed):
    rng = np.random.default_rng(seed)
    person, memory, _ = company(model, max_force=3.0, max_couple=0.5, tremor=2.0, grip=0.3, start_time=0.0)
    for k in range(10):
        state = random_state(rng)
        memory = memory._replace(view=person_view(person.grip, random_state(rng)))
        memory = memory._replace(place=LowPassState(vec3(rng.normal(size=3)), vec3(rng.normal(size=3))), begun=1.0)
        output, memory = person_step(person, memory, NO_PUSH, state, shaken(rng), k * DT, DT)
        push = output.start
        assert np.linalg.norm(array(push.force)) <= 3.0 * (1.0 + 1e-12)
        R = Rotation.from_quat(array(state.attitude), scalar_first=True).as_matrix()
        alone = np.cross(array(person.grip), R.T @ array(push.force))
        couple = array(push_moment(push, state.attitude)) - alone
        assert np.abs(couple).max() <= 0.5 * (1.0 + 1e-9)
        assert model == "two-hands" or np.abs(couple).max() < 1e-9
        assert output.start == output.middle == output.end


def test_the_hand_gets_to_its_place_as_through_two_equal_lags():
    """The transfer function 1/(τ s + 1)², whose step response SciPy computes."""
    person, memory, _ = company("hold", ((0.4, 0.0),), lag=0.1, tremor=0.0)
    start, end = memory.place.value.x, memory.leg.end.x
    places = []
    for k in range(1500):
        _, memory = person_step(person, memory, NO_PUSH, at(ZERO), CALM, k * DT, DT)
        places.append(memory.place.value.x)
    _, wanted, _ = lsim(lti([1.0], [0.01, 0.2, 1.0]), np.ones(1501), np.arange(1501) * DT)
    np.testing.assert_allclose((np.array(places) - start) / (end - start), wanted[1:], atol=1e-9)


def test_tremor_has_its_size_and_nine_tenths_of_its_power_between_8_and_12_hertz():
    """Of ten hands at once, after the first second."""
    k, memory, rows, rng = tremor(0.05, DT), STILL, [], np.random.default_rng(0)
    for _ in range(7000):
        noise = TremorNoise(*[Vec3(*rng.normal(size=(3, 10))) for _ in range(2)])
        memory = tremor_step(k, memory, noise)
        rows.append(memory.second)
    x = 0.05 * np.array(rows)[1000:]  # steps, axes, hands
    f, power = welch(x, fs=1.0 / DT, nperseg=4096, axis=0)
    power = power.mean(axis=2)
    share = power[(f >= 8.0) & (f <= 12.0)].sum(axis=0) / power.sum(axis=0)
    assert x.std(axis=(0, 2)) == pytest.approx([0.05] * 3, rel=0.1)
    assert share == pytest.approx([0.9] * 3, abs=0.04)
    assert np.abs(np.corrcoef(x.swapaxes(0, 1).reshape(3, -1)) - np.eye(3)).max() < 0.1


def test_a_hand_that_holds_still_is_a_spring_and_a_damper_whatever_is_seen():
    person, memory, _ = company("hold", ((0.0, 0.0),), stiffness=200.0, damping=15.0, tremor=0.0, max_force=999.0)
    for k in range(3000):
        _, memory = person_step(person, memory, NO_PUSH, at(ZERO), CALM, k * DT, DT)
    state = at((0.02, -0.01, 0.0), (0.1, 0.0, -0.2))
    seen = memory._replace(view=person_view(person.grip, at((3.0, 1.0, 0.0))))
    force = array(person_step(person, seen, NO_PUSH, state, CALM, 3.0, DT)[0].start.force)
    grip = array(person.grip) + array(state.position)
    assert force == pytest.approx(200.0 * (array(memory.leg.end) - grip) - 15.0 * array(state.velocity), abs=0.02)


def test_a_hand_moves_with_the_grip_until_the_vehicle_is_up_and_lets_go_at_the_end():
    person, memory, _ = company("steer", ((1.0, 0.0),), start_time=0.5, tremor=0.0, height_fraction=0.9)
    output, _ = person_step(person, memory, NO_PUSH, at((0.0, 0.0, 0.0)), CALM, 1.0, DT)
    assert array(output.start.force) == pytest.approx([0.0] * 3, abs=0.0)  # not up
    up = at((0.0, 0.0, 1.0))
    memory = memory._replace(
        view=person_view(person.grip, up), place=LowPassState(person_view(person.grip, up).grip, ZERO)
    )
    for k in range(1500):
        output, memory = person_step(person, memory, NO_PUSH, up, CALM, k * DT, DT)
        assert (array(output.start.force) != 0.0).any() == (k >= 500)
    assert output.start.force.x > 0.5
    assert landing_request(memory) == 0.0
    there = at((1.05, 0.0, 1.0))
    memory = memory._replace(view=person_view(person.grip, there))
    for k in range(2000):
        output, memory = person_step(person, memory, NO_PUSH, there, CALM, 2.0 + k * DT, DT)
    assert landing_request(memory) == 1.0
    assert np.abs(array(output.start.force)).max() < 1e-4


@pytest.mark.thorough
def test_the_path_is_gone_along_leg_by_leg_with_a_rest_where_it_is_asked_for():
    path = ((1.0, 0.0), {"point": [1.0, 2.0], "dwell": 0.5}, (3.0, 2.0))
    person, memory, legs = company("steer", path, tremor=0.0)
    assert [array(leg.start)[:2].tolist() for leg in legs] == [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]
    assert [leg.stops for leg in legs] == [0.0, 1.0, 1.0]
    since, z = {}, legs[0].end.z
    for k in range(6000):
        t = k * DT
        place = vec3([min(t, 1.0), np.clip(t - 1.0, 0.0, 2.0), z]) if t < 5.0 else Vec3(3.0, 2.0, z)
        if k % 16 == 0:
            memory = memory._replace(leg=legs[int(memory.index)])
        _, memory = person_step(person, memory, NO_PUSH, at(place), CALM, t, DT)
        since.setdefault(memory.index, t)
    assert list(since) == [0.0, 1.0, 2.0]
    assert since[1.0] == pytest.approx(0.5, abs=0.02)  # a corner is taken half a metre early
    assert since[2.0] == pytest.approx(2.7 + 0.5, abs=0.02)
    assert landing_request(memory) == 1.0


@pytest.mark.parametrize("turns", [0, 2, -1])
def test_two_hands_turn_the_vehicle_towards_its_heading_and_hold_it_at_the_centre(turns):
    leg = {"point": [0.0, 0.0], "heading": 0.3 + 2.0 * np.pi * turns, "dwell": 9.0}
    person, memory, _ = company("two-hands", (leg,), tremor=0.0, grip=0.7)
    assert array(person.grip)[1] == 0.0
    for k in range(2000):
        output, memory = person_step(person, memory, NO_PUSH, at((0.0, 0.0, memory.leg.end.z)), CALM, k * DT, DT)
    assert push_moment(output.start, LEVEL).z == pytest.approx(0.3 * person.settings.yaw_gain, abs=0.01)


@pytest.mark.thorough
def test_what_is_seen_late_is_reckoned_ahead():
    """A vehicle that moves and turns steadily is held by a hand that moves with the grip: no force but the wanted."""
    person, memory, _ = company("steer", ((100.0, 0.0),), tremor=0.0, grip=0.8, delay=0.2, speed=0.5)
    v, states = np.array([0.5, 0.0, 0.0]), []
    for k in range(4000):
        states.append(at(v * k * DT + [0.0, 0.0, memory.leg.end.z], v))
        seen = person_view(person.grip, states[max(k - 200, 0)])
        output, memory = person_step(person, memory._replace(view=seen), NO_PUSH, states[-1], CALM, k * DT, DT)
    assert np.abs(array(output.start.force)).max() < 0.02


def test_two_hands_turn_the_beam_as_a_spring_and_a_damper_about_the_vertical():
    """The couple K (ψ_leg − ψ) − D ψ̇ at the predicted heading; the heading of this leg is 0."""
    person, memory, legs = company("two-hands", ((5.0, 0.0),), tremor=0.0, max_couple=1e3)
    s, ahead = person.settings, person.arm.horizon
    assert legs[0].heading == 0.0
    for yaw, rate in ((0.1, 0.0), (-0.2, 0.4), (0.0, -0.5)):
        turning = at((0.0, 0.0, 1.0), yaw=yaw)._replace(rates=Vec3(0.0, 0.0, rate))
        couple = hand_target(person, memory._replace(view=person_view(person.grip, turning), leg=legs[0])).couple
        assert couple == pytest.approx(-s.yaw_gain * (yaw + rate * ahead) - s.yaw_damping * rate, rel=1e-12)
    assert s.yaw_damping * 0.4 > 0.05


@pytest.mark.parametrize("grip", [1.0, -1.0])
def test_behind_a_hand_that_goes_straight_the_centre_follows_a_tractrix(grip):
    """The grip is led along x from a heading across it; the lag angle obeys dθ/ds = −sin θ / a, here by SciPy."""
    a, steps = abs(grip), np.arange(0.0, 4.0, 0.001)
    grips = np.column_stack([steps, np.zeros(len(steps))])
    places = trailing(grips, grip, 0.3 if grip > 0.0 else 0.3 - np.pi)
    away = grips[0] - places.centres[0]
    start = np.arctan2(away[1], away[0])
    lag = solve_ivp(lambda s, y: -np.sin(y) / a, (0.0, 4.0), [start], t_eval=steps, rtol=1e-9, atol=1e-12).y[0]
    expected = grips - a * np.column_stack([np.cos(lag), np.sin(lag)])
    assert np.linalg.norm(places.centres - grips, axis=1) == pytest.approx(a)
    assert places.centres == pytest.approx(expected, abs=2e-3)
    body_y = np.column_stack([-np.sin(places.headings), np.cos(places.headings)])
    assert places.centres + grip * body_y == pytest.approx(grips, abs=1e-9)
    assert trailing(grips, 0.0, 0.0) is None  # a hand at the centre leaves the heading open


def test_a_heading_is_kept_and_another_is_reached_the_short_way_at_a_limited_rate():
    assert turning(np.full(20, 0.8), 0.5) == pytest.approx(np.full(20, 0.8))
    most = TURNING * APART / 0.5
    found = turning(np.concatenate([[3.0], np.full(60, -3.0)]), 0.5)  # across ±π
    assert np.diff(found).max() == pytest.approx(most)
    assert np.diff(found).min() >= -1e-12
    assert found[-1] == pytest.approx(2.0 * np.pi - 3.0)


VIEW = PersonView(Vec3(1.0, 2.0, 3.0), Vec3(0.1, 0.2, 0.3), Vec3(4.0, 5.0, 6.0), Vec3(0.4, 0.5, 0.6), 0.0, 0.0)
LEG = PathLeg(ZERO, Vec3(8.0, 0.0, 0.0), *[0.0] * (len(PathLeg._fields) - 2))
FOLLOWING = PathFollowing(**dict.fromkeys(PathFollowing._fields, 0.0))._replace(
    speed=0.5, gain=6.0, look_ahead=1.0, approach_gain=1.0
)


@pytest.mark.parametrize(
    ("at_grip", "place", "velocity"), [(1.0, VIEW.grip, VIEW.grip_velocity), (0.0, VIEW.position, VIEW.velocity)]
)
def test_the_grip_is_guided_or_the_centre_of_mass(at_grip, place, velocity):
    found = guided_point(PersonSettings(at_grip, 0.0, 0.0, 0.0), VIEW)
    assert found == (place, velocity)


def test_the_force_is_the_missing_speed_towards_a_place_ahead_on_the_leg_and_more_where_little_moves_nothing():
    """From beside the leg, at rest: along the line to the place `look_ahead` farther on the leg."""
    place = Vec3(2.0, 1.0, 0.0)
    aim = np.array([3.0, 0.0, 0.0]) - np.array(place)
    expected = 6.0 * 0.5 * aim / np.linalg.norm(aim)
    assert np.array(pursue(FOLLOWING, LEG, place, ZERO)) == pytest.approx(expected)
    more = np.array(pursue(FOLLOWING._replace(breakaway_force=0.4), LEG, place, ZERO))
    size, extra = np.linalg.norm(expected), 0.4
    assert np.cross(more, expected) == pytest.approx([0.0] * 3, abs=1e-12)
    assert np.linalg.norm(more) == pytest.approx(size * (1.0 + extra / np.hypot(size, extra)))


@pytest.mark.parametrize(("speed", "asks"), [(0.19, True), (0.21, False)])
def test_at_the_end_of_the_path_a_landing_is_asked_for_once_the_vehicle_is_slow(speed, asks):
    person, memory, legs = company("steer", ((1.0, 0.0),), tremor=0.0)
    slow = person._replace(following=person.following._replace(landing_speed=0.2))
    there = at((*np.array(legs[0].end)[:2], 1.0), velocity=(0.0, 0.6 * speed, 0.8 * speed))
    memory = memory._replace(leg=legs[0])
    for k in range(2000):
        view = person_view(slow.grip, there)._replace(grip_velocity=ZERO)
        _, memory = person_step(slow, memory._replace(view=view), NO_PUSH, there, CALM, k * DT, DT)
    assert landing_request(memory) == float(asks)


def test_the_trim_is_the_integral_of_the_wanted_force_across_the_path():
    person, memory, legs = company("steer", ((9.0, 0.0),), tremor=0.0, max_force=50.0)
    beside = at((1.0, 0.3, 1.0))
    memory = memory._replace(leg=legs[0], view=person_view(person.grip, beside), begun=1.0)
    across = hand_target(person, memory).across
    for k in range(400):
        _, memory = person_step(person, memory, NO_PUSH, beside, CALM, k * DT, DT)
    assert across.y < -0.1
    assert memory.trim.x == pytest.approx(0.0, abs=1e-12)
    assert memory.trim.y == pytest.approx(across.y * person.following.trim_rate * 400 * DT, rel=0.01)
