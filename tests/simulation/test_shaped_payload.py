"""A payload that is a box or a mesh: its mass and inertia, its contact, how it is drawn, in all engines alike."""

from xml.etree import ElementTree

import numpy as np
import pytest
from flights import in_both
from passing import thrown

import tandemlift as tl
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.vehicle import skeleton

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.core.errors.FlightWarning")

SIZE = [0.8, 3.0, 0.3]
BOX = {"vehicle.payload.shape": "box", "vehicle.payload.size": SIZE}
SLIPPERY = {"ground.friction": 0.0}  # MuJoCo's friction holds, ours creeps


def test_mass_and_inertia_of_a_box_are_those_that_mujoco_gives_it():
    mujoco = pytest.importorskip("mujoco")
    spec, payload = mujoco.MjSpec(), tl.load_mission("iris", BOX).vehicle.payload
    body = spec.worldbody.add_body(name="box")
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.5 * s for s in SIZE], mass=payload.mass)
    assert np.diag(payload.tensor) == pytest.approx(np.sort(spec.compile().body("box").inertia)[[1, 0, 2]])
    assert payload.areas == pytest.approx((3.0 * 0.3, 0.8 * 0.3, 0.8 * 3.0))


@pytest.mark.parametrize("euler", [[0.3, 0.1, 0.2], [0.0, 0.5, 0.0], [1.2, -0.4, 1.0]])
def test_a_box_that_falls_tilted_on_the_floor_is_thrown_back_as_in_mujoco(euler):
    start = {"ground.height": -1.8, "initial.euler": euler, "vehicle.payload.center_of_mass": [0.0, 0.1, 0.0]}
    a, b = in_both(thrown(BOX | SLIPPERY | start, 0.8))
    touched = [np.flatnonzero(f["contact_force"][:, 2] > 0.0)[0] for f in (a, b)]
    assert abs(touched[0] - touched[1]) <= 1
    after = slice(0, touched[0] + 60)
    assert np.abs(a["contact_force"][after]).max() > 100.0
    assert np.abs(a["position"] - b["position"])[after].max() < 1e-3
    assert np.abs(a["attitude"] - b["attitude"])[after].max() < 3e-3


def test_models_and_pictures_show_the_box_about_its_origin(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    from tandemlift.apps.export.write import export

    mission = tl.load_mission("iris", BOX | {"vehicle.payload.center_of_mass": [0.0, 0.2, 0.01]})
    vehicle = Vehicle.from_settings(mission.vehicle)
    model = mujoco.MjModel.from_xml_path(str(export(mission, tmp_path / "box.xml")))
    for name in ("hull", "payload payload visual"):
        assert model.geom(name).pos == pytest.approx(vehicle.origin, abs=1e-6)
        assert 2.0 * model.geom(name).size == pytest.approx(SIZE)
    link = ElementTree.parse(export(mission, tmp_path / "box.sdf")).find(".//link[@name='payload']")
    for place in ("visual[@name='payload']", "collision[@name='beam_box']"):
        size = link.find(f"{place}/geometry/box/size").text
        assert np.fromstring(size, sep=" ") == pytest.approx(SIZE)
    beam = skeleton(vehicle).beam
    assert np.nanmin(beam, axis=0) == pytest.approx(vehicle.origin - np.array(SIZE) / 2.0)
    assert np.nanmax(beam, axis=0) == pytest.approx(vehicle.origin + np.array(SIZE) / 2.0)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        (
            {"vehicle.payload.size": [1.0, 1.0, 1.0]},
            r'no size = \[1\.0, 1\.0, 1\.0\] with shape = "beam", or shape must',
        ),
        ({"vehicle.payload.shape": "box"}, r'must have size with shape = "box"'),
        (BOX | {"vehicle.payload.length": 2.0}, r'no length = 2\.0 with shape = "box"'),
        (BOX | {"vehicle.payload.size.2": 0.0}, r"payload\.size\.2 = 0\.0: must be a number > 0"),
        ({"vehicle.payload.shape": "plate"}, r'shape = "plate": must be .*"box"'),
    ],
)
def test_keys_of_another_shape_are_refused_by_name(changes, says):
    with pytest.raises(tl.InputError, match=says):
        tl.load_mission("iris", changes)


def test_a_box_pushed_gently_against_a_wall_comes_back_as_in_mujoco():
    wall = {"walls": [{"start": [-2.0, 1.6], "end": [2.0, 1.6], "top": 9.0}], "initial.velocity": [0.0, 0.5, 0.0]}
    a, b = in_both(thrown(BOX | SLIPPERY | wall, 0.6))
    assert max(np.abs(a["contact_force"][:, 1])) > 50.0
    assert np.abs(a["contact_force"][:, 1] - b["contact_force"][:, 1]).sum() * 1e-3 < 0.2  # N s, of 2
    assert np.abs(a["position"] - b["position"]).max() < 1e-3
    assert a["velocity"][-1, 1] < -0.05


