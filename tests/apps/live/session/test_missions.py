"""Another mission chosen in a session: a built-in one, or the content of a file."""

import numpy as np
import pytest
from as_toml import to_toml
from repository import ROOT
from sessions import fly, say

import tandemlift as tl
from tandemlift.apps.cli import live as command
from tandemlift.apps.live import server
from tandemlift.apps.live.session.session import Session
from tandemlift.missions import built_in
from tandemlift.parts.controllers import load_controller

MINE = 'extends = "iris"\n[mission]\nname = "mine"\n[admittance]\nmass = 2.5\n'


def values(session):
    return {one["key"]: (one["value"], one.get("initial")) for one in session.scene["parameters"]}


@pytest.mark.thorough
def test_a_chosen_mission_flies_as_if_the_session_had_begun_with_it(session, tmp_path):
    fly(session, 0.5)
    say(session, "set", key="admittance.mass", value=3.0)
    before = session.generation
    assert say(session, "fly", mission="iris") == [{"type": "done", "what": "fly", "detail": "iris"}]
    assert session.generation == before + 1
    other = Session(tl.load_mission("iris"), out=tmp_path)
    other.prepare()
    assert session.scene == other.scene
    for one in (session, other):
        say(one, "ask", what="lift")
        fly(one, 3.0)
    np.testing.assert_array_equal(session.flight.sample.view(np.int64), other.flight.sample.view(np.int64))
    other.stop()


def test_a_vehicle_with_more_rotors_and_another_step_takes_over(session):
    text = to_toml(tl.load_mission("four", {"mission.step": 0.002}))
    say(session, "fly", mission="more.toml", toml=text)
    assert len(session.scene["vehicle"]["quadrotors"]) == 4
    assert session.pacer.dt == session.flight.dt == session.scene["step"] == 0.002
    fields = session.scene["fields"]
    assert len(session.frame()) == 4 * sum(count for _, count in fields)


@pytest.mark.thorough
def test_values_are_restored_to_those_of_the_file_and_a_reset_begins_it_again(session):
    say(session, "fly", mission="mine.toml", toml=MINE)
    assert session.scene["mission"] == "mine"
    assert values(session)["admittance.mass"] == ([2.5] * 3, [2.5] * 3)
    say(session, "set", key="admittance.mass", value=4.0)
    say(session, "restore")
    assert values(session)["admittance.mass"][0] == [2.5] * 3
    say(session, "reset")
    assert session.scene["mission"] == "mine"


@pytest.mark.parametrize(
    ("mission", "toml", "reason"),
    [
        ("irs", None, "unknown mission 'irs'; there are crazyflie-stick, .* Did you mean 'iris'\\?"),
        ("photo.png", "\ufffdPNG\r\n", "photo.png is not valid TOML"),
        ("mine.toml", MINE + "mas = 2", "mine.toml: admittance.mas = 2: unknown key.* Did you mean admittance.mass\\?"),
        ("mine.toml", 'extends = "../other.toml"', "mine.toml: extends = .*: must be a built-in mission"),
        ("mine.toml", "extends = 3", "mine.toml: extends = 3: must be a built-in mission"),
        ("mine.toml", MINE + '[person]\nrecording = "/etc/hosts"', "mine.toml: person.recording: must be left out"),
        ("mine.toml", "a" + ".a" * 5_000 + " = 1", "parts"),
        ("mine.toml", "a = " + "[" * 5_000, "nested too deeply|not valid TOML"),
    ],
)
def test_what_cannot_be_flown_says_why_and_the_flight_goes_on(session, mission, toml, reason):
    flight = session.flight
    with pytest.raises(tl.InputError, match=reason):
        say(session, "fly", mission=mission, toml=toml)
    assert session.flight is flight
    assert session.generation == 1
    fly(session, 0.1)


def test_the_scene_offers_every_built_in_mission(session):
    assert {one["name"]: one["title"] for one in session.scene["missions"]} == dict(built_in())


def test_the_command_flies_a_controller_of_a_file(tmp_path, monkeypatch):
    file = tmp_path / "mine.py"
    file.write_text((ROOT / "examples" / "my_controller.py").read_text("utf-8"), "utf-8")
    served = []
    monkeypatch.setattr(server, "serve_until_interrupt", lambda page, what, say, browser: served.append(page._flight))
    monkeypatch.setattr(command, "exit_now", lambda status: None)
    command.live.callback("hover", "compiled", 0, "127.0.0.1", str(tmp_path), True, (), str(file))
    name = next(one for one in served[0].scene["parameters"] if one["key"] == "controller.name")
    assert name["value"] == load_controller(str(file)).name
    assert name["value"] in name["choices"]
