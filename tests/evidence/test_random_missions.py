"""Missions at random, and the judge of their outcomes, who must be able to say no."""

import ast
import sys
from pathlib import Path

import judge
import numpy as np
import pytest
from judge.model import GRAVITY, body_of, corridor_walls
from judge.verdict import is_rough
from judge.verdict import judge as judged_record
from mission_schema import SCHEMA
from random_missions.generate import FIXED, LISTS, UNPUSHED, RandomMission, drawable_keys, random_family, shortened
from random_missions.judged import judged

import tandemlift as tl
from tandemlift.missions import tables_of
from tandemlift.parts.contact.corridor import CorridorTable
from tandemlift.parts.mechanics.vehicle import Vehicle

FAMILIES = range(2)  # three missions each; `make random-missions` flies a thousand


def drawn(base, changes):
    """A mission as if it were drawn, whatever the keys are that may be drawn."""
    changes = {**shortened(base), **changes}
    return RandomMission(0, 0, base, changes, tl.load_mission(base, changes), ())


@pytest.fixture(scope="module")
def pushed():
    """A flight with a sample for every step."""
    return tl.fly(tl.load_mission("one-push", {**shortened("one-push", 8.0), "mission.log_interval": 0.001}))


@pytest.mark.thorough
@pytest.mark.parametrize("family", FAMILIES)
def test_missions_at_random_end_as_the_judge_says(family):
    rows = [judged(drawn) for drawn in random_family(16, family, 3)]
    assert len(rows) == 3
    wrong = [f"{r.family}/{r.member} {r.base}: {r.verdict} {r.changes}" for r in rows if not r.confirmed]
    assert wrong == []


@pytest.mark.thorough
def test_where_nobody_pushes_no_mission_at_random_moves_a_metre():
    rows = [judged(drawn) for drawn in random_family(16, UNPUSHED, 2)]
    assert [f"{r.family}/{r.member} {r.base}: {r.verdict} {r.changes}" for r in rows if not r.confirmed] == []


@pytest.mark.thorough
def test_the_judge_says_no_where_a_vehicle_follows_nobody():
    unpushed = next(d for d in random_family(16, UNPUSHED, 12) if "sensor_faults" in d.changes)
    fault = {"sensor": "joints", "kind": "bias", "time": 5.0, "size": [1.0] * 3}
    credulous = {"pushes": [], "sensor_faults": [fault], "estimator.confirmation": "none"}
    mission = tl.load_mission("iris", {**shortened("iris", 16.0), **credulous})
    assert judged(unpushed._replace(mission=mission)).verdict.endswith("and nobody pushed")


def test_the_judge_shares_no_code_with_the_package():
    imported = set()
    for file in Path(judge.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.Import):
                imported |= {alias.name.partition(".")[0] for alias in node.names}
            if isinstance(node, ast.ImportFrom):
                imported.add(node.module.partition(".")[0])
    assert imported - set(sys.stdlib_module_names) == {"judge", "mujoco", "numpy"}


@pytest.mark.parametrize("name", ["iris", "four"])
def test_the_judge_weighs_the_vehicle_as_the_package_does(name):
    payload = {"vehicle.payload.center_of_mass": [0.02, 0.1, -0.03]}
    payload |= {} if name == "four" else {"vehicle.payload.products": [0.0, 1e-4, 0.0]}  # a thin plate has none
    mission = tl.load_mission(name, {**payload, "plant.mass_scale": 1.2, "plant.inertia_scale": [1.1, 0.9, 1.3]})
    body, vehicle = body_of(tables_of(mission)), Vehicle.from_settings(mission.vehicle)
    scale = np.sqrt([1.1, 0.9, 1.3])
    assert body.mass == pytest.approx(1.2 * vehicle.mass, rel=1e-12)
    np.testing.assert_allclose(body.inertia, vehicle.inertia * np.outer(scale, scale), rtol=1e-12, atol=1e-15)


def test_the_judge_builds_the_corridors_walls_where_the_package_does():
    corridor = tl.load_mission("zigzag", {"corridor.ends": "closed"}).corridor
    ours = [[*w.start, *w.end, w.top] for w in CorridorTable.model_validate(corridor).walls]
    its = [[*w["start"], *w["end"], w["top"]] for w in corridor_walls(corridor.model_dump(mode="json"))]
    np.testing.assert_allclose(sorted(its), sorted(ours), atol=1e-12)


