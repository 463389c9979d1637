"""`[admittance.feel]`: its presets and numbers become mass and damping, in files, in flight and for other machines."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.missions import changed, check, tables_of
from tandemlift.parts.guidance.admittance import FEELS
from tandemlift.simulation.caller_values import portable_mission


def admittance(changes, name="iris"):
    return tl.load_mission(name, changes).admittance


@pytest.mark.parametrize("preset", FEELS)
def test_a_preset_gives_mass_and_damping_of_its_numbers(preset):
    force, speed, time = FEELS[preset]
    a = admittance({"admittance.feel.preset": preset})
    assert a.damping == pytest.approx([(force - 0.3) / speed] * 3)
    v = speed * (1.0 - np.exp(-np.array(a.damping) / np.array(a.mass) * time))
    assert v == pytest.approx(0.95 * speed)


def test_what_is_given_beside_a_preset_counts_and_may_differ_between_axes():
    a = admittance({"admittance.feel": {"preset": "firm", "speed": [0.6, 0.3, 0.2], "time": 2}})
    assert [f.force for f in a.feel.axes] == [FEELS["firm"].force] * 3
    assert a.damping == pytest.approx([1.7 / 0.6, 1.7 / 0.3, 1.7 / 0.2])
    assert np.array(a.mass) / a.damping == pytest.approx([2.0 / np.log(20.0)] * 3)


@pytest.mark.parametrize(
    ("changes", "beyond"),
    [({}, 1.0), ({"admittance.gate": "soft"}, 0.7), ({"pilot.guidance": "interactive"}, 0.7)],
    ids=["hard", "soft", "by hand"],
)
def test_a_soft_gate_takes_the_threshold_and_the_dead_band_of_guidance_by_hand_is_one(changes, beyond):
    a = admittance({"admittance.feel": {"force": 1.0, "speed": 0.5}, **changes}, "one-push")
    assert a.damping == pytest.approx([beyond / 0.5] * 3)


def test_the_preset_stays_in_the_resolved_mission_and_can_be_changed_in_it():
    tables = tables_of(tl.load_mission("iris", {"admittance.feel.preset": "firm"}))
    assert tables["admittance"]["feel"] == {"preset": "firm"}
    again = check(tables)
    assert tables_of(again) == tables
    slow = changed(again, "admittance.feel.preset", "slow").admittance
    assert slow == admittance({"admittance.feel.preset": "slow"})


def test_a_mass_that_is_set_after_a_feel_counts_and_the_damping_stays():
    firm = tl.load_mission("iris", {"admittance.feel.preset": "firm"})
    heavier = changed(firm, "admittance.mass", 3.0).admittance
    assert heavier.mass == (3.0,) * 3
    assert heavier.damping == firm.admittance.damping
    assert heavier.feel is None
    assert admittance({"admittance.feel.preset": "firm", "admittance.mass": 3.0}) == heavier
    one = changed(firm, "admittance.damping.1", 5.0).admittance
    assert one.damping == (firm.admittance.damping[0], 5.0, firm.admittance.damping[2])


@pytest.mark.parametrize("made", [interactive_mission, portable_mission])
def test_pages_and_other_machines_have_the_numbers_in_place_of_the_feel(made):
    mission = tl.load_mission("hover", {"admittance.feel.preset": "slow"})
    after = made(mission).admittance
    assert after.feel is None
    assert (after.mass, after.damping) == (mission.admittance.mass, mission.admittance.damping)
