"""What changes in flight, and a hand that is moved from outside."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.missions.recording import Recording, write_recording

LONG_PUSH = [{"force": [2.0, 0.0, 0.0], "time": 10.0, "sigma": 1e6}]
FREE = {"admittance.stiffness": 0.0, "admittance.mass": 2.0, "admittance.damping": 2.0, "admittance.threshold": 0.0}


def load(changes=(), name="one-push", **keys):
    return tl.load_mission(name, {"mission.duration": 12.0, "changes": list(changes)} | keys)


def change(key, value, time=5.0, duration=0.0):
    return {"time": time, "key": key, "value": value, "duration": duration}


def hand(held=0.0, grip=(0, 0, 0), target=(0, 0, 0), force=(0, 0, 0)):
    return [held, *grip, *target, *force, 0.0, 0.0, 0.0, 1.0]


def recorded(path, rows):
    steps, hands = zip(*rows, strict=True)
    write_recording(path, Recording(np.array(steps), np.array(hands, dtype=float)))
    return {"person.model": "virtual-hand", "person.recording": str(path), "pushes": []}


def test_a_ramped_damping_gives_the_reference_that_scipy_integrates():
    flight = tl.fly(load([change("admittance.damping", [8.0, 8.0, 8.0], 5.0, 2.0)], pushes=LONG_PUSH, **FREE))
    damping = lambda t: np.interp(t, [5.0, 7.0], [2.0, 8.0])  # noqa: E731
    solved = solve_ivp(lambda t, v: (2.0 - damping(t) * v) / 2.0, (0, 12), [0.0], t_eval=flight.time, rtol=1e-9)
    np.testing.assert_allclose(flight["reference_velocity"][:, 0], solved.y[0], atol=2e-3)


def test_of_two_ramps_of_one_number_the_later_one_counts():
    flight = tl.fly(
        load(
            [change("admittance.damping", 8.0, 4.0, 6.0), change("admittance.damping", 1.0, 5.0, 0.5)],
            pushes=LONG_PUSH,
            **FREE,
        )
    )
    expected = lambda t: np.interp(t, [4.0, 5.0, 5.5], [2.0, 3.0, 1.0])  # noqa: E731
    solved = solve_ivp(
        lambda t, v: (2.0 - expected(t) * v) / 2.0, (0, 12), [0.0], t_eval=flight.time, rtol=1e-9, max_step=0.01
    )
    np.testing.assert_allclose(flight["reference_velocity"][:, 0], solved.y[0], atol=3e-3)


def test_a_mission_that_changes_a_list_has_a_hash():
    one, two = (load([change("admittance.damping", [8.0, 8.0, 8.0], 5.0, 2.0)]) for _ in range(2))
    assert hash(one) == hash(two)
    assert one == two


def test_a_change_to_the_same_value_changes_no_bit():
    plain = tl.fly(load())
    same = tl.fly(load([change("admittance.damping", list(plain.mission["admittance"]["damping"]))]))
    for channel in plain.channels:
        np.testing.assert_array_equal(same[channel], plain[channel])
    assert same.metrics()["wall_s"] > 0.0


def test_another_controller_takes_over_in_flight():
    plain, other = tl.fly(load()), tl.fly(load([change("controller.name", "pid")]))
    from_the_start = tl.fly(load(**{"controller.name": "pid"}))
    before = plain.time < 5.0
    np.testing.assert_array_equal(other["position"][before], plain["position"][before])
    assert other.ending is None
    assert np.abs(other["position"] - other["reference_position"])[-1].max() < 0.05
    late = plain.time > 11.0
    assert np.abs(other["thrust"] - from_the_start["thrust"])[late].max() < 0.05


def test_limits_that_change_in_flight_are_those_in_the_report():
    push = {"force": [25.0, 0.0, 0.0], "time": 2.0, "sigma": 0.3}
    limits = {"crash.tilt": 0.4, "promise.tilt": 0.2}
    changes = [{"time": 0.5, "key": key, "value": value} for key, value in limits.items()]
    common = {
        "mission.duration": 4.0,
        "phases.lift_duration": 1.0,
        "promise.settling_time": 0.0,
        "promise.tilt": 0.1,
        "pushes": [push],
    }
    first, later = (
        tl.fly(tl.load_mission("one-push", {**common, **given})) for given in (limits, {"changes": changes})
    )
    assert later.ending == first.ending
    assert later.findings == first.findings
    assert {f.limit for f in later.findings if f.kind == "off-track"} == {0.2}


def test_missions_that_change_fly_among_many_as_alone():
    changing = load([change("admittance.damping", [4.0, 4.0, 4.0])])
    together = tl.fly_many([load(), changing, load()])
    np.testing.assert_array_equal(together[1]["position"], tl.fly(changing)["position"])
    np.testing.assert_array_equal(together[0]["position"], together[2]["position"])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ([change("vehicle.payload.mass", 1.0)], "vehicle.payload.mass is chosen before a flight begins"),
        ([change("wind.model", "air")], "wind.model is chosen before a flight begins"),
        ([change("mission.duration", 20.0)], "mission.duration is chosen before a flight begins"),
        ([change("mission.name", "other")], "mission.name has no effect in this flight"),
        ([change("admittance.mass", -1.0)], "changes.0: mission: admittance.mass = -1.0: must be"),
        ([change("admittance.mas", 1.0)], "admittance.mas = 1.0: unknown key"),
        ([change("admittance.mass", 1.0), change("admittance.mass", 2.0, 4.0)], "changes.1.time = 4.0: must not be"),
        ([{"time": 1.0, "key": "admittance.mass"}], "changes.0.value is missing"),
    ],
)
def test_a_change_that_cannot_be_is_refused_with_its_key(changes, words):
    with pytest.raises(tl.InputError, match=words.replace("[", r"\[")):
        tl.fly(load(changes))


def test_a_hand_pulls_the_beam_to_its_target_less_threshold_over_stiffness(tmp_path):
    rows = [(0, hand()), (1000, hand(1.0, target=(0.6, 0.0, 0.0)))]
    slow = FREE | {"admittance.threshold": 1.0, "admittance.damping": 40.0, "admittance.gate": "soft"}
    spring = {"person.stiffness": 10.0, "person.damping": 4.0, "person.lag": 0.02, "mission.duration": 100.0}
    mission = load(name="hover", **slow, **recorded(tmp_path / "hand.npz", rows), **spring)
    flight = tl.fly(mission)
    short = 0.6 - flight["position"][-1, 0]
    assert short == pytest.approx(1.0 / 10.0, abs=2e-3)


def test_a_hand_lets_go_and_the_beam_comes_to_rest(tmp_path):
    rows = [(0, hand()), (1000, hand(force=(2.0, 0.0, 0.0))), (3000, hand())]
    flight = tl.fly(load(**recorded(tmp_path / "hand.npz", rows), **{"person.lag": 0.05}))
    push = flight["push_force"][:, 0]
    assert push[flight.time < 1.0].max() == 0.0
    np.testing.assert_allclose(push[(flight.time > 2.5) & (flight.time < 3.0)], 2.0, atol=1e-6)
    np.testing.assert_allclose(push[flight.time > 6.0], 0.0, atol=1e-6)


def test_a_spring_is_let_go_of_as_smoothly_as_it_was_taken(tmp_path):
    rows = [(0, hand()), (500, hand(1.0, target=(0.5, 0.0, 0.5))), (1500, hand())]
    keys = {"person.lag": 0.05, "mission.log_interval": 0.001, "mission.duration": 3.0, "admittance.threshold": 3.0}
    flight = tl.fly(load(name="hover", **recorded(tmp_path / "hand.npz", rows), **keys))
    push = np.linalg.norm(flight["push_force"], axis=1)
    held = push[flight.time < 1.5][-1]
    assert held > 1.0
    assert np.abs(np.diff(push)).max() < 0.05 * held
    assert push[-1] < 1e-3


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        (None, "there is no such file"),
        ({"step": np.arange(2)}, "not a recording"),
        ({"step": np.array([0, 0]), "hand": np.zeros((2, 14))}, "`step` must be int64"),
        ({"step": np.arange(2), "hand": np.zeros((2, 3))}, "`hand` must be finite float64"),
        ({"step": np.arange(1), "hand": np.full((1, 14), np.nan)}, "`hand` must be finite float64"),
    ],
)
def test_a_file_that_is_no_recording_is_refused(tmp_path, arrays, words):
    path = tmp_path / "hand.npz"
    if arrays is not None:
        np.savez(path, **arrays)
    with pytest.raises(tl.InputError, match=words):
        load(**{"person.model": "virtual-hand", "person.recording": str(path)})


def test_a_recording_without_a_hand_is_refused(tmp_path):
    with pytest.raises(tl.InputError, match="must be left out where"):
        load(**{"person.recording": "hand.npz"})
