"""Many missions from one template: each is what `load_mission` gives, errors included."""

import functools
import random
import warnings
from dataclasses import replace

import pytest

from tandemlift.core.errors import InputError
from tandemlift.missions import MissionTemplate, load_mission, tables_of
from tandemlift.parts.controllers import CONTROLLERS

VALUES = (0.3, 1, 2.5, 0.0, -1.0, float("nan"), True, "soft", "lqr", [1.0, 0.0, 0.2], [1], [[1.0, 1.0]], {}, None, 1e12)
KEYS = (  # good ones, and some that no mission has
    *("mission.duration", "mission.step", "mission.seed", "mission.name", "mission.fma", "mission"),
    *("vehicle.payload.mass", "vehicle.payload", "vehicle.quadrotors.0.mass", "vehicle.quadrotors.1.arm"),
    *("vehicle.quadrotors.7.mass", "vehicle.quadrotors.0", "allocation.weights", "plant.mass_scale"),
    *("controller.name", "controller", "controller.gains", "controller.gains.xi", "controller.gains.no_such"),
    *("admittance.mass", "admittance.threshold", "admittance.feel", "admittance.feel.speed", "admittance.gate"),
    *("pushes", "pushes.0.force", "pushes.0", "pushes.1.force.2", "pushes.4.time", "initial.position", "initial.euler"),
    *("wind.model", "wind.mean", "ground.model", "ground.sinkage", "phases.land_start", "requests", "walls"),
    *("compliance.hearing", "partner", "partner.start", "person.start_time", "changes", "nothing", "a..b", ""),
)
FEEL = {"admittance.feel": {"force": 1.0, "speed": 0.6, "time": 0.5}}
LATER = {"changes": [{"time": 1.0, "key": "admittance.mass", "value": 2.0}]}


def drawn(chance, most):
    keys = chance.sample(KEYS, chance.randint(0, most))
    return {key: chance.choice((chance.choice(VALUES), chance.uniform(0.5, 2.0))) for key in keys}


def given_by(make):
    """The mission's class and tables, or the text of the refusal; and the warnings of what may fly badly."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            mission = make()
            result = mission, type(mission.controller), repr(tables_of(mission))
        except InputError as error:
            result = str(error)
    return result, {str(w.message) for w in caught}


@pytest.mark.parametrize("name", ["paper", "iris", "zigzag"])
def test_a_template_gives_what_load_mission_gives_and_refuses_what_it_refuses(name):
    chance = random.Random(name)
    flown = refused = 0
    for _ in range(6):
        common = chance.choice(({}, FEEL, LATER, drawn(chance, 2)))
        template = functools.cache(functools.partial(MissionTemplate.read, name, common, quiet=True))
        for most in (1, 1, 1, 2, 3, 6):
            changes = drawn(chance, most)
            made, _ = given_by(lambda t=template, c=changes: t().mission(c))
            expected, _ = given_by(lambda c={**common, **changes}: load_mission(name, c))
            assert made == expected, (common, changes)
            flown, refused = flown + isinstance(made, tuple), refused + isinstance(made, str)
    assert flown > 5
    assert refused > 5


def test_a_template_warns_as_load_mission_does_unless_it_is_quiet():
    changes = {"phases.land_start": 1.0, "phases.height": 2.0}
    expected, said = given_by(lambda: load_mission("one-push", changes))
    assert said
    assert given_by(lambda: MissionTemplate.read("one-push").mission(changes)) == (expected, said)
    assert given_by(lambda: MissionTemplate.read("one-push", quiet=True).mission(changes)) == (expected, set())


def test_a_template_flies_another_controller_with_the_settings_that_the_mission_has_for_it():
    for controller in ("pid", CONTROLLERS["lqr"]):
        template = MissionTemplate.read("paper", controller=controller)
        changes = {"admittance.mass": 2.0}
        assert template.mission(changes) == load_mission("paper", changes, controller=controller)


@pytest.mark.parametrize("name", ["iris", "zigzag"])
def test_a_template_of_a_mission_changes_it_without_its_changes_in_flight_and_does_not_warn(name):
    template = MissionTemplate.of(load_mission(name, LATER))
    for changes in (
        {},
        {"admittance.mass": 2.0},
        {"plant.mass_scale": 1.1, "sensors.delay": 0.004},
        {"plant.mass": 1.0},
    ):
        expected, _ = given_by(lambda c=changes: load_mission(name, c))
        made, said = given_by(lambda c=changes: template.mission(c))
        assert made == (expected.replace(name, "mission") if isinstance(expected, str) else expected)
        assert not said


def test_changes_do_not_reach_the_next_mission():
    weights = [1.0, 2.0, 2.0, 1.0]
    template = MissionTemplate.read("paper", {"allocation.weights": weights})
    before = template.mission({})
    weights[0] = 9.0
    template.mission({"allocation.weights": 3.0})
    assert template.mission({}) == before


def test_a_controller_that_is_registered_anew_gets_its_new_settings(monkeypatch):
    class Stricter(CONTROLLERS["pid"].settings):
        pass

    template = MissionTemplate.read("paper", controller="pid")
    monkeypatch.setitem(CONTROLLERS, "pid", replace(CONTROLLERS["pid"], settings=Stricter))
    assert type(template.mission({}).controller) is Stricter
