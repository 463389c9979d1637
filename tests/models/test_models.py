"""Missions as models of other simulators: worlds read by libsdformat, MuJoCo models beside the engine's own."""

import importlib
import sys
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
from exported import flight_of
from patience import completed
from repository import SUPPORT
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.cli.main import main
from tandemlift.export.write import export
from tandemlift.models.surroundings import floor_from, walls_from
from tandemlift.vehicle import Vehicle

PLACES = [[0.1, 1.0, 0.2], [-0.2, -1.1, 0.15], [0.9, 0.1, 0.1], [-0.8, 0.2, -0.1]]
TILTED = {"initial.position": [1.0, -2.0, 3.0], "initial.euler": [0.4, -0.9, 2.0]}
LIGHTER = {"plant.mass_scale": 0.95, "plant.inertia_scale": [1.05, 1.2, 1.05], "vehicle.payload.mass": 2.0}
WALLED = {"walls": [{"start": [2.0, -3.0], "end": [2.5, 3.0]}, {"start": [4.0, 1.0], "end": [3.0, 1.0], "top": -2.0}]}


def fleet(count):
    """Changes for a vehicle of `count` unlike quadrotors at unlike places, level at the origin."""
    paper = tl.load_mission("paper").model_dump(mode="json", exclude_none=True)["vehicle"]["quadrotors"][0]
    quadrotors = [{**paper, "position": p, "mass": 1.2 + 0.2 * i} for i, p in enumerate(PLACES[:count])]
    return {"vehicle.quadrotors": quadrotors, "initial.position": 0.0, "initial.euler": 0.0}


MISSIONS = {
    "one": ("paper", {**fleet(1), "vehicle.quadrotors.0.position": [0.0, 0.0, 0.2]}),
    "two": ("paper", {}),
    "unlike": ("paper", {**fleet(4), **TILTED}),
    "plate": ("four", {}),
    "heavier": ("heavy-payload", {}),
    "as it really is": ("paper", LIGHTER),
    "corridor": ("zigzag", {}),
    "walls": ("iris", WALLED),
}


def loaded(name, more=None):
    """A mission, and its vehicle as the pilot knows it."""
    of, changes = MISSIONS[name]
    mission = tl.load_mission(of, {**changes, **(more or {})})
    return mission, Vehicle.from_settings(mission.vehicle)


def inertia_about(links):
    """Mass, first and second moment of bodies about the origin of the frame that they are in."""
    mass = sum(link.mass for link in links)
    first, second = np.zeros(3), np.zeros((3, 3))
    for link in links:
        R = link.rotation.as_matrix()
        place = link.position + R @ link.center
        first += link.mass * place
        second += R @ link.inertia @ R.T + link.mass * (place @ place * np.eye(3) - np.outer(place, place))
    return mass, first, second


