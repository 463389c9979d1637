"""A flight that is recorded while it is flown flies again to the last bit."""

import numpy as np
import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.apps.live.session.saving import save_in_process
from tandemlift.core.files import FLIGHT_FILE
from tandemlift.core.vector import Vec3
from tandemlift.missions.recording import HAND_FILE, MISSION_FILE
from tandemlift.parts.person.virtual_hand import HAND_RELEASED
from tandemlift.simulation.recorded_flight import RecordedFlight

GUIDED = {
    "pilot.guidance": "interactive",
    "phases.rotors": "flight",
    "ground.model": "floor",
    "compliance.yaw.model": "compliant",
}


def started(engine="compiled", **keys):
    return RecordedFlight(interactive_mission(tl.load_mission("hover", GUIDED | keys)), engine)


def fly(flight, seconds):
    while flight.step * flight.dt < seconds and not flight.over:
        flight.advance()


def change(flight, key, value, duration=0.0):
    flight.change(flight.prepare(key, value, duration), key, value, duration)


def pulled_about(flight, seconds, seed=0):
    """Somebody pulls, pushes, lets go and turns knobs, at random."""
    chance = np.random.default_rng(seed)
    while flight.step * flight.dt < seconds and not flight.over:
        fly(flight, flight.step * flight.dt + chance.uniform(0.001, 0.4))
        hand = HAND_RELEASED._replace(
            held=float(chance.random() < 0.6),
            grip=Vec3(0.0, chance.uniform(-1, 1), 0.0),
            target=Vec3(*chance.uniform(-1, 1, 3)),
            force=Vec3(*chance.uniform(-2, 2, 3)) if chance.random() < 0.3 else Vec3(0.0, 0.0, 0.0),
        )
        flight.hold(hand)
        if chance.random() < 0.2:
            change(flight, "admittance.damping", chance.uniform(1, 5, 3).tolist(), chance.uniform(0, 1))
        if chance.random() < 0.1:
            change(flight, "controller.gains.xi", chance.uniform(0.5, 2), 0.3)


def assert_flies_again(folder):
    saved = tl.Flight.load(folder / FLIGHT_FILE)
    again = tl.fly(tl.load_mission(folder / MISSION_FILE))
    assert list(saved.channels) == list(again.channels)
    for channel in saved.channels:
        np.testing.assert_array_equal(saved[channel], again[channel], channel)
    np.testing.assert_array_equal(saved.time, again.time)
    took = {"wall_s"}
    assert {k: v for k, v in saved.results.items() if k not in took} == {
        k: v for k, v in again.results.items() if k not in took
    }
    assert saved.mission == again.mission
    return again


def test_what_was_flown_by_hand_flies_again_to_the_last_bit(tmp_path):
    flight = started()
    pulled_about(flight, 4.0)
    flight.snapshot().save(tmp_path)
    again = assert_flies_again(tmp_path)
    assert np.abs(again["push_force"]).max() > 1.0
    assert again.metrics()["steps"] == flight.step - 1


def test_in_the_other_engine_too_which_the_recording_names(tmp_path):
    pytest.importorskip("mujoco")
    flight = started("mujoco")
    pulled_about(flight, 6.0)
    flight.snapshot().save(tmp_path)
    assert_flies_again(tmp_path)


def test_it_is_saved_while_it_goes_on_and_goes_on_as_if_it_had_not_been(tmp_path):
    flight, other = started(), started()
    for one in (flight, other):
        pulled_about(one, 3.0)
    snapshot = flight.snapshot()
    for one in (flight, other):
        pulled_about(one, 5.0, 7)
    snapshot.save(tmp_path / "early")
    flight.snapshot().save(tmp_path / "late")
    other.snapshot().save(tmp_path / "other")
    assert_flies_again(tmp_path / "early")
    late, same = (tl.Flight.load(tmp_path / name / FLIGHT_FILE) for name in ("late", "other"))
    np.testing.assert_array_equal(late["position"], same["position"])


def test_another_controller_from_one_step_to_the_next_is_recorded_too(tmp_path):
    flight = started()
    pulled_about(flight, 3.0)
    change(flight, "controller.name", "pid")
    pulled_about(flight, 5.0, 3)
    flight.snapshot().save(tmp_path)
    again = assert_flies_again(tmp_path)
    assert "controller.name" in [c["key"] for c in again.mission["changes"]]


def test_a_flight_that_is_lost_is_saved_as_far_as_it_came(tmp_path):
    flight = started()
    fly(flight, 2.0)
    change(flight, "controller.gains.xi", 1e9)
    change(flight, "controller.gains.lambda_1", 1e9)
    fly(flight, 8.0)
    assert flight.lost
    flight.snapshot().save(tmp_path)
    again = assert_flies_again(tmp_path)
    assert again.ending is not None


def test_nothing_flown_is_nothing_to_save():
    with pytest.raises(tl.InputError, match="nothing was flown yet"):
        started().snapshot()


@pytest.fixture(scope="module")
def snapshot():
    """A flight of a second."""
    flight = started()
    pulled_about(flight, 1.0)
    return flight.snapshot()


def test_its_files_may_be_moved_and_what_is_flown_again_names_no_folder_of_the_machine(snapshot, tmp_path):
    snapshot.save(tmp_path / "here")
    (tmp_path / "here").rename(tmp_path / "there")
    (tmp_path / "here").mkdir()
    mission = str(tmp_path / "there" / MISSION_FILE)
    assert sorted(p.name for p in (tmp_path / "there").iterdir()) == sorted([MISSION_FILE, HAND_FILE, FLIGHT_FILE])
    assert tl.load_mission(mission).person.recording == str(tmp_path / "there" / HAND_FILE)
    assert CliRunner().invoke(cli, ["run", mission, "--no-figures", "--out", str(tmp_path / "here")]).exit_code == 0
    for folder in ("here", "there"):
        for file in (tmp_path / folder).iterdir():
            assert str(tmp_path).encode() not in file.read_bytes(), file
        assert tl.Flight.load(tmp_path / folder / FLIGHT_FILE).mission["person"]["recording"] == HAND_FILE
    again = tl.load_mission(tmp_path / "here" / "mission.toml")
    assert again.person.recording == str(tmp_path / "here" / HAND_FILE)


def test_saved_aside_it_is_the_same_flight(snapshot, tmp_path):
    save_in_process(snapshot, tmp_path / "aside")
    assert sorted(p.name for p in (tmp_path / "aside").iterdir()) == sorted([MISSION_FILE, HAND_FILE, FLIGHT_FILE])
    assert_flies_again(tmp_path / "aside")
    before = {file: file.read_bytes() for file in (tmp_path / "aside").iterdir()}
    with pytest.raises(tl.InputError, match="aside: the name is taken: choose another"):
        save_in_process(snapshot, tmp_path / "aside")
    assert {file: file.read_bytes() for file in (tmp_path / "aside").iterdir()} == before


def test_a_flight_that_cannot_be_saved_aside_is_told_of(snapshot, tmp_path, monkeypatch):
    monkeypatch.setattr("sys.executable", "false")
    with pytest.raises(RuntimeError, match="could not be saved"):
        save_in_process(snapshot, tmp_path / "aside")