def test_mujoco_flies_a_flight_again_to_a_micrometre_for_its_whole_length(pushed):
    verdict = judged_record(pushed.mission, pushed.time, pushed.channels)
    apart = verdict.followed.position[:-1] - pushed["position"]
    assert verdict.outcome == pushed.outcome == "flying"
    assert verdict.followed.restarts == []
    assert np.abs(apart).max() < 1e-6


def test_the_judge_does_not_follow_a_record_whose_commands_are_false_or_a_body_of_another_mass(pushed):
    for channel, factor in (("rotor_thrusts", 1.002), ("push_force", 1.05)):
        channels = {**pushed.channels, channel: pushed[channel] * factor}
        assert judged_record(pushed.mission, pushed.time, channels).unexplained, channel
    mission = {**pushed.mission, "plant": {"mass_scale": 1.003, "inertia_scale": [1.0, 1.0, 1.0]}}
    assert judged_record(mission, pushed.time, pushed.channels).unexplained


def test_the_judge_sees_energy_that_contact_adds():
    mission, time = tables_of(tl.load_mission("iris", shortened("iris"))), np.arange(2000) * 0.001
    body = body_of(mission)
    height, speed = np.full(2000, 1.0), np.zeros(2000)
    speed[1000:] = 1.0 - GRAVITY * (time[1000:] - time[1000])  # thrown up by nothing
    height[:1000] -= 0.5 * GRAVITY * (time[:1000] - time[1000]) ** 2 - 0.0
    speed[:1000] = -GRAVITY * (time[:1000] - time[1000])
    height[1000:] += np.cumsum(speed[1000:]) * 0.001
    zero, still = np.zeros((2000, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (2000, 1))
    channels = {
        "position": np.column_stack([zero[:, :2], height]),
        "velocity": np.column_stack([zero[:, :2], speed]),
        "attitude": still,
        "rates": zero,
        "rotor_thrusts": np.zeros((2000, 8)),
        "push_force": zero,
        "push_moment": zero,
    }
    verdict = judged_record(mission, time, channels)
    assert verdict.gained == pytest.approx(0.5 * body.mass, rel=0.03)


def test_the_judge_sees_the_floor_bear_the_vehicle_in_the_last_sample():
    row = judged(
        drawn("zigzag", {"person.path": [{"point": [1.0, 0.0]}], "vehicle.quadrotors.1.rotor_height": -0.1476})
    )
    assert row.outcome == row.judged == "landed"
    assert row.confirmed


LIGHT = {
    "phases.lift_start": 0.05237,
    "observer.moment_bandwidth": 10.24,
    "actuators.delay": 0.00736,
    "plant.mass_scale": 0.1816,
    "controller.gains.lambda_1": [0.2476, 0.09415, 235.5, 26.23, 29.88, 48.1],
    "vehicle.quadrotors.0.joint": [-0.1349, 1.326, -0.2119],
}


@pytest.mark.parametrize(("place", "changes", "steps"), [(0.0114, LIGHT, True), (0.03772, {}, False)])
def test_the_judge_does_not_decide_what_steps_do_not_resolve_and_no_more_than_that(place, changes, steps):
    beside = {"initial.position": [place] * 3, "ground.model": "floor", "phases.rotors": "flight"}
    row = judged(drawn("one-push", beside | changes))
    assert row.confirmed
    assert ("steps" in row.close) is steps


@pytest.mark.parametrize("blow", [3.0, 10.0])  # m/s, within five steps
def test_a_blow_is_resolved_and_a_chatter_is_not(blow):
    time = np.arange(300) * 0.001
    zero = np.zeros((300, 3))
    struck, shaken = zero.copy(), zero.copy()
    struck[:, 2] = np.interp(time, [0.29, 0.295], [-blow, 0.2 * blow])
    shaken[:, 1] = np.where(np.arange(300) % 2, 0.3, -0.3)
    for fast, rough in ((struck, False), (shaken, True)):
        assert is_rough({"velocity": fast, "rates": zero}, 0.001) is rough
    assert is_rough({"velocity": zero, "rates": shaken}, 0.001)


def test_every_key_of_the_schema_may_be_drawn():
    everything = {
        name.replace(".0", "") for base in ("gusts", "doorway", "rotor-loss", "zigzag") for name in drawable_keys(base)
    }
    inside = {key for key in SCHEMA if not key.replace(".0", "").startswith((*FIXED, *LISTS))}
    assert {key.replace(".0", "") for key in inside} - everything == set()
