"""What a page says to a flight, and what becomes of it; the flight is moved by the tests, not by the clock."""

import threading
from types import SimpleNamespace

import numpy as np
import pytest
from patience import PATIENCE, until

import tandemlift as tl
from tandemlift.live import messages
from tandemlift.live.by_hand import NEVER, by_hand, renewed
from tandemlift.live.controls import BY_KEY, controls_of
from tandemlift.live.frames import read_frames
from tandemlift.live.knobs import Knobs
from tandemlift.live.pace import MOST_BEHIND, Pace
from tandemlift.live.session import Session
from tandemlift.live.taring import check_in_time
from tandemlift.missions import changed

GUIDED = {
    "pilot.guidance": "hand",
    "phases.rotors": "flight",
    "ground.model": "floor",
    "compliance.yaw.model": "yielding",
}
STIFFNESS, THRESHOLD = 6.0, 0.3  # N/m, N


@pytest.fixture
def session(tmp_path):
    one = Session(tl.load_mission("hover", GUIDED | {"admittance.threshold": THRESHOLD}), out=tmp_path)
    one.prepare()
    yield one
    one.stop()


def say(session, kind, **what):
    return session.apply(getattr(messages, kind.capitalize())(type=kind, seq=1, **what), 1)


def fly(session, seconds):
    for _ in range(round(seconds / session._flight.dt)):
        session._forget_wishes()
        session._flight.advance()


def seen(session):
    fields = tuple((name, count) for name, count in session.scene["fields"])
    return {name: value[0] for name, value in read_frames(fields, session.frame()).items()}


def up(session):
    fly(session, 8.0)
    assert session.status()["phase"] in ("guided", "hold")
    return seen(session)["position"]


def test_a_scene_tells_of_the_hand_and_of_what_may_be_changed(session):
    assert session.scene["spring"]["stiffness"] == STIFFNESS
    keys = {control["key"] for control in session.scene["controls"]}
    assert {"admittance.mass", "controller.name", "person.stiffness", "wind.velocity"} <= keys
    assert not {k for k in keys if k.startswith("sensors")}, "it has none"


def test_the_beam_comes_to_the_hand_less_threshold_over_stiffness_and_rests_when_let_go(session):
    at = up(session)
    target = (float(at[0]) + 0.8, float(at[1]), float(at[2]))
    say(session, "grab", point=(0.0, 0.0, 0.0), target=target, at="point")
    fly(session, 15.0)
    here = seen(session)
    assert here["held"] == 1.0
    assert 0.0 < target[0] - here["position"][0] < 1.3 * THRESHOLD / STIFFNESS + 0.01
    say(session, "release")
    fly(session, 4.0)
    there = seen(session)
    assert there["held"] == 0.0
    assert np.abs(there["push"]).max() < 1e-6
    assert np.abs(there["velocity"]).max() < 0.01


def test_pulled_at_the_centre_nothing_turns_and_pulled_at_an_end_the_beam_does(session):
    at = up(session)
    end = (0.0, 0.9, 0.0)
    target = (float(at[0]) + 0.5, float(at[1]) + 0.9, float(at[2]))
    say(session, "grab", point=end, target=target, at="centre")
    fly(session, 1.0)
    assert abs(seen(session)["reference_yaw"]) < 1e-3
    assert np.allclose(seen(session)["hand_point"], 0.0)
    assert np.allclose(seen(session)["hand_target"], np.add(at, [0.5, 0.0, 0.0]), atol=0.02)
    say(session, "release")
    fly(session, 3.0)
    farther = (target[0] + 1.0, *target[1:])
    say(session, "grab", point=end, target=farther, at="point")
    fly(session, 0.15)
    assert np.allclose(seen(session)["hand_point"], end)
    assert seen(session)["push"][0] > 1.0
    fly(session, 1.0)
    assert abs(seen(session)["reference_yaw"]) > 0.05


