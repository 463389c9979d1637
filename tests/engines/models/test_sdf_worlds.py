"""Missions as Gazebo worlds, read by libsdformat: the vehicle, its start, physics, walls, contact and looks."""

from xml.etree import ElementTree

import numpy as np
import pytest
from modelled import BUILT_IN, MISSIONS, links_of, loaded, pose, shapes_of
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.apps.export.write import export
from tandemlift.engines.models.scene import floor_from
from tandemlift.parts.contact.hull import HALF_THICKNESS
from tandemlift.parts.contact.spheres import GUARD_DEFLECTION


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


@pytest.mark.thorough
@pytest.mark.parametrize("name", MISSIONS)
def test_mass_centre_of_mass_and_inertia_of_a_world_are_the_true_vehicles(name, world):
    found = world(name)
    mass, first, second = inertia_about(links_of(found.lines))
    scale = np.diag(np.sqrt(found.mission.plant.inertia_scale))
    assert mass == pytest.approx(found.vehicle.mass * found.mission.plant.mass_scale, rel=1e-12)
    np.testing.assert_allclose(first, 0.0, atol=1e-12)  # the model's frame is at the centre of mass of the system
    np.testing.assert_allclose(second, scale @ found.vehicle.inertia @ scale, rtol=1e-12, atol=1e-12)


@pytest.mark.thorough
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


def test_a_start_at_any_pitch_is_the_missions(reader, tmp_path):
    for pitch in (1.48, -1.48, 1.0):
        mission = tl.load_mission("paper", {"initial.euler": [0.3, pitch, -1.0]})
        lines = reader(export(mission, tmp_path / "steep.sdf"))
        (words,) = [words for words in lines if words[:2] == ["model", "tandemlift"]]
        expected = Rotation.from_euler("ZXY", [-1.0, 0.3, pitch])
        np.testing.assert_allclose(pose(words[3:])[1].as_matrix(), expected.as_matrix(), atol=1e-15)


def test_physics_of_a_world_are_gazebos_at_the_missions_step_and_it_needs_no_file_of_its_own(world):
    found = world("zigzag")
    assert found.lines[0] == ["world", "default", "ode", "0.001", "0", "0", "-9.8100000000000005"]
    tags = {element.tag for element in ElementTree.parse(found.path).iter()}
    assert not tags & {"mesh", "uri", "include", "script", "plugin"}


@pytest.mark.parametrize("name", [name for name in MISSIONS if loaded(name)[0].all_walls])
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
    models = {name: [w[1] for w in world(name).lines if w[0] == "model"] for name in ("paper", "walls")}
    assert models == {"paper": ["tandemlift"], "walls": ["floor", "walls", "tandemlift"]}


def test_a_standing_vehicle_has_its_soles_as_deep_in_the_floor_as_its_weight_presses_them(world):
    found = world("zigzag")
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
        assert shapes["guard"][0] == ("sphere", q.guard_radius)
        assert shapes["guard_ring"][0] == ("cylinder", q.guard_radius, 2.0 * HALF_THICKNESS)
        feet = [(size, place) for name, (size, place, _) in shapes.items() if name.startswith("foot")]
        spread = q.feet_spread * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
        soles = np.array([place - [0.0, 0.0, size[1]] for size, place in feet])
        np.testing.assert_allclose(soles, np.column_stack([spread, np.full(4, -q.feet_depth)]), atol=1e-12)
        discs = [shapes[f"rotor_{j}"] for j in range(1, 5)]
        assert {size for size, _, _ in discs} == {("cylinder", q.rotor_radius, 2.0 * HALF_THICKNESS)}
        hubs = np.column_stack([q.rotors, np.full(4, q.rotor_height)])
        np.testing.assert_allclose([place for _, place, _ in discs], hubs, atol=1e-12)
        for j, (x, y) in enumerate(q.rotors, 1):  # spheres of those that stand out
            stands_out = np.hypot(x, y) + q.rotor_radius > q.guard_radius + GUARD_DEFLECTION
            assert (f"rotor_{j}_sphere" in shapes) == stands_out
    beam, shapes = found.vehicle.payload, shapes_of(found.lines, "payload")
    rod, _, turned = shapes.pop("beam")
    assert rod == ("cylinder", beam.radius, beam.length)
    np.testing.assert_allclose(np.abs(turned.apply([0.0, 0.0, 1.0])), [0.0, 1.0, 0.0], atol=1e-15)
    for name in ("beam_end", "beam_tip"):
        ends = [shapes.pop(f"{name}_{k}") for k in (1, 2)]
        assert [size for size, _, _ in ends] == [("sphere", beam.radius)] * 2
        np.testing.assert_allclose(
            [place for _, place, _ in ends], np.outer([-0.5, 0.5], [0, beam.length, 0]), atol=1e-12
        )
    assert not shapes


def test_every_shape_touches_either_the_floor_or_walls(world):
    masks = {}
    for collision in ElementTree.parse(world("zigzag").path).iter("collision"):
        kind = collision.get("name").rstrip("_0123456789")
        masks.setdefault(kind, set()).add(int(collision.find(".//collide_bitmask").text))
    on_floor, on_walls = ("floor", "foot", "rotor", "guard_ring", "beam_tip"), ("wall", "guard", "beam", "beam_end")
    assert masks == {kind: {1} for kind in on_floor} | {kind: {2} for kind in on_walls}


@pytest.mark.parametrize("name", ["unlike", *BUILT_IN])
def test_both_models_show_the_same_parts_at_the_same_places(name, world, mujoco, model_of):
    found, model = world(name), model_of(loaded(name, {"initial.position": 0.0, "initial.euler": 0.0})[0])
    data, shown = mujoco.MjData(model), 0
    mujoco.mj_forward(model, data)
    for link in links_of(found.lines):
        for shape, (size, position, rotation) in shapes_of(found.lines, link.name, "visual").items():
            geom, halves = f"{link.name.replace('_', '')} {shape} visual", np.array(size[1:])
            halves *= {"box": [0.5, 0.5, 0.5], "sphere": [1.0], "cylinder": [1.0, 0.5]}[size[0]]
            np.testing.assert_allclose(model.geom(geom).size[: len(halves)], halves, atol=1e-6)
            np.testing.assert_allclose(data.geom(geom).xpos, link.position + position, atol=1e-6)
            np.testing.assert_allclose(data.geom(geom).xmat.reshape(3, 3), rotation.as_matrix(), atol=3e-6)
            shown += 1
    assert shown == sum(model.geom(i).name.endswith(" visual") for i in range(model.ngeom))


def test_the_plugin_has_its_port(reader, tmp_path):
    mission, _ = loaded("paper")
    path = export(mission, tmp_path / "world.sdf", plugin=7411)
    reader(path)
    (plugin,) = ElementTree.parse(path).findall("./world/model[@name='tandemlift']/plugin")
    assert (plugin.get("filename"), plugin.findtext("port")) == ("libtandemlift_gazebo.so", "7411")
