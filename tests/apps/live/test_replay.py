"""A flight again in the live page: frames are the flight's channels, and a page that stands alone stands alone."""

import base64
import dataclasses
import hashlib
import itertools
import json
import os
import re
import signal
import subprocess
import sys
import textwrap
import urllib.request

import numpy as np
import pytest
from html_page import Page
from live_page import PAGE, Running, put_page
from patience import PATIENCE, said
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.apps.live import page_files as pages
from tandemlift.apps.live.page_files import page_files
from tandemlift.apps.live.replay import replay_files, replay_html, scene_and_frames
from tandemlift.apps.live.server import PageServer
from tandemlift.apps.live.session.frames import read_frames
from tandemlift.apps.live.session.scene_builder import scene_of
from tandemlift.engines.models.visuals import FRONT, REAR


@pytest.fixture(scope="module")
def flight():
    later = {"time": 15.5, "key": "admittance.damping", "value": 9.0}
    changes = {"pushes.0.point": [0.3, -0.7, 0.1], "mission.duration": 16.0, "changes": [later]}
    return tl.fly(tl.load_mission("one-push", changes))


@pytest.fixture
def page(tmp_path, monkeypatch):
    folder = put_page(tmp_path / "site" / "page")
    monkeypatch.setattr(pages, "PAGE_FOLDER", folder)
    return folder


def embedded(text):
    """Scene and frames in a page."""
    ((_, data),) = Page(text).of("script", id="flight")
    found = json.loads(data)
    return found["scene"], base64.b64decode(found["frames"])


# Frames


def test_frames_are_the_channels_of_the_flight_to_the_last_bit_of_float32(flight):
    scene, frames = scene_and_frames(flight)
    found = read_frames(tuple(map(tuple, scene["fields"])), frames.tobytes())
    at = np.searchsorted(flight.time, found["time"][:, 0] - 1e-4)
    assert np.array_equal(found["time"][:, 0], flight.time[at].astype("<f4"))
    for field, channel in {
        "position": "position",
        "attitude": "attitude",
        "velocity": "velocity",
        "reference": "reference_position",
        "push": "push_force",
        "pilot_push": "push_force",
        "thrusts": "rotor_thrusts",
    }.items():
        assert np.array_equal(found[field], flight[channel][at].astype("<f4")), field
    assert np.array_equal(found["reference_yaw"][:, 0], flight["reference_euler"][at, 2].astype("<f4"))
    for field in ("disturbance", "wind", "alarm", "held", "hand_point", "hand_target", "seq"):
        assert not found[field].any()


def test_there_are_sixty_frames_a_second_at_most_and_they_span_the_flight(flight):
    scene, frames = scene_and_frames(flight)
    assert np.diff(frames[:, 0]).min() > 1.0 / 60.0
    span = {"start": 0.0, "end": pytest.approx(16.0, abs=0.02), "speed": 1, "ending": None}
    assert scene["replay"] == span | {"findings": [], "changes": [{"time": 15.5, "text": "admittance.damping = 9.0"}]}
    assert frames[-1, 0] == np.float32(scene["replay"]["end"])


def test_a_coarse_log_is_shown_as_it_is(flight):
    coarse = dataclasses.replace(
        flight, time=flight.time[::10], channels={n: c[::10] for n, c in flight.channels.items()}
    )
    assert len(scene_and_frames(coarse)[1]) == len(coarse.time)


def test_a_push_acts_where_the_mission_says_as_seen_across_it(flight):
    scene, frames = scene_and_frames(flight)
    found = read_frames(tuple(map(tuple, scene["fields"])), frames.tobytes())
    pushed = np.linalg.norm(found["push"], axis=1) > 0.1
    assert pushed.sum() > 20
    w, x, y, z = found["attitude"][pushed].T
    force = Rotation.from_quat(np.column_stack([x, y, z, w])).inv().apply(found["push"][pushed])
    along = force / np.linalg.norm(force, axis=1)[:, None]
    expected = np.array([0.3, -0.7, 0.1]) - along * (along @ [0.3, -0.7, 0.1])[:, None]
    assert np.allclose(found["push_point"][pushed], expected, atol=1e-4)
    assert not found["push_point"][~pushed][found["push"][~pushed].any(axis=1) == 0].any()