@pytest.fixture(scope="module")
def reader(program, tmp_path_factory):
    """What libsdformat reads of a world, which is strict: what it does not know, or warns of, is an error."""
    compiler = program("g++")
    package = completed([program("pkg-config"), "--cflags", "--libs", "sdformat12"], capture_output=True, text=True)
    if package.returncode:
        pytest.skip("libsdformat-dev 12 is not installed")
    made, source = tmp_path_factory.mktemp("reader") / "reader", SUPPORT / "sdf_reader.cpp"
    completed([compiler, "-std=c++17", str(source), "-o", str(made), *package.stdout.split()], check=True)

    def read(path):
        done = completed([str(made), str(path)], capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")
        return [line.split() for line in done.stdout.splitlines()]

    return read


@pytest.fixture(scope="module")
def world(reader, tmp_path_factory):
    """What is in a mission's world: what there is by (kind, names) → words, poses apart."""
    folder, known = tmp_path_factory.mktemp("worlds"), {}

    def read(name):
        if name not in known:
            mission, vehicle = loaded(name)
            path = export(mission, folder / f"{name}.sdf")
            known[name] = SimpleNamespace(mission=mission, vehicle=vehicle, path=path, lines=reader(path))
        return known[name]

    return read


def pose(words):
    """Position and rotation from seven numbers, w first."""
    numbers = np.array(words, dtype=float)
    return numbers[:3], Rotation.from_quat(numbers[3:], scalar_first=True)


def links_of(lines):
    """The links of the vehicle in the order of the file."""
    links = []
    for kind, name, *words in lines:
        if kind == "link" and name not in ("floor", "walls"):
            position, rotation = pose(words[1:8])
            center, inertia = np.array(words[8:11], dtype=float), np.array(words[11:], dtype=float).reshape(3, 3)
            links.append(SimpleNamespace(name=name, mass=float(words[0]), position=position, rotation=rotation))
            links[-1].center, links[-1].inertia = center, inertia
    return links


def shapes_of(lines, link, kind="collision"):
    """A link's shapes: name → (kind and size, position, rotation)."""
    found = [words for word, of, *words in lines if (word, of) == (kind, link)]
    return {words[0]: ((words[1], *map(float, words[2:-7])), *pose(words[-7:])) for words in found}


@pytest.mark.parametrize("name", MISSIONS)
def test_mass_centre_of_mass_and_inertia_of_a_world_are_the_true_vehicles(name, world):
    found = world(name)
    mass, first, second = inertia_about(links_of(found.lines))
    scale = np.diag(np.sqrt(found.mission.plant.inertia_scale))
    assert mass == pytest.approx(found.vehicle.mass * found.mission.plant.mass_scale, rel=1e-12)
    np.testing.assert_allclose(first, 0.0, atol=1e-12)  # the model's frame is at the centre of mass of the system
    np.testing.assert_allclose(second, scale @ found.vehicle.inertia @ scale, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", MISSIONS)
def test_links_and_fixed_joints_are_where_the_parts_are(name, world):
    found = world(name)
    links = {link.name: link for link in links_of(found.lines)}
    count = found.vehicle.count
    assert list(links) == ["payload", *(f"quadrotor_{i + 1}" for i in range(count))]
    payload = -found.vehicle.center_of_mass
    joints = {words[1]: words[2:] for words in found.lines if words[0] == "joint"}
    assert list(joints) == [f"joint_{i + 1}" for i in range(count)]
    np.testing.assert_allclose(links["payload"].position, payload, atol=1e-15)
    for i, quadrotor in enumerate(found.vehicle.quadrotors, 1):
        np.testing.assert_allclose(links[f"quadrotor_{i}"].position, payload + quadrotor.position, atol=1e-15)
        parent, child, kind, *words = joints[f"joint_{i}"]
        assert (parent, child, kind) == ("payload", f"quadrotor_{i}", "fixed")
        np.testing.assert_allclose(pose(words)[0], payload + quadrotor.joint_position, atol=1e-12)
    assert all(link.rotation.magnitude() == 0.0 for link in links.values())


@pytest.mark.parametrize("name", MISSIONS)
def test_the_vehicle_of_a_world_starts_as_its_mission(name, world):
    found = world(name)
    (words,) = [words for words in found.lines if words[:2] == ["model", "tandemlift"]]
    assert words[2] == "0"  # not static
    roll, pitch, yaw = found.mission.initial.euler
    position, rotation = pose(words[3:])
    np.testing.assert_array_equal(position, found.mission.initial.position)
    expected = Rotation.from_euler("ZXY", [yaw, roll, pitch])
    np.testing.assert_allclose(rotation.as_matrix(), expected.as_matrix(), atol=1e-15)


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2, 1.5707963, 3.0])
def test_a_start_at_any_pitch_is_the_missions(pitch, reader, tmp_path):
    mission = tl.load_mission("paper", {"initial.euler": [0.3, pitch, -1.0]})
    lines = reader(export(mission, tmp_path / "steep.sdf"))
    (words,) = [words for words in lines if words[:2] == ["model", "tandemlift"]]
    expected = Rotation.from_euler("ZXY", [-1.0, 0.3, pitch])
    np.testing.assert_allclose(pose(words[3:])[1].as_matrix(), expected.as_matrix(), atol=1e-15)


def test_physics_of_a_world_are_gazebos_at_the_missions_step(world):
    assert world("corridor").lines[0] == ["world", "default", "ode", "0.001", "0", "0", "-9.8100000000000005"]