def test_a_key_pushes_with_its_force_and_stops_when_it_is_let_go(session):
    up(session)
    say(session, "force", force=(2.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    fly(session, 1.0)
    assert seen(session)["push"] == pytest.approx([2.0, 0.0, 0.0], abs=1e-3)
    say(session, "force", force=(0.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    fly(session, 1.0)
    assert np.abs(seen(session)["push"]).max() < 1e-4


def test_it_lands_and_lifts_again_when_it_is_asked_to_and_stops_at_once(session):
    at = up(session)
    say(session, "ask", what="land")
    fly(session, 25.0)
    assert session.status()["phase"] == "idle"
    assert seen(session)["position"][2] < at[2] - 0.3
    say(session, "ask", what="lift")
    fly(session, 10.0)
    assert session.status()["phase"] in ("guided", "hold")
    say(session, "ask", what="stop")
    fly(session, 0.1)
    assert session.status()["phase"] == "stopped"


def test_while_it_may_not_listen_it_holds_its_place(session):
    at = up(session)
    say(session, "enable", on=False)
    say(session, "force", force=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    fly(session, 3.0)
    assert np.abs(seen(session)["reference"] - at)[:2].max() < 0.02
    say(session, "enable", on=True)
    fly(session, 3.0)
    assert seen(session)["reference"][0] - at[0] > 0.3


def test_a_setting_changes_for_good_and_comes_back_to_what_the_mission_says(session):
    before = list(session._mission.admittance.mass)
    (answer,) = say(session, "set", key="admittance.mass", value=5.0)
    assert answer["value"] == [5.0, 5.0, 5.0]
    assert session._flight.now.admittance.mass == (5.0, 5.0, 5.0)
    say(session, "set", key="wind.velocity", value=(1.0, 0.0, 0.0))
    fly(session, 1.0)
    assert seen(session)["wind"][0] == pytest.approx(1.0, abs=0.05)
    told = say(session, "restore")
    assert [t["type"] for t in told] == ["changed"] * 2
    assert {t["key"] for t in told} == {"admittance.mass", "wind.velocity"}
    assert list(session._flight.now.admittance.mass) == before


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("admittance.mass", 1e9, "admittance.mass = 1000000000.0: must be from 0.3 to 20"),
        ("admittance.mass", True, "must be a number"),
        ("admittance.mass", (1.0, 2.0), "admittance.mass"),
        ("mission.step", 0.01, "is not among the controls"),
        ("controller.name", "none", "unknown controller"),
        ("sensors.joints.force_noise", 0.1, "sensors.joints.force_noise"),
    ],
)
def test_what_cannot_be_changed_is_refused_with_a_reason_and_the_flight_goes_on(session, key, value, words):
    now = session._flight.now
    with pytest.raises(tl.InputError) as refused:
        say(session, "set", key=key, value=value)
    assert words in str(refused.value)
    assert session._flight.now is now
    fly(session, 0.1)


def test_a_control_may_be_set_to_what_the_mission_says_though_it_is_beyond_its_bounds():
    paper = by_hand(tl.load_mission("paper"))
    xi = next(c for c in controls_of(paper, paper) if c["key"] == "controller.gains.xi")
    assert xi["min"] <= min(xi["value"])
    assert xi["max"] >= max(xi["value"])
    assert xi["max"] > BY_KEY["controller.gains.xi"].high


def test_hands_are_refused_while_the_sensors_are_tared(session, monkeypatch):
    mission = session._flight.now
    tared = mission.estimator.model_copy(update={"tare_start": 5.0, "tare_duration": 2.0})
    pilot = mission.pilot.model_copy(update={"push": "estimate"})
    session._flight.now = mission.model_copy(update={"estimator": tared, "pilot": pilot})
    with pytest.raises(tl.InputError, match="hands off until 7 s"):
        say(session, "grab", point=(0.0, 0.0, 0.0), target=(1.0, 0.0, 0.0), at="point")
    with pytest.raises(tl.InputError, match="hands off until 7 s"):
        say(session, "force", force=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    say(session, "force", force=(0.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
    fly(session, 7.0)
    say(session, "grab", point=(0.0, 0.0, 0.0), target=(1.0, 0.0, 0.0), at="point")


@pytest.mark.parametrize(
    ("estimator", "push", "words"),
    [
        ({}, "truth", "reads no sensor that could be tared"),
        ({"tare": "hover"}, "estimate", "tares by itself, in steady hover"),
        ({}, "estimate", "the mission has none (estimator.tare_start)"),
    ],
)
def test_a_mission_without_a_tare_that_can_be_begun_says_so(session, estimator, push, words):
    up(session)
    now = session._flight.now
    told = {
        "estimator": now.estimator.model_copy(update=estimator),
        "pilot": now.pilot.model_copy(update={"push": push}),
    }
    session._flight.now = now.model_copy(update=told)
    with pytest.raises(tl.InputError) as refused:
        say(session, "tare")
    assert words in str(refused.value)


def test_a_tare_wants_hover_and_no_hand_and_begins_in_time(session):
    with pytest.raises(tl.InputError, match="only in the air, hovering; the phase is idle"):
        say(session, "tare")
    at = up(session)
    say(session, "grab", point=(0.0, 0.0, 0.0), target=tuple(map(float, at)), at="point")
    with pytest.raises(tl.InputError, match="hands off first"):
        say(session, "tare")
    with pytest.raises(tl.InputError, match="took too long"):
        check_in_time(session.flight, session.flight.step * session.flight.dt)


class Flown:
    """A flight whose mission tares, as far as knobs see it; making a change ready takes so many steps."""

    def __init__(self, takes):
        self.now, self.dt, self.step, self.takes = tl.load_mission("zigzag"), 0.001, 12_000, takes

    def prepare(self, key, value):
        self.step += self.takes
        return changed(self.now, key, value)

    def change(self, due, key, value):
        self.now = due


def test_a_tare_begins_a_second_after_it_was_asked_for_or_is_asked_for_again():
    knobs, flight, slow = Knobs(by_hand(tl.load_mission("zigzag")), threading.RLock()), Flown(300), Flown(999)
    assert knobs.tare(flight) == "from 13 s to 15 s"
    assert flight.now.estimator.tare_start == 13.0
    with pytest.raises(tl.InputError, match="took too long to make ready"):
        knobs.tare(slow)
    assert slow.now.estimator.tare_start == 5.0


def test_a_mission_that_is_guided_by_the_clock_says_that_it_asks_nobody(session):
    session._mission = tl.load_mission("paper")
    for request in ({"kind": "ask", "what": "stop"}, {"kind": "enable", "on": False}):
        with pytest.raises(tl.InputError, match="guided by the clock"):
            say(session, **request)


def test_a_flight_that_is_over_says_so_and_changes_no_more(session):
    session._flight._p.steps = session._flight.step + 10
    fly(session, 0.01)
    session._fly(5)
    assert session.status()["phase"] == "over"
    with pytest.raises(tl.InputError, match="the flight is over; reset it first"):
        say(session, "set", key="admittance.mass", value=5.0)


def test_an_error_in_flight_is_told(session, monkeypatch):
    def fail():
        raise RuntimeError("of a controller")

    session._flight.advance = fail
    session.start()
    until(lambda: session.status()["phase"] == "failed")
    say(session, "reset")
    until(lambda: session.status()["recorded_s"] > 0.1)
    assert session.status()["phase"] != "failed"


def test_a_recorded_mission_is_flown_by_who_watches_and_not_by_the_recording(tmp_path, session):
    fly(session, 0.5)
    say(session, "save", name="first")
    again = by_hand(tl.load_mission(tmp_path / "first" / "recorded.toml"))
    assert (again.person.model, again.person.recording, again.changes) == ("grab", None, ())


def test_a_rotor_that_cannot_fail_is_not_killed(session):
    with pytest.raises(tl.InputError, match="rotor = 3: the rotors of this mission cannot fail"):
        say(session, "kill", rotor=3)


def test_another_controller_takes_over_at_once(session):
    fly(session, 3.0)
    say(session, "set", key="controller.name", value="pid")
    fly(session, 1.0)
    assert session._flight.now.controller.name == "pid"
    told = say(session, "restore", key="controller.name")
    assert [t["type"] for t in told] == ["changed", "scene"]
    assert session._flight.now.controller == session._mission.controller, "with the mission's own settings"
    fly(session, 1.0)
    assert not session._flight.lost


def test_a_reset_begins_again_with_the_settings_as_they_are(session):
    say(session, "set", key="admittance.mass", value=5.0)
    fly(session, 1.0)
    generation = session.generation
    say(session, "reset")
    assert session.generation == generation + 1
    assert session.status()["recorded_s"] < 0.01
    assert session._flight.now.admittance.mass == (5.0, 5.0, 5.0)
    control = next(c for c in session.scene["controls"] if c["key"] == "admittance.mass")
    assert list(control["value"]) == [5.0, 5.0, 5.0]


def test_after_a_reset_rotors_that_had_failed_are_whole():
    first = by_hand(tl.load_mission("iris"))
    now = changed(changed(first, "faults.3.time", 2.5), "admittance.mass", 5.0)
    again = renewed(now, first)
    assert [f.time for f in again.faults] == [NEVER] * 8
    assert again.admittance.mass == (5.0, 5.0, 5.0)


def test_what_was_flown_is_saved_under_its_name_and_flies_again(session, tmp_path):
    fly(session, 2.0)
    answer = say(session, "save", name="mine")
    assert answer == {"type": "done", "what": "save", "detail": str(tmp_path / "mine")}
    again = tl.fly(tl.load_mission(tmp_path / "mine" / "recorded.toml"))
    np.testing.assert_array_equal(again["position"], tl.Flight.load(tmp_path / "mine" / "flight.npz")["position"])


def unprepared(tmp_path, **settings):
    return Session(tl.load_mission("hover", GUIDED | settings), out=tmp_path)


def test_before_it_is_compiled_the_vehicle_is_seen_where_it_will_begin(tmp_path):
    one = unprepared(tmp_path, **{"initial.position": [1.0, 2.0, 0.0]})
    assert one.status()["phase"] == "preparing"
    before, controls = seen(one), one.scene["controls"]
    one.prepare()
    assert one.status()["phase"] != "preparing"
    for field in ("position", "attitude", "velocity"):
        np.testing.assert_array_equal(before[field], seen(one)[field], err_msg=field)
    assert one.scene["controls"] == controls
    one.stop()


def test_before_it_is_compiled_nothing_is_heeded_and_a_hand_that_goes_does_no_harm(tmp_path):
    one = unprepared(tmp_path)
    one.release()
    for kind, what in {"reset": {}, "pause": {"on": True}, "save": {"name": "mine"}}.items():
        with pytest.raises(tl.InputError, match="the flight is still being prepared"):
            say(one, kind, **what)
    one.stop()


def test_a_flight_that_cannot_be_compiled_says_why_and_is_not_flown(tmp_path, monkeypatch, caplog):
    def fail(*_):
        raise tl.InputError("law.py:3 branches on data")

    monkeypatch.setattr("tandemlift.live.session.RecordedFlight", fail)
    one = unprepared(tmp_path)
    one.start()
    until(lambda: one.status()["phase"] == "failed")
    assert one.status()["preparing"]["failure"] == "law.py:3 branches on data"
    with pytest.raises(tl.InputError, match=r"cannot be flown: law\.py:3 branches on data"):
        say(one, "reset")
    assert "law.py:3" in caplog.text
    assert len(one.frame()) > 0
    one.stop()


def test_a_session_that_still_compiles_is_stopped_at_once(tmp_path, monkeypatch):
    compiles, goes_on = threading.Event(), threading.Event()

    def compile_for_long(*_):
        compiles.set()
        goes_on.wait(PATIENCE)
        raise tl.InputError("nobody waits for this")

    monkeypatch.setattr("tandemlift.live.session.RecordedFlight", compile_for_long)
    one = unprepared(tmp_path)
    one.start()
    assert compiles.wait(PATIENCE)
    one.stop()  # which does not wait for what is compiled
    goes_on.set()
    one._thread.join(PATIENCE)


def test_optimised_code_takes_over_while_it_flies(tmp_path, monkeypatch):
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr("tandemlift.simulation.plan.KERNELS", {})
    one = unprepared(tmp_path)
    one.start()
    until(lambda: one.is_ready and one.flight._stepper.code.is_best, patience=4 * PATIENCE)
    then = one.flight.step
    until(lambda: one.flight.step > then + 100)
    assert not one.flight.lost
    one.stop()


def test_the_thread_flies_until_it_is_stopped_and_pauses(session):
    session.start()
    until(lambda: session.status()["recorded_s"] > 0.2)
    say(session, "pause", on=True)
    then, rests = session.status()["recorded_s"], []
    session._flight.rest = lambda: rests.append(None)
    until(lambda: len(rests) > 20)
    assert session.status()["recorded_s"] == then
    say(session, "pause", on=False)
    until(lambda: session.status()["recorded_s"] > then)


def test_a_body_that_waits_is_told_of_a_pause(session):
    class Waiting:
        rests = 0

        def rest(self):
            self.rests += 1

    session.start()
    say(session, "pause", on=True)
    session._flight._stepper.body = body = Waiting()
    until(lambda: body.rests > 3)


@pytest.fixture
def clock(monkeypatch):
    now = [0.0]
    monkeypatch.setattr("tandemlift.live.pace.time", SimpleNamespace(perf_counter=lambda: now[0]))
    return now


def test_steps_are_due_as_time_passes_at_the_speed_asked_for(clock):
    pace = Pace(0.001)
    clock[0] = 0.0105
    assert pace.due() == 10
    pace.flew(10)
    assert pace.behind == pytest.approx(0.0005)
    pace.speed = 0.5
    clock[0] += 0.02
    assert pace.due() == 10


def test_what_a_machine_cannot_keep_up_with_is_forgotten(clock):
    pace = Pace(0.001)
    clock[0] = 10.0
    assert pace.due() == round(MOST_BEHIND / 0.001)


def test_the_factor_is_time_flown_over_time_passed(clock):
    pace = Pace(0.001)
    for _ in range(300):
        clock[0] += 0.01
        pace.due()
        pace.flew(5)
    assert pace.factor == pytest.approx(0.5, rel=0.02)


def test_hands_are_refused_until_it_has_tared_by_itself_in_steady_hover(session):
    up(session)
    mission = session._flight.now
    estimator = mission.estimator.model_copy(update={"tare": "hover", "tare_duration": 2.0})
    pilot = mission.pilot.model_copy(update={"push": "estimate"})
    session._flight.now = mission.model_copy(update={"estimator": estimator, "pilot": pilot})
    until_tared = 2.0 - session._flight.number("memory", "guidance", "phase", "hovered")
    if until_tared > 0.0:
        with pytest.raises(tl.InputError, match="hands off until the force sensors are tared, in steady hover"):
            say(session, "force", force=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))
        fly(session, until_tared + 0.01)
    say(session, "force", force=(1.0, 0.0, 0.0), point=(0.0, 0.0, 0.0))


@pytest.mark.parametrize("kind", ["grab", "force"])
def test_a_hand_touches_the_vehicle_and_not_the_air_beside_it(session, kind):
    up(session)
    rest = {"grab": {"target": (0.0, 0.0, 0.0), "at": "point"}, "force": {"force": (1.0, 0.0, 0.0)}}[kind]
    with pytest.raises(tl.InputError, match=r"point = .*: must be on the vehicle, within"):
        say(session, kind, point=(0.0, 9.0, 0.0), **rest)
    say(session, kind, point=(0.0, 0.9, 0.0), **rest)


def test_the_status_tells_every_viewer_which_rotors_are_dead(session):
    assert session.status()["dead"] == []
    session._flight.now = changed(by_hand(tl.load_mission("iris")), "faults.3.time", 0.0)
    assert session.status()["dead"] == [3]
