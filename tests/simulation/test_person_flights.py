"""Missions led by hand: through without touching and landed, the same however they are flown, in both engines."""

from typing import Any

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import vec3
from tandemlift.missions import built_in
from tandemlift.parts.person.person import PersonView
from tandemlift.pictures.drawing.clearances import clearances
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import leaf_offset
from tandemlift.simulation.stepping import Stepper

LEAST = {"zigzag": 0.4, "narrow": 0.3, "narrow-zigzag": 0.1, "doorway": 0.05}  # m
SHORT = {"mission.duration": 9.5, "person.start_time": 4.0, "estimator.tare_start": 3.0, "estimator.tare_duration": 0.9}


def persons(count: int, **changes: Any) -> list[tl.Mission]:
    """Missions through the zigzag with persons unlike in all that may differ within one compiled loop."""
    rng = np.random.default_rng(7)
    return [
        tl.load_mission(
            "zigzag",
            {
                "mission.seed": i,
                "mission.duration": 90.0,
                "disturbance.force": [*rng.uniform(-0.7, 0.7, 2).tolist(), 0.0],
                "person.grip": rng.uniform(-1.0, 1.0),
                **{f"person.{k}": v * rng.uniform(0.7, 1.3) for k, v in {"gain": 4.0, "stiffness": 10.0}.items()},
                "person.path": [{"point": p} for p in LINE[i % 2 :]],
                **changes,
            },
        )
        for i in range(count)
    ]


LINE = tl.load_mission("zigzag").corridor.centreline


@pytest.fixture(scope="module")
def flown():
    return {name: tl.fly(tl.load_mission(name)) for name in LEAST}


def assert_through_and_landed(metrics: dict[str, Any], mission: tl.Mission) -> None:
    end = [w.point for w in mission.person.path] or list(mission.corridor.centreline)
    x, y, z = metrics["final_position_m"]
    assert metrics["wall_contact"] is False
    assert np.hypot(x - end[-1][0], y - end[-1][1]) < 0.6 + (mission.person.model == "pull")  # led by its end
    assert z == pytest.approx(mission.initial.position[2], abs=0.01)


def test_every_built_in_mission_with_a_person_is_flown():
    assert set(LEAST) == {name for name in built_in() if tl.load_mission(name).person.model != "none"}


@pytest.mark.parametrize("name", LEAST)
def test_a_person_brings_the_vehicle_through_without_touching_and_it_lands(flown, name):
    flight, mission = flown[name], tl.load_mission(name)
    metrics = flight.metrics()
    assert flight.ending is None
    assert metrics["clearance_min_m"] > LEAST[name]
    assert_through_and_landed(metrics, mission)
    assert flight["phase"].ravel()[-1] == 0.0  # idle again, rotors off
    assert np.abs(flight["push_force"]).max() < mission.person.max_force
    assert np.abs(flight["contact_force"][(flight.time > 2.0) & (flight["position"][:, 2] > 0.1)]).max() == 0.0


@pytest.mark.parametrize("name", LEAST)
def test_metrics_of_walls_and_persons_are_those_of_the_log(flown, name):
    flight, metrics = flown[name], flown[name].metrics()
    far, push = clearances(flight), flight["push_force"]
    assert metrics["clearance_min_m"] == pytest.approx(min(far.guards.min(), far.beam.min()), abs=0.002)
    held = (np.linalg.norm(push, axis=1) > 1e-9) & (flight["phase"].ravel() == 2.0)
    assert metrics["human_force_mean_n"] == pytest.approx(np.linalg.norm(push[held], axis=1).mean(), rel=0.02)
    way = np.linalg.norm(np.diff(flight["position"], axis=0), axis=1)
    assert metrics["human_path_m"] == pytest.approx(way[held[1:]].sum(), rel=0.02)
    assert metrics["human_work_per_path_j_m"] == pytest.approx(metrics["human_work_j"] / metrics["human_path_m"])


@pytest.mark.thorough
def test_any_of_a_handful_of_random_persons_gets_through():
    missions = persons(8)
    for metrics, mission in zip(tl.fly_many(missions, keep="metrics"), missions, strict=True):
        assert_through_and_landed(metrics, mission)


def test_what_a_person_sees_is_what_was_exactly_their_delay_ago():
    mission = persons(1, **SHORT)[0]
    p = FlightPlan(mission)
    stepper, span = Stepper(p), leaf_offset(p.model, "flight_state", "person", "view")
    at = span.at + leaf_offset(PersonView(*[vec3([0.0] * 3)] * 4, 0.0, 0.0), "position").at
    was, seen = [], []
    for k in range(1500):
        was.append(stepper.a[:3].copy())
        seen.append(stepper.a[at : at + 3].copy())
        stepper.step(k)
    late = round(mission.person.delay / mission.mission.step)
    assert late == 200
    assert np.ptp(np.array(was)[:, 2]) > 0.05
    assert np.array_equal(seen[late:], was[:-late])
    assert np.array_equal(seen[:late], [was[0]] * late)