@pytest.mark.parametrize("name", ["corridor", "walls"])
def test_walls_of_a_world_stand_where_the_missions_do(name, world):
    found = world(name)
    walls, tables = shapes_of(found.lines, "walls"), found.mission.all_walls
    assert list(walls) == [f"wall_{k + 1}" for k in range(len(tables))]
    for ((kind, length, thick, height), position, rotation), table in zip(walls.values(), tables, strict=True):
        along, up = rotation.apply([length / 2.0, 0.0, 0.0]), rotation.apply([0.0, 0.0, height / 2.0])
        assert (kind, thick) == ("box", 1e-4)
        np.testing.assert_allclose((position - along)[:2], table.start, atol=1e-12)
        np.testing.assert_allclose((position + along)[:2], table.end, atol=1e-12)
        assert (position + up)[2] == pytest.approx(table.top, abs=1e-12)
        assert (position - up)[2] < floor_from(found.mission, found.vehicle).height


def test_a_mission_without_floor_has_neither_floor_nor_walls(world):
    models = {name: [w[1] for w in world(name).lines if w[0] == "model"] for name in ("two", "walls")}
    assert models == {"two": ["tandemlift"], "walls": ["floor", "walls", "tandemlift"]}


def test_a_standing_vehicle_has_its_soles_as_deep_in_the_floor_as_its_weight_presses_them(world):
    found = world("corridor")
    (floor,) = [words for words in found.lines if words[:2] == ["model", "floor"]]
    feet = [
        found.mission.initial.position[2] + link.position[2] + place[2] - size[1]
        for link in links_of(found.lines)
        for name, (size, place, _) in shapes_of(found.lines, link.name).items()
        if name.startswith("foot")
    ]
    root = ElementTree.parse(found.path)
    springs = [float(c.find(".//kp").text) for c in root.iter("collision") if c.get("name").startswith("foot")]
    assert len(feet) == len(springs) == 8
    depths = float(floor[5]) - np.array(feet)
    assert depths @ springs == pytest.approx(found.vehicle.weight, rel=1e-9)


def test_what_touches_is_the_shape_of_the_contact_laws(world):
    found = world("unlike")
    for i, q in enumerate(found.vehicle.quadrotors, 1):
        shapes = shapes_of(found.lines, f"quadrotor_{i}")
        assert shapes.pop("guard")[0] == ("sphere", q.guard_radius)
        places = np.array([place - [0.0, 0.0, size[1]] for size, place, _ in shapes.values()])
        spread = q.feet_spread * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
        np.testing.assert_allclose(places, np.column_stack([spread, np.full(4, -q.feet_depth)]), atol=1e-12)
    beam = found.vehicle.payload
    (rod, _, turned), *ends = shapes_of(found.lines, "payload").values()
    assert rod == ("cylinder", beam.radius, beam.length)
    np.testing.assert_allclose(np.abs(turned.apply([0.0, 0.0, 1.0])), [0.0, 1.0, 0.0], atol=1e-15)
    assert [size for size, _, _ in ends] == [("sphere", beam.radius)] * 2
    assert sorted(place[1] for _, place, _ in ends) == [-beam.length / 2.0, beam.length / 2.0]


def test_feet_touch_the_floor_alone_and_guards_and_beam_the_walls(world):
    masks = {}
    for collision in ElementTree.parse(world("corridor").path).iter("collision"):
        kind = collision.get("name").split("_")[0]
        masks.setdefault(kind, set()).add(int(collision.find(".//collide_bitmask").text))
    assert masks == {"floor": {1}, "foot": {1}, "wall": {2}, "guard": {2}, "beam": {2}}


def test_a_world_shows_every_rotor_where_it_is_and_needs_no_file_of_its_own(world):
    found = world("unlike")
    for i, q in enumerate(found.vehicle.quadrotors, 1):
        looks = shapes_of(found.lines, f"quadrotor_{i}", "visual")
        rotors = {name: look for name, look in looks.items() if name.startswith("rotor")}
        np.testing.assert_allclose([place[:2] for _, place, _ in rotors.values()], q.rotors, atol=1e-6)
        assert {size[:2] for size, _, _ in rotors.values()} == {("cylinder", q.rotor_radius)}
    tags = {element.tag for element in ElementTree.parse(found.path).iter()}
    assert not tags & {"mesh", "uri", "include", "script", "plugin"}


def test_the_plugin_has_its_port(reader, tmp_path):
    mission, _ = loaded("two")
    path = export(mission, tmp_path / "world.sdf", plugin=7411)
    reader(path)
    (plugin,) = ElementTree.parse(path).findall("./world/model[@name='tandemlift']/plugin")
    assert (plugin.get("filename"), plugin.findtext("port")) == ("libtandemlift_gazebo.so", "7411")


