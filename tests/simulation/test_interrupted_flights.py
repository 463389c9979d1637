"""Flights whose engine ends, or no longer answers, beside a plugin that stands in: what was flown is kept."""

import json
from xml.etree import ElementTree

import numpy as np
import pytest
from patience import COMPILING, until
from plugin_peer import HEADER, STEP, Plugin, RigidBody
from ros_processes import SETTINGS
from ros_trial import GUIDED, Middleware

import tandemlift as tl
from tandemlift.analysis.studies.execution.flying import fly_each
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.apps.live.session.page_messages import ResetMessage
from tandemlift.apps.live.session.session import Session
from tandemlift.engines import gazebo
from tandemlift.engines.registry import EngineLost
from tandemlift.simulation.recorded_flight import RecordedFlight

DT, LAST = 1e-3, 150  # s; the last step that the plugin takes
SHORT = {"mission.duration": 0.4, "mission.log_interval": DT, "initial.euler": [0.1, -0.1, 0.3]}
REASONS = {  # how it is lost, and what is said of it
    "ends": "nothing listens at UDP port {port} any more: Gazebo has ended",
    "is silent": "the plugin on UDP port {port} did not answer within 2 s (STEP 151)",
    "gives the pilot up": "the plugin refuses step 151: the session is over: Gazebo has dropped this pilot",
}


class LostPlugin(Plugin):
    """A plugin that is lost after some steps."""

    def __init__(self, how="ends", last=LAST, **more):
        self.how, self.last = how, last
        vehicle = tl.Vehicle.from_settings(tl.load_mission("hover").vehicle)
        super().__init__(RigidBody(vehicle), DT, **more)

    def _answer(self, message):
        *_, kind, _, _, sequence = HEADER.unpack_from(message)
        if kind == STEP and sequence > self.last:
            if self.how == "gives the pilot up":
                self.session = None
            elif self.how == "is silent":
                return b""
            else:
                self.closed = True
                self.socket.close()
                return b""
        return super()._answer(message)


@pytest.fixture
def lost(monkeypatch):
    """Makes a plugin that is lost, for the next flight to join."""
    plugins = []

    def make(*given, **named):
        plugins.append(LostPlugin(*given, **named))
        monkeypatch.setenv("TANDEMLIFT_GAZEBO_PORT", str(plugins[-1].port))
        return plugins[-1]

    yield make
    for plugin in plugins:
        plugin.close()


def settings(changes):
    return [f"--set={key}={json.dumps(value)}" for key, value in changes.items()]


@pytest.mark.thorough
@pytest.mark.parametrize("how", REASONS)
def test_what_was_flown_until_the_engine_is_lost_is_kept_with_the_reason(how, lost, monkeypatch, tmp_path):
    mission = tl.load_mission("hover", SHORT)
    lost(last=10**6)
    whole = tl.fly(mission, "gazebo")
    monkeypatch.setattr(gazebo, "STEP_TIMEOUT", 2.0 if how == "is silent" else gazebo.STEP_TIMEOUT)
    port = lost(how).port
    flight = tl.fly(mission, "gazebo")
    assert flight.outcome == "interrupted"
    assert flight.failure.startswith(f"interrupted at 0.15 s: engine 'gazebo': {REASONS[how].format(port=port)}")
    assert flight.time.tolist() == whole.time[:LAST].tolist()
    assert all(np.array_equal(flight[name], whole[name][:LAST], equal_nan=True) for name in whole)
    assert flight.metrics()["final_position_m"] == whole["position"][LAST].tolist()
    assert flight.metrics()["failure"] == flight.failure
    saved = tl.Flight.load(flight.save(tmp_path / "flight.npz"))
    assert saved == flight


@pytest.mark.thorough
def test_a_step_that_the_engine_did_not_take_leaves_no_trace_in_the_numbers(lost):
    lost()
    flight = RecordedFlight(interactive_mission(tl.load_mission("hover", GUIDED)), "gazebo")
    before = []
    while not flight.over:
        before.append(flight.numbers())
        flight.advance()
    assert flight.step == LAST
    assert np.array_equal(flight.numbers(), before[-1])


@pytest.mark.thorough
def test_a_crash_after_which_it_flew_on_comes_before_the_interruption(lost):
    lost()
    tilted = {"crash.tilt": 0.15, "promise.tilt": 0.04, "initial.rates": [20.0, 0.0, 0.0]}  # from 0.14 rad on
    flight = tl.fly(tl.load_mission("hover", SHORT | tilted | {"crash.fly_on": 9.0}), "gazebo")
    assert flight.outcome == "crashed"
    assert flight.failure.startswith("crashed at 0.001 s: tilt")
    assert len(flight.time) == LAST


def test_a_simulation_says_so_and_has_what_was_flown(lost):
    lost()
    sim = tl.Simulation(tl.load_mission("hover", SHORT), "gazebo")
    for _ in range(LAST):
        sim.step()
    with pytest.raises(EngineLost, match="Gazebo has ended"):
        sim.step()
    assert (sim.k, sim.over, sim.lost) == (LAST, True, True)
    assert sim.flight().outcome == sim.ending.outcome == "interrupted"
    with pytest.raises(tl.InputError, match=r"interrupted at 0\.15 s: .* reset\(\) begins anew"):
        sim.step()


@pytest.mark.thorough
def test_many_flights_do_not_count_one_that_was_interrupted(lost):
    lost()
    with pytest.raises(EngineLost, match="Gazebo has ended"):
        fly_each([tl.load_mission("hover", SHORT)], "gazebo")
    lost()
    (metrics,) = fly_each([tl.load_mission("hover", SHORT)], "gazebo", interrupted=True)
    assert metrics["outcome"] == "interrupted"


