"""What the hand of a page does to a flight."""

import numpy as np
import pytest
from sessions import STIFFNESS, THRESHOLD, fly, say, seen, up

import tandemlift as tl


def test_a_scene_tells_of_the_hand_and_of_what_may_be_changed(session):
    assert session.scene["spring"]["stiffness"] == STIFFNESS
    keys = {control["key"] for control in session.scene["parameters"]}
    assert {"admittance.mass", "controller.name", "person.stiffness", "wind.velocity"} <= keys
    assert not {k for k in keys if k.startswith("sensors")}, "it has none"


def test_the_beam_comes_to_the_hand_to_threshold_over_stiffness_and_rests_when_let_go(session):
    at = up(session)
    target = (float(at[0]) + 0.8, float(at[1]), float(at[2]))
    say(session, "grab", point=(0.0, 0.0, 0.0), target=target, at="point")
    fly(session, 15.0)
    here = seen(session)
    assert here["held"] == 1.0
    assert abs(target[0] - here["position"][0]) < 1.3 * THRESHOLD / STIFFNESS + 0.01
    assert np.abs(here["velocity"]).max() < 0.01
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
    fly(session, 1.5)
    assert np.abs(seen(session)["push"]).max() < 1e-4


def pulses_felt(session, seconds):
    """The true push along x after each step [N]."""
    felt = []
    for _ in range(round(seconds / session.flight.dt)):
        fly(session, session.flight.dt)
        felt.append(seen(session)["push"][0])
    return np.array(felt)


def test_a_tap_is_one_pulse_of_its_force_and_duration_behind_the_low_pass_of_the_hand(session):
    up(session)
    say(session, "force", force=(3.0, 0.0, 0.0), point=(0.0, 0.0, 0.0), duration=0.05)
    felt, dt = pulses_felt(session, 0.3), session.flight.dt
    s = np.clip((np.arange(len(felt)) + 1.0) * dt / 0.05, 0.0, 1.0)
    assert felt == pytest.approx(3.0 * 16.0 * (s * (1.0 - s)) ** 2, abs=0.05)
    assert felt.sum() * dt == pytest.approx(3.0 * 0.05 * 16.0 / 30.0, rel=0.04)  # N s; the hand moves by steps
    assert np.abs(felt[-20:]).max() < 0.02


@pytest.mark.thorough
@pytest.mark.parametrize("frequency", [0.5, 4.0, 10.0])
def test_a_shake_swings_with_its_force_and_frequency_until_it_is_let_go(session, frequency):
    up(session)
    say(session, "force", force=(2.0, 0.0, 0.0), point=(0.0, 0.0, 0.0), frequency=frequency)
    felt, dt = pulses_felt(session, 4.0), session.flight.dt
    half = (np.arange(len(felt)) + 1.0) * dt * 2.0 * frequency
    n, s = np.divmod(half, 1.0)
    assert felt == pytest.approx(np.where(n % 2 == 0, 32.0, -32.0) * (s * (1.0 - s)) ** 2, abs=0.06)
    say(session, "release")
    assert np.abs(pulses_felt(session, 2.0)[-50:]).max() < 1e-3


def test_a_shake_that_is_pulled_harder_goes_on_in_its_phase(session):
    up(session)
    for force in (1.0, 1.0, 2.0):
        say(session, "force", force=(force, 0.0, 0.0), point=(0.0, 0.0, 0.0), frequency=1.0)
        felt = pulses_felt(session, 0.25)  # the second ends with the first half of a period, the third with its peak
    assert felt[-1] == pytest.approx(-2.0, abs=0.1)


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


def test_where_it_may_not_be_grabbed_nothing_else_of_the_flight_is_looked_at(session, monkeypatch):
    fly(session, 1.0)
    monkeypatch.setattr(session, "_values", lambda: pytest.fail("the values of a frame, for a grab beside the vehicle"))
    for at in ("point", "centre"):
        with pytest.raises(tl.InputError, match="must be on the vehicle"):
            say(session, "grab", point=(0.0, 9.0, 0.0), target=(0.0, 0.0, 1.0), at=at)


def test_a_mission_that_is_guided_by_the_clock_says_that_it_asks_nobody(session):
    session._mission = tl.load_mission("paper")
    for request in ({"kind": "ask", "what": "stop"}, {"kind": "enable", "on": False}):
        with pytest.raises(tl.InputError, match="scheduled"):
            say(session, **request)


@pytest.mark.parametrize("kind", ["grab", "force"])
def test_a_hand_touches_the_vehicle_and_not_the_air_beside_it(session, kind):
    up(session)
    rest = {"grab": {"target": (0.0, 0.0, 0.0), "at": "point"}, "force": {"force": (1.0, 0.0, 0.0)}}[kind]
    with pytest.raises(tl.InputError, match=r"point = .*: must be on the vehicle, within"):
        say(session, kind, point=(0.0, 9.0, 0.0), **rest)
    say(session, kind, point=(0.0, 0.9, 0.0), **rest)