# ---- MuJoCo


@pytest.fixture(scope="module")
def mujoco():
    return pytest.importorskip("mujoco")


@pytest.fixture(scope="module")
def model_of(mujoco, tmp_path_factory):
    """A mission's file, read by MuJoCo."""
    folder = tmp_path_factory.mktemp("models")

    def read(mission):
        return mujoco.MjModel.from_xml_path(str(export(mission, folder / "model.xml")))

    return read


def mass_matrix(mujoco, model):
    """(6 × 6) of a level vehicle."""
    data, M = mujoco.MjData(model), np.zeros((6, 6))
    data.qpos[3:] = [1.0, 0.0, 0.0, 0.0]
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, M)
    return M


@pytest.mark.parametrize("name", MISSIONS)
def test_mass_centre_of_mass_and_inertia_of_a_mujoco_model_are_the_true_vehicles(name, mujoco, model_of):
    mission, vehicle = loaded(name)
    model, scale = model_of(mission), np.diag(np.sqrt(mission.plant.inertia_scale))
    expected = np.zeros((6, 6))
    expected[:3, :3] = mission.plant.mass_scale * vehicle.mass * np.eye(3)
    expected[3:, 3:] = scale @ vehicle.inertia @ scale
    np.testing.assert_allclose(mass_matrix(mujoco, model), expected, atol=1e-12)


def flown_beside_the_engine(mujoco, model, mission, vehicle, thrusts, steps):
    """The largest difference of state and sensors between a model and the engine's body of a mission [SI]."""
    body = importlib.import_module("tandemlift.engines.mujoco").MuJoCoBody(
        mission, vehicle, floor_from(mission, vehicle), walls_from(mission, vehicle)
    )
    data, calm, none = mujoco.MjData(model), np.zeros(0), np.zeros(3)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    data.ctrl[: len(thrusts)], worst = thrusts, 0.0
    for _ in range(steps):
        body.advance(thrusts, calm, none, none)
        mujoco.mj_step(model, data)
        state = np.concatenate([data.qpos[:3], data.qvel[:3], data.qpos[3:], data.qvel[3:]])
        worst = max(worst, np.abs(state - body.state).max(), np.abs(data.sensordata - body.data.sensordata).max())
    return worst, state


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("one", {}),
        ("unlike", {"initial.velocity": [1.0, -2.0, 0.5], "initial.rates": [0.4, -0.3, 1.0]}),
        ("plate", {}),
        ("heavier", {}),
        ("as it really is", {"vehicle.drag.force": [0.1, 0.2, 0.3], "vehicle.drag.moment": [0.03, 0.02, 0.01]}),
        ("corridor", {}),
        ("walls", {"initial.position": [1.7, 0.0, 0.02], "initial.velocity": [1.0, 0.0, 0.0]}),
    ],
)
def test_a_mujoco_model_flies_and_feels_as_the_engine(name, more, mujoco, model_of):
    mission, vehicle = loaded(name, more)
    thrusts = np.full(vehicle.rotor_count, vehicle.weight / vehicle.rotor_count)
    thrusts *= np.linspace(0.9, 1.05, vehicle.rotor_count)
    worst, _ = flown_beside_the_engine(mujoco, model_of(mission), mission, vehicle, thrusts, 400)
    assert worst < 1e-8


@pytest.mark.parametrize("name", ["unlike", "plate"])
def test_both_models_show_the_same_parts_at_the_same_places(name, world, mujoco, model_of):
    found, model = world(name), model_of(loaded(name, {"initial.position": 0.0, "initial.euler": 0.0})[0])
    data, shown = mujoco.MjData(model), 0
    mujoco.mj_forward(model, data)
    for link in links_of(found.lines):
        for shape, (size, position, rotation) in shapes_of(found.lines, link.name, "visual").items():
            geom, halves = f"{link.name.replace('_', '')} {shape} look", np.array(size[1:])
            halves *= {"box": [0.5, 0.5, 0.5], "sphere": [1.0], "cylinder": [1.0, 0.5]}[size[0]]
            np.testing.assert_allclose(model.geom(geom).size[: len(halves)], halves, atol=1e-6)
            np.testing.assert_allclose(data.geom(geom).xpos, link.position + position, atol=1e-6)
            np.testing.assert_allclose(data.geom(geom).xmat.reshape(3, 3), rotation.as_matrix(), atol=3e-6)
            shown += 1
    assert shown == sum(model.geom(i).name.endswith(" look") for i in range(model.ngeom))