@pytest.fixture
def brick(tmp_path):
    """A brick off its file's origin, cut finely, as an STL file."""
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.box(SIZE).subdivide().subdivide()
    mesh.apply_transform(trimesh.transformations.euler_matrix(0.3, 0.2, 0.1))
    mesh.apply_translation([0.1, 0.2, 0.0])
    mesh.export(tmp_path / "brick.stl")
    return tmp_path / "brick.stl"


def of_mesh(path, **more):
    return {"vehicle.payload.shape": "mesh", "vehicle.payload.mesh": str(path), "vehicle.payload.density": 0.7} | more


def test_a_mesh_weighs_and_turns_as_in_mujoco_and_its_corners_are_those_of_its_hull(brick, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    payload = tl.load_mission("iris", of_mesh(brick)).vehicle.payload
    text = f"""<mujoco><asset><mesh name="m" file="{brick}"/></asset><worldbody><body name="b">
        <geom type="mesh" mesh="m" density="0.7"/></body></worldbody></mujoco>"""
    body = mujoco.MjModel.from_xml_string(text).body("b")
    assert payload.mass == pytest.approx(body.mass[0], rel=1e-6)
    assert payload.center_of_mass == pytest.approx(body.ipos, abs=1e-6)
    assert np.linalg.eigvalsh(payload.tensor) == pytest.approx(np.sort(body.inertia), rel=1e-5)
    assert len(payload.hulls[0].corners) == 8
    assert len(payload.hulls[0].faces) == 6


def test_a_mission_with_a_mesh_needs_its_file_no_longer_once_it_is_loaded(brick, tmp_path):
    (tmp_path / "own.toml").write_text(
        'extends = "iris"\n[vehicle.payload]\nshape = "mesh"\nmesh = "brick.stl"\nmass = 0.4\n'
    )
    mission = tl.load_mission(tmp_path / "own.toml", {"mission.duration": 0.01})
    assert mission.vehicle.payload.mass == 0.4
    tl.fly(mission).save(tmp_path / "flight")
    brick.unlink()
    kept = Vehicle.from_mission(tl.Flight.load(tmp_path / "flight").mission)
    assert kept.payload == mission.vehicle.payload


def test_a_mesh_that_falls_is_thrown_back_as_in_mujoco(brick):
    a, b = in_both(thrown(of_mesh(brick) | SLIPPERY | {"ground.height": -1.8, "initial.euler": [0.3, 0.4, 0.0]}, 0.6))
    touched = np.flatnonzero(a["contact_force"][:, 2] > 0.0)[0]
    after = slice(0, touched + 30)
    assert np.abs(a["contact_force"][after]).max() > 100.0
    assert np.abs(a["position"] - b["position"])[after].max() < 2e-3


SPOILED = {
    "opened": (lambda m: m.update_faces(np.arange(len(m.faces)) > 2), r"must be closed"),
    "inside out": (lambda m: m.invert(), r"is inside out, with a volume of -0\.72 m³"),
    "in millimetres": (lambda m: m.apply_scale(1000.0), r"looks like millimetres; scale it with mesh_scale = 0\.001"),
}


@pytest.mark.parametrize("way", SPOILED)
def test_a_spoiled_mesh_is_refused_with_what_is_wrong(brick, way):
    import trimesh

    spoil, says = SPOILED[way]
    mesh = trimesh.load_mesh(brick)
    spoil(mesh)
    mesh.export(brick)
    with pytest.raises(tl.InputError, match=rf"vehicle\.payload\.mesh = .*: .*{says}"):
        tl.load_mission("iris", of_mesh(brick))


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"vehicle.payload.mesh": "none.stl"}, r'mesh = "none\.stl": there is no such file'),
        ({"vehicle.payload.inertia": [1.0, 1.0, 1.0]}, r"inertia = \[1\.0, 1\.0, 1\.0\]: must be left out"),
        ({"vehicle.payload.mesh": None}, r"density = 0\.7: must be left out without mesh"),
    ],
)
def test_a_mesh_needs_its_file_and_density_and_nothing_beside(brick, changes, says):
    with pytest.raises(tl.InputError, match=says):
        tl.load_mission("iris", of_mesh(brick, **changes))


def test_a_body_of_many_corners_is_led_through_a_corridor(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=0.3)
    mesh.apply_scale([1.0, 3.4, 0.3])
    mesh.export(tmp_path / "pod.ply")
    pod = {"vehicle.payload.shape": "mesh", "vehicle.payload.mesh": str(tmp_path / "pod.ply")}
    mission = tl.load_mission("narrow", pod | {"vehicle.payload.mass": 0.5, "mission.duration": 16.0})
    assert len(mission.vehicle.payload.hulls[0].corners) == 32
    flight = tl.fly(mission)
    assert flight.findings == ()
    assert np.linalg.norm(flight["velocity"], axis=1).max() > 0.1