def test_what_a_pilot_by_hand_shows_is_shown(flight):
    n = len(flight.time)
    more = {
        "phase": np.full(n, 3.0),
        "alarm": np.full(n, 41.0),
        "push_filtered": np.full((n, 3), 0.5),
        "disturbance_force": np.full((n, 3), 0.25),
        "wind_velocity": np.full((n, 3), 2.0),
    }
    scene, frames = scene_and_frames(dataclasses.replace(flight, channels={**flight.channels, **more}))
    last = {
        name: values[-1].tolist() for name, values in read_frames(tuple(map(tuple, scene["fields"])), frames).items()
    }
    assert scene["phases"][int(last["phase"][0])] == "land"
    assert scene["alarms"][int(last["alarm"][0])] == "gyroscope frozen"
    assert last["pilot_push"] == [0.5] * 3
    assert last["disturbance"] == [0.25] * 3
    assert last["wind"] == [2.0] * 3


@pytest.mark.parametrize(("rotors", "before"), [("always", "hold"), ("flight", "idle")])
def test_phases_by_the_clock_are_those_of_the_mission(flight, rotors, before):
    clock = {"lift_start": 2.0, "lift_duration": 3.0, "height": 1.0, "land_start": 10.0, "land_duration": 2.0}
    clock["rotors"] = rotors
    lifted = dataclasses.replace(flight, mission={**flight.mission, "phases": clock})
    scene, frames = scene_and_frames(lifted)
    found = read_frames(tuple(map(tuple, scene["fields"])), frames.tobytes())
    names = {t: scene["phases"][int(found["phase"][np.searchsorted(found["time"][:, 0], t), 0])] for t in (1, 3, 6, 12)}
    assert names == {1: before, 3: "lift", 6: "guided", 12: "land"}


def test_samples_that_are_no_numbers_are_left_out(flight):
    broken = {name: channel.copy() for name, channel in flight.channels.items()}
    for channel in broken.values():
        channel[1000:] = np.nan
    _, frames = scene_and_frames(dataclasses.replace(flight, channels=broken))
    assert np.isfinite(frames).all()
    assert frames[-1, 0] < flight.time[1000]


# The scene


def test_a_scene_is_the_vehicle_of_the_mission():
    mission = tl.load_mission("zigzag")
    scene = json.loads(json.dumps(scene_of(mission, "compiled"), allow_nan=False))
    vehicle = scene["vehicle"]
    assert vehicle["mass"] == 3.5
    assert [len(q["rotors"]) for q in vehicle["quadrotors"]] == [4, 4]
    # the centre of mass of all parts is where the axes begin
    parts = [(1.5, q["position"]) for q in vehicle["quadrotors"]] + [(0.5, vehicle["payload"]["position"])]
    assert np.allclose(sum(m * np.array(p) for m, p in parts), 0.0, atol=1e-12)
    first = vehicle["quadrotors"][0]
    assert np.allclose(np.array(first["rotors"][0]["position"]) - first["position"], [0.13, -0.22, 0.0])
    assert first["rotors"][0]["max_thrust"] == pytest.approx(5.84e-6 * 1100.0**2)
    assert [r["spin"] for r in first["rotors"]] == [-1, -1, 1, 1]
    assert scene["ground"] is True
    assert scene["floor"] == pytest.approx(0.03 + first["position"][2] - 0.18, abs=1e-3)  # it stands on its feet
    assert scene["threshold"] == list(mission.admittance.threshold)
    assert scene["fields"][-1] == ["thrusts", 8]


