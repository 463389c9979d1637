"""Parameters that are set and restored in flight, and rotors that are stopped."""

import pytest
from sessions import fly, say, seen

import tandemlift as tl
from tandemlift.apps.live.session.interactive_mission import NEVER, interactive_mission, with_whole_rotors
from tandemlift.apps.live.session.parameters import BY_KEY, parameters_of
from tandemlift.missions import changed, tables_of


def test_a_setting_changes_for_good_and_comes_back_to_what_the_mission_says(session):
    before = list(session._mission.admittance.mass)
    (answer,) = say(session, "set", key="admittance.mass", value=5.0)
    assert answer["value"] == [5.0, 5.0, 5.0]
    assert session.flight.now.admittance.mass == (5.0, 5.0, 5.0)
    say(session, "set", key="wind.velocity", value=(1.0, 0.0, 0.0))
    fly(session, 1.0)
    assert seen(session)["wind"][0] == pytest.approx(1.0, abs=0.05)
    told = say(session, "restore")
    assert [t["type"] for t in told] == ["changed"] * 2
    assert {t["key"] for t in told} == {"admittance.mass", "wind.velocity"}
    assert list(session.flight.now.admittance.mass) == before


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("admittance.mass", 1e9, "admittance.mass = 1000000000.0: must be from 0.3 to 20"),
        ("admittance.mass", True, "must be a number"),
        ("admittance.mass", (1.0, 2.0), "admittance.mass"),
        ("mission.step", 0.01, "is not a parameter that can be changed in flight"),
        ("controller.name", "none", "unknown controller"),
        ("sensors.joints.force_noise", 0.1, "sensors.joints.force_noise"),
    ],
)
def test_what_cannot_be_changed_is_refused_with_a_reason_and_the_flight_goes_on(session, key, value, words):
    now = session.flight.now
    with pytest.raises(tl.InputError) as refused:
        say(session, "set", key=key, value=value)
    assert words in str(refused.value)
    assert session.flight.now is now
    fly(session, 0.1)


def test_a_control_may_be_set_to_what_the_mission_says_though_it_is_beyond_its_bounds():
    paper = tables_of(interactive_mission(tl.load_mission("paper")))
    xi = next(c for c in parameters_of(paper, paper) if c["key"] == "controller.gains.xi")
    assert xi["min"] <= min(xi["value"])
    assert xi["max"] >= max(xi["value"])
    assert xi["max"] > BY_KEY["controller.gains.xi"].high


OWN = """
import tandemlift.parts.controllers as tc
from tandemlift.core.keys import Fraction, Positive3, key

class Settings(tc.CascadeTable):
    bandwidth: Positive3 = key(2.0, "rad/s", "of the position loop")
    share: Fraction = key(0.5, None, "of something")
    shift: float = key(0.0, "m", "of something")
    words: str = key("a", None, "no number")

@tc.register("own-numbers", Settings)
def start(settings, vehicle, step):
    return tc.controller_model(settings, vehicle, step), tc.LEVEL
"""


def test_the_numbers_of_a_users_controller_are_settings_within_its_bounds_and_ten_times_their_value(tmp_path):
    (tmp_path / "own.py").write_text(OWN)
    tables = tables_of(tl.load_mission("hover", controller=str(tmp_path / "own.py")))
    own = [one for one in parameters_of(tables, tables) if one["group"] == "controller" and "min" in one]
    assert [(one["key"], one["unit"], one["min"], one["max"]) for one in own] == [
        ("controller.bandwidth", "rad/s", 0.2, 20.0),
        ("controller.share", "", 0.05, 1.0),
        ("controller.shift", "m", -10.0, 10.0),
    ]


def test_a_rotor_that_cannot_fail_is_not_killed(session):
    with pytest.raises(tl.InputError, match="rotor 4: the rotors of this mission cannot fail"):
        say(session, "kill", rotor=3)


@pytest.mark.thorough
def test_another_controller_takes_over_at_once(session):
    fly(session, 3.0)
    say(session, "set", key="controller.name", value="pid")
    fly(session, 1.0)
    assert session.flight.now.controller.name == "pid"
    told = say(session, "restore", key="controller.name")
    assert [t["type"] for t in told] == ["changed", "scene"]
    assert session.flight.now.controller == session._mission.controller, "with the mission's own settings"
    fly(session, 1.0)
    assert not session.flight.lost


def test_a_reset_begins_again_with_the_settings_as_they_are(session):
    say(session, "set", key="admittance.mass", value=5.0)
    fly(session, 1.0)
    generation = session.generation
    say(session, "reset")
    assert session.generation == generation + 1
    assert session.status()["recorded_s"] < 0.01
    assert session.flight.now.admittance.mass == (5.0, 5.0, 5.0)
    control = next(c for c in session.scene["parameters"] if c["key"] == "admittance.mass")
    assert list(control["value"]) == [5.0, 5.0, 5.0]


def test_after_a_reset_rotors_that_had_failed_are_whole():
    first = interactive_mission(tl.load_mission("iris"))
    now = changed(changed(first, "faults.3.time", 2.5), "admittance.mass", 5.0)
    again = with_whole_rotors(now, first)
    assert [f.time for f in again.faults] == [NEVER] * 8
    assert again.admittance.mass == (5.0, 5.0, 5.0)


def test_the_status_tells_every_viewer_which_rotors_are_dead(session):
    assert session.status()["failed_rotors"] == []
    session.flight.now = changed(interactive_mission(tl.load_mission("iris")), "faults.3.time", 0.0)
    assert session.status()["failed_rotors"] == [3]
