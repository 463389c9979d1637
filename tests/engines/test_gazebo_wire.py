"""The pilot's end of the wire to Gazebo, beside a plugin that stands in for the real one."""

import gc
import itertools
import signal
import subprocess
import sys
import threading
from xml.etree import ElementTree

import numpy as np
import pytest
from patience import PATIENCE, ended, said
from plugin_peer import WALL, BadNetwork, Plugin, RigidBody, Surface
from scipy.spatial.transform import Rotation
from ten_crashes import CRASHES, crashed_in

import tandemlift as tl
from tandemlift.engines.gazebo import GazeboBody, start_state_from, world_from
from tandemlift.engines.gazebo_server import free_port, shell_command_for_user
from tandemlift.engines.gazebo_wire import Wire
from tandemlift.engines.models.sdf import rotors_of

DT = 1e-3
MISSION = {
    "mission.duration": 0.35,
    "mission.log_interval": DT,
    "initial.euler": [0.1, -0.1, 0.3],
    "initial.rates": [0.2, 0.1, -0.3],
    "pushes": [{"force": [2.0, 1.0, -1.0], "time": 0.2, "sigma": 0.1, "point": [0.1, 0.9, 0.0]}],
    "disturbance.force": [0.3, -0.2, 0.1],
    "disturbance.moment": [0.02, 0.01, -0.03],
    "wind.model": "air",
    "wind.velocity": [3.0, -2.0, 0.5],
}


@pytest.fixture(scope="module")
def mission():
    return tl.load_mission("one-push", MISSION)


@pytest.fixture(scope="module")
def vehicle(mission):
    return tl.Vehicle.from_settings(mission.vehicle)


@pytest.fixture
def joined(monkeypatch):
    """Flies a mission in the plugin that stands in."""

    def fly(mission, plugin):
        monkeypatch.setenv("TANDEMLIFT_GAZEBO_PORT", str(plugin.port))
        return tl.fly(mission, engine="gazebo")

    return fly


@pytest.fixture
def wire_at():
    """A pilot's end to a port, which is hung up after the test."""
    wires = []

    def connect(port, count=2, patience=PATIENCE):
        wires.append(Wire(port, count, patience))
        return wires[-1]

    yield connect
    for wire in wires:
        wire.close()


@pytest.fixture
def wire_to(wire_at):
    """A pilot's end to a plugin that it has greeted."""

    def connect(plugin, patience=PATIENCE):
        wire = wire_at(plugin.port, plugin.body.N, patience)
        wire.hello(DT, rotors_of(plugin.body.vehicle), start_state_from(tl.load_mission("hover")))
        return wire

    return connect


def fly_by(wire, steps):
    """A flight of that many steps, with other thrusts at each; the states."""
    states = []
    for k in range(steps):
        wire.thrusts[:] = 4.3 + 0.3 * np.sin(0.7 * k + np.arange(wire.thrusts.size))
        states.append(wire.advance().state.copy())
    return np.array(states)


@pytest.mark.thorough
def test_a_mission_flies_over_the_wire_as_in_the_compiled_engine(mission, vehicle, joined):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        a, b = tl.fly(mission), joined(mission, plugin)
        assert plugin.taken == list(range(1, mission.mission.steps + 2))
    assert b.version["engine"] == "gazebo"
    assert np.abs(a["rates"]).max() > 0.3
    assert np.ptp(a["joint_force"], axis=0).max() > 1.0
    for name, tolerance in (("position", 1e-7), ("attitude", 1e-6), ("rates", 1e-4), ("velocity", 1e-5)):
        np.testing.assert_allclose(b[name], a[name], rtol=0.0, atol=tolerance, err_msg=name)
    for name in ("joint_force", "joint_torque"):  # the push's mean over a step beside its start
        np.testing.assert_allclose(b[name], a[name], rtol=0.0, atol=0.02, err_msg=name)


@pytest.mark.thorough
def test_a_push_that_the_plugin_reports_is_a_push_of_the_flight(mission, vehicle, joined):
    alone = tl.fly(mission)
    said = {101: "force 3 0 -1 point 0.1 0.9 0.2 duration 0.15", 201: "force 0 2 0 duration 60", 301: "off"}
    with Plugin(RigidBody(vehicle), DT, said=said) as plugin:
        pushed = joined(mission, plugin)
    force = np.zeros((mission.mission.steps + 1, 3))
    force[100:250] += [3.0, 0.0, -1.0]
    force[200:300] += [0.0, 2.0, 0.0]
    np.testing.assert_allclose(pushed["push_force"] - alone["push_force"], force, rtol=0.0, atol=1e-12)
    more = np.subtract(pushed.metrics()["human_impulse_n_s"], alone.metrics()["human_impulse_n_s"])
    np.testing.assert_allclose(more, [0.45, 0.2, -0.15], rtol=0.0, atol=1e-9)
    first, arm = Rotation.from_quat(pushed["attitude"][100], scalar_first=True), [0.1, 0.9, 0.2]
    moment = np.cross(arm, first.inv().apply(force[100]))
    np.testing.assert_allclose((pushed["push_moment"] - alone["push_moment"])[100], moment, rtol=0.0, atol=1e-6)
    gains = [np.diff(flight["velocity"][100:102], axis=0)[0] for flight in (pushed, alone)]
    np.testing.assert_allclose(np.subtract(*gains), force[100] / vehicle.mass * DT, rtol=0.0, atol=1e-6)