def test_the_shapes_of_a_scene_are_where_the_vehicle_has_its_parts():
    mission = tl.load_mission("zigzag")
    vehicle = scene_of(mission, "compiled")["vehicle"]
    beam, payload = vehicle["shapes"][0], vehicle["payload"]
    ends = np.array(beam["position"]) + np.outer([0.5, -0.5], beam["size"][1] * np.array(beam["axes"][6:]))
    assert np.allclose(ends - payload["position"], [[0.0, payload["length"] / 2.0, 0.0], [0.0, -1.0, 0.0]], atol=1e-6)
    for quadrotor in vehicle["quadrotors"]:
        for rotor in quadrotor["rotors"]:
            assert np.allclose(np.subtract(rotor["blades"]["position"], rotor["position"])[:2], 0.0, atol=1e-6)
            assert rotor["blades"]["position"] == rotor["disc"]["position"]
            assert rotor["disc"]["size"][0] == rotor["radius"]
            front = rotor["position"][0] > quadrotor["position"][0]
            assert rotor["disc"]["color"] == (FRONT if front else REAR)
    feet = [shape["position"] for shape in vehicle["shapes"] if shape["kind"] == "sphere"]
    spread, depth = mission.vehicle.quadrotors[0].feet_spread, mission.vehicle.quadrotors[0].feet_depth
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * spread
    soles = [np.add(q["position"], [x, y, -depth]) for q in vehicle["quadrotors"] for x, y in corners]
    assert np.allclose(feet, soles, atol=0.01)


def test_the_walls_of_a_scene_are_half_a_width_from_the_centreline():
    scene = scene_of(tl.load_mission("zigzag"), "compiled")
    line = np.array(scene["corridor"]["centreline"])
    assert len(scene["walls"]) == 2 * (len(line) - 1)
    for (a, b), wall in zip(2 * list(itertools.pairwise(line)), scene["walls"], strict=True):
        along = (b - a) / np.linalg.norm(b - a)
        assert np.allclose([np.cos(wall["heading"]), np.sin(wall["heading"])], along)
        x, y, z = wall["center"]
        away = np.array([x, y]) - a
        assert abs(along[0] * away[1] - along[1] * away[0]) == pytest.approx(2.0)
        assert z - wall["size"][2] / 2.0 == pytest.approx(scene["floor"])
        assert z + wall["size"][2] / 2.0 == pytest.approx(2.5)


# Pages


def test_a_page_that_stands_alone_refers_to_nothing_and_may_load_nothing(flight):
    text = replay_html(flight, {f"/{name}": content for name, content in PAGE.items()})
    read = Page(text)
    for tag, attrs in read.elements:
        assert not {"src", "href", "srcset", "action", "data"} & attrs.keys(), tag
    assert not re.search(r"(https?|wss?|ftp):", text)
    heads = [t for t, a in read.elements]
    assert heads.index("meta") < heads.index("script")
    assert read.policy.startswith("default-src 'none'; ")
    assert "connect-src" not in read.policy  # so the default holds
    ((_, script),) = read.of("script", type="module")
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}';" in read.policy
    assert script.strip().endswith('[end, comment, "ä"];')
    assert len(read.of("style")) == 1
    assert "margin: 0" in read.of("style")[0][1]


def test_a_page_that_stands_alone_holds_the_frames(flight):
    scene, frames = scene_and_frames(flight)
    files = {f"/{name}": content for name, content in PAGE.items()}
    for text in (replay_html(flight, files), replay_files(flight, files)["/"].decode()):
        found, data = embedded(text)
        assert found == json.loads(json.dumps(scene))
        assert data == frames.tobytes()
        order = [(t, a.get("id")) for t, a in Page(text).elements if t == "script"]
        assert order == [("script", "flight"), ("script", None)]


def test_no_name_of_a_mission_ends_the_data(flight):
    name = "</script><script>alert(1)</script><!--"
    named = dataclasses.replace(
        flight, mission={**flight.mission, "mission": {**flight.mission["mission"], "name": name}}
    )
    text = replay_html(named, {f"/{n}": content for n, content in PAGE.items()})
    assert embedded(text)[0]["mission"] == name
    assert len(Page(text).of("script")) == 2


def test_a_replay_is_served_without_a_socket(flight, page):
    server = Running(PageServer(replay_files(flight, page_files()), port=0))
    try:
        status, headers, body = server.get("/")
        assert (status, headers["Content-Type"]) == (200, "text/html; charset=utf-8")
        assert embedded(body.decode())[0]["replay"]["end"] > 15.0
        assert server.get("/page.js")[2] == PAGE["page.js"]
        assert server.get("/ws", Origin=f"http://{server.host}")[0] == 404
    finally:
        server.stop()