def test_a_vehicle_without_thrust_falls_freely(mujoco, model_of):
    mission, vehicle = loaded("unlike", {"vehicle.drag.force": 0.0, "vehicle.drag.moment": 0.0})
    thrusts = np.zeros(vehicle.rotor_count)
    worst, state = flown_beside_the_engine(mujoco, model_of(mission), mission, vehicle, thrusts, 500)
    assert worst < 1e-12
    np.testing.assert_allclose(state[:3], np.array([1.0, -2.0, 3.0 - 9.81 * 0.5**2 / 2.0]), atol=1e-12)


def test_a_hovering_vehicle_carries_half_the_beam_at_each_joint(mujoco, model_of):
    model = model_of(tl.load_mission("paper", {"initial.position": 0.0, "initial.euler": 0.0}))
    data, lift = mujoco.MjData(model), 3.5 * 9.81 / 2.0
    data.ctrl[:] = lift / 4.0
    mujoco.mj_step(model, data)
    for i in (1, 2):  # the sensor knows nothing of what the rotors make
        np.testing.assert_allclose(lift - data.sensor(f"force{i}").data[2], 0.25 * 9.81, rtol=1e-12)


@pytest.mark.parametrize("name", ["unlike", "walls"])
def test_numbers_of_a_mujoco_model_are_the_engines_to_the_last_digits(name, mujoco, model_of):
    mission, vehicle = loaded(name)
    ours, engine = model_of(mission), importlib.import_module("tandemlift.models.mujoco_bodies")
    theirs = engine.model_of(mission, vehicle, floor_from(mission, vehicle), walls_from(mission, vehicle))
    for array in (
        "body_mass",
        "body_inertia",
        "body_ipos",
        "site_pos",
        "actuator_gear",
        "dof_damping",
        "pair_friction",
    ):
        np.testing.assert_allclose(getattr(ours, array), getattr(theirs, array), rtol=1e-15, atol=1e-15)
    for array in ("pair_solref", "pair_solreffriction"):
        np.testing.assert_allclose(getattr(ours, array), getattr(theirs, array), rtol=1e-12)
    touching = [mujoco.mj_id2name(theirs, mujoco.mjtObj.mjOBJ_GEOM, i) for i in range(theirs.ngeom)]
    for geom in touching:
        np.testing.assert_allclose(ours.geom(geom).pos, theirs.geom(geom).pos, rtol=1e-15, atol=1e-15)
        np.testing.assert_allclose(ours.geom(geom).size, theirs.geom(geom).size, rtol=1e-15)
    assert not ours.geom_contype.any()
    assert not ours.geom_conaffinity.any()  # shapes touch in pairs only, those to look at never
    np.testing.assert_array_equal(ours.key("start").qpos[:3], mission.initial.position)
    np.testing.assert_array_equal(ours.qpos0[:3], mission.initial.position)


# ---- files and refusals


@pytest.mark.parametrize("ending", ["sdf", "xml"])
def test_the_same_mission_gives_the_same_bytes_and_so_does_its_flight(ending, mujoco, tmp_path):
    flight = flight_of("iris")
    first, second = export(tl.load_mission("iris"), tmp_path / f"a.{ending}"), export(flight, tmp_path / f"b.{ending}")
    assert first.read_bytes() == second.read_bytes()


def refusal(what, path, **options):
    """Why something is not exported; what was there stays, and nothing is added."""
    before = {p: p.is_file() and p.read_bytes() for p in path.parent.iterdir()}
    with pytest.raises(tl.InputError) as caught:
        export(what, path, **options)
    assert {p: p.is_file() and p.read_bytes() for p in path.parent.iterdir()} == before
    return str(caught.value)


@pytest.mark.parametrize("ending", ["sdf", "xml"])
def test_a_true_vehicle_that_leaves_no_payload_is_refused_by_its_keys(ending, mujoco, tmp_path):
    (tmp_path / f"x.{ending}").write_text("mine")
    light = tl.load_mission("paper", {"plant.mass_scale": 0.8})
    assert "plant.mass_scale = 0.8" in refusal(light, tmp_path / f"x.{ending}")
    thin = tl.load_mission("paper", {"plant.inertia_scale": [0.97, 1.4, 1.1]})
    assert "principal moments of" in refusal(thin, tmp_path / f"x.{ending}")


