"""`tandemlift feel`: what is flown is what the closed form says, wishes come true, and presets pass their checks."""

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.settings.admittance import FEELS
from tandemlift.studies.feel.feel_study import study_feel
from tandemlift.studies.feel.standard_push import answer_of, pushed_axes
from tandemlift.studies.feel.wish import proposed, wishes, with_proposal

EDGE = 0.02  # s, of the flown push
IDEAL = "one-push"  # ideal rotors, no sensors, the push known


def reference_of(pushed):
    """The speed that the flown admittance gives to the controller."""
    return pushed.flight["admittance_velocity"][pushed.kept, "xyz".index(pushed.feel.axis)]


def test_with_ideal_parts_the_admittance_is_the_closed_form_and_the_vehicle_follows_it():
    """The push's edges, 20 ms wide, pass little of the answer's first acceleration; the controller lags by less."""
    for pushed in pushed_axes(tl.load_mission(IDEAL, {"admittance.gate": "soft"})):
        reference = reference_of(pushed)
        assert np.abs(reference - pushed.closed).max() < pushed.feel.acceleration * 2.0 * EDGE
        assert pushed.difference < 0.1 * pushed.feel.final_speed
        assert pushed.real.final_speed == pytest.approx(pushed.ideal.final_speed, rel=0.01)
        assert pushed.real.time == pytest.approx(pushed.ideal.time, rel=0.04)
        assert pushed.real.lag == pytest.approx(pushed.ideal.lag, rel=0.06)
        assert pushed.real.stop_distance == pytest.approx(pushed.ideal.stop_distance, rel=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_a_wish_comes_out_of_the_flight_with_ideal_parts(seed):
    rng = np.random.default_rng(seed)
    force, speed, time = rng.uniform(0.5, 4.0), rng.uniform(0.1, 1.2), rng.uniform(1.2, 4.0)
    gate = ("hard", "soft")[seed % 2]
    mission = tl.load_mission(IDEAL, {"admittance.gate": gate})
    text = f"{force:.4f} N gives {speed:.4f} m/s in {time:.4f} s"
    for pushed in pushed_axes(with_proposal(mission, proposed(mission, text))):
        assert pushed.feel.push == pytest.approx(force, abs=1e-4)
        reference = answer_of(pushed.feel, pushed.time, reference_of(pushed), pushed.hold)
        assert reference.final_speed == pytest.approx(speed, rel=0.005)
        assert reference.time == pytest.approx(time, rel=0.01, abs=0.02)
        assert pushed.real.final_speed == pytest.approx(speed, rel=0.01)
        assert pushed.real.time == pytest.approx(time, rel=0.15)  # the paper's controller along y, by roll


@pytest.mark.parametrize("preset", FEELS)
def test_each_preset_passes_its_checks_in_iris(preset):
    study = study_feel(tl.load_mission("iris", {"admittance.feel.preset": preset}))
    assert [(c.check, c.subject, c.text) for c in study.checks if c.verdict == "fails"] == []
    assert study.effort.arrived
    assert study.effort.clearance > 0.2
    for pushed in study.pushed[:3]:
        assert pushed.real.final_speed == pytest.approx(FEELS[preset].speed, rel=0.1)


def test_a_wish_that_the_rotors_cannot_give_says_the_bound():
    mission = tl.load_mission("iris")
    study = study_feel(with_proposal(mission, proposed(mission, "1 N gives 1.5 m/s in 0.5 s along x")))
    failed = {(c.check, c.subject): c for c in study.checks if c.verdict == "fails"}
    rotors = failed["rotors", "x"]
    assert rotors.limit == pytest.approx(9.81 * np.tan(0.25), rel=1e-3)
    acceleration = np.log(20.0) * 1.5 / 0.5
    assert rotors.value == pytest.approx(acceleration - 1.0 / 3.5, rel=1e-3)
    bound = np.log(20.0) * 1.5 / (rotors.limit + 1.0 / 3.5)
    assert f"allow it at least {bound:.2g} s for 1.5 m/s" in rotors.text
    assert ("rotors", "y") not in failed


def test_a_quick_answer_without_mass_drives_a_person_who_sees_late():
    study = study_feel(tl.load_mission("iris", {"admittance.feel": {"force": 1.0, "speed": 0.6, "time": 0.5}}))
    failed = {c.check for c in study.checks if c.verdict == "fails"}
    assert {"acceleration", "rotors", "flown", "corridor", "arm"} <= failed


def test_a_spring_leads_to_no_speed_and_is_shown_all_the_same():
    pushed = pushed_axes(tl.load_mission(IDEAL, {"admittance.stiffness": 2.0, "admittance.damping": 2.0}))[0]
    assert pushed.ideal.final_speed is None
    assert abs(pushed.real.final_speed) < 0.02
    assert pushed.difference < 0.1 * np.abs(pushed.closed).max()


def test_clauses_name_axes_once_and_one_without_axes_holds_for_the_others():
    found = wishes(
        "2 N gives 0.6 m/s in 1 s along x and y;  1 N leads to 0.3 m/s within 1.5 s; 0.5 N m gives 0.2 rad/s in 6 s."
    )
    assert [w.axes for w in found] == [("x", "y"), ("z",), ("yaw",)]
    assert found[1][:3] == (1.0, 0.3, 1.5)
    mission = tl.load_mission("iris")
    tables = proposed(mission, "1 N gives 0.5 m/s in 2 s along z; 0.5 N m gives 0.2 rad/s in 6 s")
    after = with_proposal(mission, tables)
    assert after.admittance.damping == pytest.approx([1.6, 1.6, 1.4], rel=1e-5)
    assert after.admittance.mass[:2] == pytest.approx([1.0, 1.0], rel=1e-5)
    assert after.compliance.yaw.damping == pytest.approx(0.35 / 0.2)
    assert after.compliance.yaw.inertia / after.compliance.yaw.damping == pytest.approx(6.0 / np.log(20.0), rel=1e-5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("quick, please", "'quick, please' must have the form \"1 N gives"),
        ("1 kg gives 0.6 m/s in 1 s", "must have the form"),
        ("1 N gives 0.6 m/s in 1 s along w", "must have the form"),
        ("1 N gives -0.6 m/s in 1 s", "must have the form"),
        ("", "must have the form"),
        ("0 N gives 0.6 m/s in 1 s", "must be from 1e-06 to 1e+06"),
        ("1 N gives 1e9 m/s in 1 s", "must be from 1e-06 to 1e+06"),
        ("1 N gives 0.6 m/s in 1 s; 2 N gives 0.6 m/s in 1 s", "has two clauses without axes"),
        ("1 N gives 0.6 m/s in 1 s along x, x", "names x twice"),
        ("1 N gives 0.6 m/s in 1 s along x, y and z; 1 N gives 1 m/s in 1 s", "no axis is left"),
        ("1 N m gives 0.6 m/s in 1 s", "mixes forces and moments"),
        ("0.3 N gives 0.6 m/s in 1 s", "0.3 N along x must be above admittance.threshold = 0.3 N"),
        ("0.1 N m gives 0.2 rad/s in 2 s", "must be above compliance.yaw.threshold = 0.15 N m"),
        ("2 N m gives 0.2 rad/s in 2 s", "no steady rate exists above 1.05 N m"),
    ],
)
def test_what_is_no_wish_is_refused(text, said):
    with pytest.raises(tl.InputError, match="--wish") as error:
        proposed(tl.load_mission("iris"), text)
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("changes", "text", "said"),
    [
        ({"admittance.stiffness": 2.0}, "1 N gives 0.6 m/s in 1 s", "add --set admittance.stiffness=0"),
        ({}, "0.5 N m gives 0.2 rad/s in 6 s", "keeps its heading"),
        ({"admittance.damping": 0.0}, "1 N gives 0.6 m/s in 1 s along x", "name y in --wish, too"),
    ],
    ids=["spring", "yaw", "undamped"],
)
def test_a_wish_that_a_mission_cannot_have_is_refused(changes, text, said):
    with pytest.raises(tl.InputError) as error:
        proposed(tl.load_mission(IDEAL, changes), text)
    assert said in str(error.value)