@pytest.mark.thorough
def test_touches_that_the_plugin_reports_are_recorded_and_stop_the_rotor(monkeypatch):
    mission = tl.load_mission(
        "iris", CRASHES["flown into a wall with one rotor"] | {"mission.duration": 0.5, "mission.log_interval": DT}
    )
    wall, vehicle = mission.walls[0], tl.Vehicle.from_settings(mission.vehicle)
    (x, y), (to_x, to_y) = wall.start, wall.end
    surface = Surface(WALL, [x, y, 0.0], [y - to_y, to_x - x, 0.0])
    with Plugin(RigidBody(vehicle, surface), DT) as plugin:
        monkeypatch.setenv("TANDEMLIFT_GAZEBO_PORT", str(plugin.port))
        crash = crashed_in("gazebo", mission)
    ours, theirs = crashed_in("compiled", mission).touches[0], crash.touches[0]
    assert (theirs.part, theirs.surface) == (ours.part, ours.surface) == ("rotor 3 of quadrotor 1", "wall")
    assert theirs.time == pytest.approx(ours.time, abs=0.02)
    np.testing.assert_allclose(theirs.place, ours.place, rtol=0.0, atol=0.05)
    force = np.linalg.norm(crash.flight["contact_force"], axis=1)
    assert theirs.force == pytest.approx(force.max())
    assert theirs.impulse == pytest.approx(force.sum() * DT)
    thrust, time = crash.flight["rotor_thrusts"], crash.flight.time
    assert (thrust[time > theirs.time + 2 * DT, 2] == 0.0).all()
    assert (thrust[time < theirs.time] > 0.0).all()


@pytest.mark.thorough
def test_what_is_lost_doubled_late_or_spoiled_on_the_way_changes_no_bit(vehicle, wire_to):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        sound = fly_by(wire_to(plugin), 100)
    network = BadNetwork(3)
    with Plugin(RigidBody(vehicle), DT, network=network) as plugin:
        bad = fly_by(wire_to(plugin), 100)
        assert plugin.taken == list(range(1, 101))
    assert network.counts.min() > 10
    assert np.array_equal(bad, sound)


def test_a_pilot_that_rests_says_so_and_moves_nothing(vehicle, wire_to):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        wire = wire_to(plugin)
        fly_by(wire, 3)
        for _ in range(20):
            wire.keep_alive()
        fly_by(wire, 1)
        assert plugin.taken == [1, 2, 3, 4]
        assert plugin.heard[-21:] == [3] * 21


def test_a_pilot_that_comes_back_takes_the_vehicle_over_where_it_is(vehicle, wire_to, wire_at):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        last = fly_by(wire_to(plugin), 20)[-1]  # and it goes without a word
        again = wire_at(plugin.port)
        np.testing.assert_array_equal(again.hello(DT, rotors_of(vehicle)).state, last)
        fly_by(again, 5)
        assert len(plugin.taken) == 25


def test_a_pilot_whose_place_was_taken_is_told(vehicle, wire_to):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        first = wire_to(plugin)
        fly_by(first, 3)
        wire_to(plugin)
        with pytest.raises(ConnectionError, match=r"refuses step 4: the session is over: .* another one has connected"):
            first.advance()


def test_a_server_that_dies_in_flight_ends_it_with_a_clear_error(vehicle, wire_to):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        wire = wire_to(plugin)
        fly_by(wire, 3)
    with pytest.raises(ConnectionError, match=rf"nothing listens at UDP port {plugin.port} any more: Gazebo has ended"):
        wire.advance()


def test_a_server_that_hears_and_says_nothing_is_given_up(vehicle, wire_to):
    with (
        Plugin(RigidBody(vehicle), DT, network=lambda message: []) as plugin,
        pytest.raises(TimeoutError, match=r"did not answer within 0\.3 s \(HELLO 0\)"),
    ):
        wire_to(plugin, 0.3)


def test_a_server_that_comes_late_is_waited_for(vehicle, wire_at):
    port, late = free_port(2), []
    timer = threading.Timer(0.2, lambda: late.append(Plugin(RigidBody(vehicle), DT, port=port)))
    timer.start()
    wire = wire_at(port)
    wire.hello(DT, rotors_of(vehicle))
    assert len(fly_by(wire, 3)) == 3
    timer.join(PATIENCE)
    late[0].close()