@pytest.mark.thorough
@pytest.mark.parametrize("last", [1, LAST])
def test_run_writes_what_was_flown_and_ends_with_3(last, lost, run, tmp_path):
    lost(last=last)
    plain = ["--no-figures"] * (last > 1)  # figures of one sample are the hardest to draw
    code, _, errors = run("run", "hover", "--engine", "gazebo", "--out", "out", *plain, *settings(SHORT))
    assert code == 3
    assert f"hover: interrupted at {last * DT:g} s: engine 'gazebo': nothing listens" in errors
    assert len(tl.Flight.load(tmp_path / "out/flight.npz").time) == last
    assert "Gazebo has ended" in (tmp_path / "out/report.html").read_text("utf-8")
    assert json.loads((tmp_path / "out/metrics.json").read_text("utf-8"))["outcome"] == "interrupted"


def test_run_writes_nothing_where_nothing_was_flown(lost, run, tmp_path):
    lost(last=0)
    code, _, errors = run("run", "hover", "--engine", "gazebo", *settings(SHORT))
    assert code == 2
    assert "error: engine 'gazebo': nothing listens" in errors
    assert list(tmp_path.rglob("*.npz")) == []


def test_a_page_is_told_why_the_engine_was_lost_and_can_begin_again(lost, tmp_path):
    lost()
    session = Session(tl.load_mission("hover", GUIDED), "gazebo", out=tmp_path)
    session.prepare()
    assert session._fly(2 * LAST) == LAST - 1
    assert session._fly(0) == 0
    status = session.status()
    assert (status["phase"], status["ending"]["outcome"], status["ending"]["time"]) == ("failed", "failed", 0.15)
    assert status["ending"]["text"].startswith("interrupted at 0.15 s: engine 'gazebo': nothing listens")
    assert status["refusals"]["lift"] == "Lift is refused: the flight is over. Begin the flight again."
    lost()
    session.apply(ResetMessage(type="reset", seq=1))
    assert session._fly(10) == 10
    session.stop()


def test_a_page_is_told_in_words_of_an_engine_that_is_lost_before_the_first_step(lost, tmp_path):
    lost(last=0)
    session = Session(tl.load_mission("hover", GUIDED), "gazebo", out=tmp_path)
    session.start()
    until(lambda: session.status()["preparing"]["failure"], "a failure", COMPILING)
    assert session.status()["preparing"]["failure"].startswith("engine 'gazebo': nothing listens")
    session.stop()


class Server:
    """A server that stands in for gzserver: the plugin of its world, which ends in flight."""

    def __init__(self, world, **_):
        port = int(ElementTree.fromstring(world.encode()).findtext(".//plugin[@name='tandemlift']/port"))
        self.plugin, self.master = LostPlugin(port=port), "http://127.0.0.1:1"

    def check(self):
        if self.plugin.closed:
            raise ConnectionError("engine 'gazebo': gzserver has ended (exit code -9)")

    def close(self):
        self.plugin.close()


@pytest.mark.thorough
@pytest.mark.parametrize("options", [["--fast"], ["--by-hand"]])
def test_the_command_gazebo_writes_what_was_flown_and_names_the_end_of_its_server(options, run, tmp_path, monkeypatch):
    monkeypatch.setattr("tandemlift.engines.gazebo.GazeboServer", Server)
    for module in ("gazebo", "gazebo_server"):
        monkeypatch.setattr(f"tandemlift.engines.{module}.root", lambda: None)
    words = ["--no-window", "--no-figures", "--out", "out", "--set=mission.log_interval=0.001"]
    code, _, errors = run("gazebo", "hover", *options, *words)
    assert code == 3
    assert "hover: interrupted at 0.15 s: engine 'gazebo': gzserver has ended (exit code -9)" in errors
    assert len(tl.Flight.load(tmp_path / "out/flight.npz").time) == LAST


@pytest.fixture
def middleware(monkeypatch):
    """What `tandemlift ros` connects to."""
    one = Middleware()
    monkeypatch.setattr("tandemlift.apps.ros.node.middleware_for", lambda *_, **__: one)
    return one


@pytest.mark.thorough
def test_the_node_says_why_the_engine_was_lost_and_saves_what_was_flown(lost, run, middleware, tmp_path):
    lost()
    code, _, errors = run("ros", "hover", "--version", "2", "--engine", "gazebo", "--save", "saved", *SETTINGS)
    reason = "interrupted at 0.15 s: engine 'gazebo': nothing listens"
    assert code == 3
    assert f"hover: {reason}" in errors
    assert "Traceback" not in errors
    assert any(words.startswith(reason) for words in middleware.logged)
    assert tl.Flight.load(tmp_path / "saved/flight.npz").failure.startswith(reason)
    assert tl.load_mission(tmp_path / "saved/recorded.toml").mission.steps == LAST


def test_the_node_saves_before_it_disconnects_from_a_ros_that_is_gone(run, middleware, tmp_path, monkeypatch):
    def gone():
        raise ConnectionError("the ROS master at http://127.0.0.1:11311 is gone: Connection refused")

    class Ending(type(middleware)):
        @property
        def over(self):
            return len(self.channels["/tandemlift/odometry"].sent) > 5

        @over.setter
        def over(self, _): ...

    middleware.__class__, middleware.shutdown = Ending, gone
    code, _, errors = run("ros", "hover", "--version", "2", "--save", "saved", *SETTINGS)
    assert code == 3
    assert "hover: the ROS master at http://127.0.0.1:11311 is gone: Connection refused" in errors
    assert tl.Flight.load(tmp_path / "saved/flight.npz").outcome == "flying"