# Commands


@pytest.fixture
def run(tmp_path, monkeypatch, page):
    from click.testing import CliRunner

    monkeypatch.chdir(tmp_path)
    return lambda *arguments: CliRunner().invoke(cli, arguments)


def test_replay_writes_a_page_of_a_saved_flight_or_its_folder(flight, run, tmp_path):
    flight.save(tmp_path / "out" / "flight.npz")
    for given in ("out", "out/flight.npz"):
        result = run("replay", given, "--html", "pages/one.html")
        assert result.exit_code == 0, result.output
        text = (tmp_path / "pages" / "one.html").read_text("utf-8")
        assert embedded(text)[0]["mission"] == flight.name
        (tmp_path / "pages" / "one.html").unlink()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("replay", "nowhere"), "nowhere: there is no flight.npz"),
        (("replay", "nowhere.npz"), "nowhere.npz: No such file"),
        (("replay", "flight.npz", "--html", "page.txt"), "--html page.txt: must end in .html"),
        (("live", "nowhere"), "unknown mission 'nowhere'"),
        (("live", "--engine", "steam"), "unknown engine 'steam'"),
        (("live", "--out", "flight.npz"), "--out flight.npz: flight.npz is a file, not a folder"),
    ],
)
def test_bad_input_is_refused_in_words(flight, run, tmp_path, arguments, words):
    flight.save(tmp_path / "flight.npz")
    result = run(*arguments)
    assert isinstance(result.exception, tl.InputError)
    assert words in str(result.exception)


def test_without_websockets_it_says_what_to_install(flight, run, tmp_path, monkeypatch):
    flight.save(tmp_path / "flight.npz")
    monkeypatch.setitem(sys.modules, "websockets", None)
    monkeypatch.delitem(sys.modules, "tandemlift.apps.live.server", raising=False)
    for verb in ("live",), ("replay", "flight.npz"):
        assert "pip install 'tandemlift[live]'" in str(run(*verb).exception)
    assert run("replay", "flight.npz", "--html", "one.html").exit_code == 0


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
@pytest.mark.parametrize("verb", ["live", "replay"])
def test_the_address_is_printed_and_ctrl_c_ends_it_well(verb, flight, page, tmp_path):
    flight.save(tmp_path / "flight.npz")
    code = f"""
        import pathlib, sys, types
        from tandemlift.apps.cli.main import main
        from tandemlift.apps.live import page_files as pages
        from standin import StandIn
        pages.PAGE_FOLDER = pathlib.Path({str(page)!r})
        sys.modules["tandemlift.apps.live.session.two_flights"] = flights = types.ModuleType("two_flights")
        flights.TwoFlights = lambda mission, engine, out: StandIn(mission.mission.name)
        main()
    """
    target = {"live": "hover", "replay": "flight.npz"}[verb]
    where = os.pathsep.join([os.path.dirname(__file__), *sys.path])
    process = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(code), verb, target, "--no-browser", "--port", "0"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": where},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        address = said(process, r"http://127\.0\.0\.1:\S+")[0]
        with urllib.request.urlopen(address, timeout=PATIENCE) as answer:
            assert b"page.js" in answer.read()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    assert process.returncode == 0
    assert err == "" or (err.startswith("Compiling") and err.count("\n") == 1)
    assert out.endswith("stopped\n")


def test_a_flight_that_crashed_carries_its_ending():
    tender = {"crash.tilt": 0.02, "promise.tilt": 0.01, "mission.duration": 20.0}
    flight = tl.fly(tl.load_mission("one-push", tender))
    assert flight.ending is not None
    scene, _ = scene_and_frames(flight)
    ending = scene["replay"]["ending"]
    assert ending["text"] == str(flight.ending)
    assert ending["outcome"] == "crashed"
    assert abs(ending["place"][2] - flight["position"][-1, 2]) < 0.1