def test_an_older_plugin_is_refused_with_both_versions(vehicle, wire_to):
    with (
        Plugin(RigidBody(vehicle), DT, version=7) as plugin,
        pytest.raises(tl.InputError, match=r"speaks version 7 of the protocol, this is version 2: build"),
    ):
        wire_to(plugin)


def test_a_vehicle_with_other_quadrotors_is_refused(vehicle, wire_at):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        wire = wire_at(plugin.port, 3)
        with pytest.raises(tl.InputError, match=r"in Gazebo has 2 quadrotors, the mission's has 3"):
            wire.hello(DT, np.zeros((3, 12)))


@pytest.mark.parametrize(("what", "changes"), [("step", {"dt": 2e-3}), ("mass", {"dt": DT, "mass": 3.0})])
def test_a_world_of_another_step_or_mass_is_refused(what, changes, mission, vehicle, joined):
    said = rf"the world in Gazebo has a {what} of .* export the mission again"
    with Plugin(RigidBody(vehicle), **changes) as plugin, pytest.raises(tl.InputError, match=said):
        joined(mission, plugin)


def test_a_body_that_is_no_longer_used_says_goodbye(mission, vehicle, monkeypatch, wire_to):
    with Plugin(RigidBody(vehicle), DT) as plugin:
        monkeypatch.setenv("TANDEMLIFT_GAZEBO_PORT", str(plugin.port))
        body = GazeboBody(mission, vehicle)
        del body
        gc.collect()
        again = wire_to(plugin)  # heard after the goodbye
        again.advance()
        kinds = [kind for kind, _ in itertools.groupby(plugin.heard)]  # what is answered slowly is said again
        assert kinds[:2] == [1, 5]


def test_a_pilot_killed_in_flight_leaves_a_plugin_that_flies_the_next(vehicle, wire_to):
    code = (
        "import sys; sys.path[:0] = sys.argv[2:]\n"
        "import numpy as np\nfrom tandemlift.engines.gazebo_wire import Wire\n"
        "wire = Wire(int(sys.argv[1]), 2)\nwire.hello(1e-3, np.zeros((3, 8)))\n"
        "while True: wire.advance(); print(flush=True)"
    )
    with Plugin(RigidBody(vehicle), DT) as plugin:
        command = [sys.executable, "-c", code, str(plugin.port), *sys.path]
        pilot = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        for _ in range(10):
            said(pilot, "^$")
        ended(pilot, signal.SIGKILL)
        flown = len(plugin.taken)
        assert flown >= 10
        fly_by(wire_to(plugin), 4)
        later = plugin.taken[flown:]
        assert later[-4:] == [1, 2, 3, 4]
        assert len(later) <= 5, "a step of the killed pilot may have been on its way"


def test_without_gazebo_the_error_says_how_to_get_it(mission, monkeypatch, tmp_path):
    for name in ("TANDEMLIFT_GAZEBO_PORT", "TANDEMLIFT_GAZEBO_ROOT"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(tl.InputError, match=r"^engine 'gazebo' needs Gazebo 11: install it, or make a Debian 11 root"):
        tl.fly(mission, engine="gazebo")
    monkeypatch.setenv("TANDEMLIFT_GAZEBO_ROOT", str(tmp_path))
    with pytest.raises(tl.InputError, match=r"has no /usr/bin/gzserver; make it with: tools/gazebo-root"):
        tl.fly(mission, engine="gazebo")


@pytest.mark.parametrize(("user", "begin"), [(0, "chroot"), (1000, "sudo chroot")])
def test_only_who_is_not_root_is_told_to_use_sudo(user, begin, monkeypatch, tmp_path):
    (tmp_path / "usr/bin").mkdir(parents=True)
    (tmp_path / "usr/bin/gzserver").touch()
    monkeypatch.setenv("TANDEMLIFT_GAZEBO_ROOT", str(tmp_path))
    monkeypatch.setattr("os.geteuid", lambda: user)
    assert shell_command_for_user("http://127.0.0.1:1", "gz topic").startswith(f"{begin} {tmp_path} env GAZEBO_MASTER")


def test_a_port_that_is_none_is_refused(mission, monkeypatch):
    monkeypatch.setenv("TANDEMLIFT_GAZEBO_PORT", "gazebo")
    with pytest.raises(tl.InputError, match=r"TANDEMLIFT_GAZEBO_PORT = gazebo: must be a UDP port, 1 to 65535"):
        tl.fly(mission, engine="gazebo")


def test_the_world_of_a_flight_waits_for_its_pilot_and_ends_with_it(mission):
    plugin = ElementTree.fromstring(world_from(mission, 12345).encode()).find("world/model/plugin")
    told = {setting.tag: setting.text for setting in plugin}
    assert told == {"port": "12345", "wait": "true", "patience": "0", "stay": "false"}
