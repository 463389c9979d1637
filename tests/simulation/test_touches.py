"""The record of touches: of a flight alone, in a block, in parts and in MuJoCo; struck rotors give no thrust."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from ten_crashes import HELD, THROWN, crash_mission, crashed_in

import tandemlift as tl
from tandemlift.core.vector import Vec3, each
from tandemlift.parts.contact.touches import (
    UNTOUCHED,
    PartContacts,
    record_after,
)

ON_ITS_BACK = THROWN | {"initial.euler": [0.3, 1.4, 0.5], "initial.rates": [0.8, 3.0, 0.0], "mission.name": "crash"}


def contacts(normals: list[float], places: Any = None) -> PartContacts:
    cls, rows = each(len(normals)), np.zeros((len(normals), 3)) if places is None else np.array(places)
    return PartContacts(cls(*normals), Vec3(*[cls(*map(float, column)) for column in rows.T]))


def test_a_record_keeps_the_first_touch_the_greatest_force_and_the_impulse():
    r = record_after(contacts([0.0, 0.0, 0.0]), UNTOUCHED, 0.5, 0.01)
    assert r == UNTOUCHED
    r = record_after(contacts([0.0, 2.0, 5.0], [[0, 0, 0], [1, 0, 0], [2, 3, 4]]), r, 1.0, 0.01)
    assert (r.time, r.part, tuple(r.place)) == (1.0, 3.0, (2.0, 3.0, 4.0))  # the hardest of those that touch at once
    r = record_after(contacts([20.0, 0.0, 0.0], [[9, 9, 9]] * 3), r, 1.01, 0.01)
    assert (r.time, r.part, tuple(r.place)) == (1.0, 3.0, (2.0, 3.0, 4.0))
    assert (r.force, r.impulse) == (20.0, pytest.approx(0.27))


def test_the_impulse_of_the_record_is_the_momentum_that_the_floor_gives():
    crash = crashed_in("compiled", tl.load_mission("iris", ON_ITS_BACK | {"mission.log_interval": 0.001}))
    flight = crash.flight
    vertical = flight["contact_force"][:, 2].sum() * 0.001
    assert sum(touch.impulse for touch in crash.touches) == pytest.approx(vertical, rel=0.05)  # feet never touch


@pytest.mark.parametrize("engine", ["compiled", "mujoco"])
def test_a_struck_rotor_gives_no_thrust_from_then_on(engine):
    if engine == "mujoco":
        pytest.importorskip("mujoco")
    mission = crash_mission("flown into a wall with one rotor")
    crash = crashed_in(engine, mission)
    struck = crash.touches[0]
    thrusts, time = crash.flight["rotor_thrusts"], crash.flight.time
    assert struck.part == "rotor 3 of quadrotor 1"
    assert (thrusts[time > struck.time + 0.002, 2] == 0.0).all()
    assert (thrusts[time < struck.time, 2] > 0.0).all()
    others = [i for i in range(8) if i != 2]
    soon = (time > struck.time + 0.002) & (time < struck.time + 0.02)
    assert (thrusts[soon][:, others] > 0.0).any(axis=1).all()  # the others go on


@pytest.mark.thorough
def test_ideal_rotors_stop_too():
    wall = {"walls": [{"start": [0.62, 0.7], "end": [0.52, 2.0], "top": 9.0}], "vehicle.quadrotors.0.guard_radius": 0.2}
    ideal = {"actuators.model": "ideal", "allocation.method": "pseudo-inverse"}
    ideal |= {"ground.effect": False, "observer.model": "none"}
    mission = tl.load_mission(
        "iris", HELD | wall | ideal | {"initial.velocity": [3.0, 0.0, 0.0], "mission.duration": 1.0}
    )
    crash = crashed_in("compiled", mission)
    assert crash.touches[0].part == "rotor 3 of quadrotor 1"
    assert crash.flight["rotor_thrusts"][-1, 2] == 0.0