def test_endings_and_ports_that_do_not_fit_are_refused(tmp_path):
    mission = tl.load_mission("paper")
    for name in ("world.urdf", "world", "world.sdf.gz", ".sdf"):
        assert ".sdf (Gazebo world) or .xml (MuJoCo model)" in refusal(mission, tmp_path / name)
    assert "'paper' is no flight" in refusal(mission, tmp_path / "paper.csv")
    assert "only a world, .sdf, has a plugin" in refusal(mission, tmp_path / "paper.xml", plugin=7000)
    for port in (0, -1, 65536):
        assert f"plugin = {port}: must be a port" in refusal(mission, tmp_path / "paper.sdf", plugin=port)


def test_without_mujoco_its_model_is_refused_and_a_world_is_not(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    for name in ("tandemlift.models.mujoco_bodies", "tandemlift.models.mjcf"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    mission = tl.load_mission("paper")
    assert "pip install 'tandemlift[mujoco]'" in refusal(mission, tmp_path / "paper.xml")
    assert export(mission, tmp_path / "paper.sdf").exists()


@pytest.mark.parametrize("ending", ["sdf", "xml"])
def test_a_model_that_cannot_be_written_leaves_what_was_there(ending, mujoco, tmp_path, monkeypatch):
    path = tmp_path / f"old.{ending}"
    path.write_text("mine")

    def full(self, *_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    assert "cannot be written: No space left on device" in refusal(tl.load_mission("paper"), path)


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run the command line in an empty folder: (exit code, standard output, standard error)."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["tandemlift", *arguments])
        with pytest.raises(SystemExit) as ended:
            main()
        return ended.value.code or 0, *capsys.readouterr()

    return call


def test_the_command_writes_a_mission_with_a_changed_key_and_a_plugin(run, tmp_path):
    arguments = ("export", "zigzag", "--set", "corridor.width=6.0", "--plugin", "7000", "--out", "there/wide.sdf")
    code, out, err = run(*arguments)
    assert (code, err) == (0, "")
    assert out.startswith(f"zigzag: {Path('there/wide.sdf')} (")
    wide = tl.load_mission("zigzag", {"corridor.width": 6.0})
    expected = export(wide, tmp_path / "expected.sdf", plugin=7000)
    assert (tmp_path / "there" / "wide.sdf").read_bytes() == expected.read_bytes()


def test_the_command_writes_the_mission_of_a_flight(run, tmp_path):
    flight_of("iris").save(tmp_path / "saved" / "flight.npz")
    assert run("export", "saved", "--out", "iris.sdf")[0] == 0
    assert (tmp_path / "iris.sdf").read_bytes() == export(tl.load_mission("iris"), tmp_path / "b.sdf").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "piece"),
    [
        (("iris", "--out", "iris.urdf"), "iris.urdf: must end in .mcap"),
        (("nowhere", "--out", "x.sdf"), "nowhere"),
        (("iris", "--out", "iris.csv", "--set", "mission.duration=5"), "--set is for a mission"),
        (("saved", "--out", "iris.sdf", "--set", "mission.duration=5"), "--set is for a mission"),
        (("iris", "--out", "iris.sdf", "--set", "mission.duration"), "--set mission.duration: must be KEY=VALUE"),
        (("iris", "--out", "iris.sdf", "--set", "mission.lenght=5"), "mission.lenght"),
        (("iris", "--out", "iris.sdf", "--plugin", "0"), "plugin = 0: must be a port"),
        (("iris", "--out", "iris.xml", "--plugin", "7000"), "only a world, .sdf, has a plugin"),
        (("saved", "--out", "iris.csv", "--plugin", "7000"), "only a world, .sdf, has a plugin"),
        (("iris", "--out", "iris.sdf", "--plugin", "here"), "plugin = here: must be a port"),
    ],
)
def test_the_command_refuses_what_does_not_fit_and_writes_nothing(arguments, piece, run, tmp_path):
    flight_of("iris").save(tmp_path / "saved" / "flight.npz")
    code, out, err = run("export", *arguments)
    assert (code, out) == (2, "")
    assert piece in err
    assert [p.name for p in tmp_path.iterdir()] == ["saved"]
