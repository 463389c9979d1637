"""What a person does slowly: the trim against a steady wind, and the request to land once the vehicle is slow."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.vector import ZERO, Quat, mat3, vec3
from tandemlift.engines.compiled import start_state
from tandemlift.parts.interaction.person import hand_target, landing_request, person_step, person_view
from tandemlift.parts.interaction.person_table import Walk, path_legs_from, start_person
from tandemlift.parts.interaction.tremor import TremorNoise
from tandemlift.parts.mechanics.push import PointPush, PushSamples
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle

DT = 0.001
NO_PUSH = PushSamples(*[PointPush(ZERO, mat3([[0.0] * 3] * 3))] * 3)
CALM = TremorNoise(ZERO, ZERO)


def company(path, **changes):
    """A person who steers, their memory and the legs of their path, beside a vehicle that stands at 0."""
    keys = {"model": "steer", "path": [{"point": list(p)} for p in path], "height_fraction": 0.0, "tremor": 0.0}
    mission = tl.load_mission("hover", {f"person.{k}": v for k, v in {**keys, "start_time": 0.0, **changes}.items()})
    vehicle, state = Vehicle.from_settings(mission.vehicle), start_state(mission)
    walk = Walk(mission.person.path, state, mission.initial.euler[2], mission.phases.height)
    person, memory, _ = start_person(mission.person, vehicle, mission.mission.step, walk)
    return person, memory, path_legs_from(mission.person, person, walk)


def at(position, velocity=(0.0, 0.0, 0.0)):
    return State(vec3(position), vec3(velocity), Quat(1.0, 0.0, 0.0, 0.0), ZERO)


@pytest.mark.parametrize(("speed", "asks"), [(0.19, True), (0.21, False)])
def test_at_the_end_of_the_path_a_landing_is_asked_for_once_the_vehicle_is_slow(speed, asks):
    person, memory, legs = company(((1.0, 0.0),))
    slow = person._replace(following=person.following._replace(landing_speed=0.2))
    there = at((*np.array(legs[0].end)[:2], 1.0), velocity=(0.0, 0.6 * speed, 0.8 * speed))
    memory = memory._replace(leg=legs[0])
    for k in range(2000):
        view = person_view(slow.grip, there)._replace(grip_velocity=ZERO)
        memory = person_step(slow, memory._replace(view=view), NO_PUSH, there, CALM, k * DT, DT).memory
    assert landing_request(memory) == float(asks)


def test_the_trim_is_the_integral_of_the_wanted_force_across_the_path():
    person, memory, legs = company(((9.0, 0.0),), max_force=50.0)
    beside = at((1.0, 0.3, 1.0))
    memory = memory._replace(leg=legs[0], view=person_view(person.grip, beside), begun=1.0)
    across = hand_target(person, memory).across
    for k in range(400):
        memory = person_step(person, memory, NO_PUSH, beside, CALM, k * DT, DT).memory
    assert across.y < -0.1
    assert memory.trim.x == pytest.approx(0.0, abs=1e-12)
    assert memory.trim.y == pytest.approx(across.y * person.following.trim_rate * 400 * DT, rel=0.01)
