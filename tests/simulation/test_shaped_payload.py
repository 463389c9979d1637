"""A payload that is a box, a mesh or several bodies: mass, inertia, contact, models and pictures in all engines."""

from xml.etree import ElementTree

import numpy as np
import pytest
from flights import in_both
from passing import thrown

import tandemlift as tl
from tandemlift.engines.models.visuals import vehicle_shapes
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.clearances import clearances
from tandemlift.pictures.drawing.vehicle import skeleton

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.core.errors.FlightWarning")

SIZE = [0.8, 3.0, 0.3]
BOX = {"vehicle.payload.shape": "box", "vehicle.payload.size": SIZE}
WEDGE = [[0.5, 0.0, 0.0], [0.2, 0.2, 0.0], [0.2, -0.2, 0.0], [0.3, 0.0, 0.3]]
BODIES = [
    {"mass": 0.2, "ends": [[0.1, -1.5, 0.0], [-0.1, 1.5, 0.1]], "radius": 0.06},
    {"mass": 0.15, "size": [0.4, 0.3, 0.2], "position": [0.0, 0.9, -0.1], "euler": [0.3, -0.2, 0.5]},
    {"mass": 0.1, "corners": WEDGE},
]
SEVERAL = {"vehicle.payload.shape": "bodies", "vehicle.payload.bodies": BODIES}
SLIPPERY = {"ground.friction": 0.0}  # MuJoCo's friction holds, ours creeps


def test_mass_and_inertia_of_a_box_are_those_that_mujoco_gives_it():
    mujoco = pytest.importorskip("mujoco")
    spec, payload = mujoco.MjSpec(), tl.load_mission("iris", BOX).vehicle.payload
    body = spec.worldbody.add_body(name="box")
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.5 * s for s in SIZE], mass=payload.mass)
    assert np.diag(payload.tensor) == pytest.approx(np.sort(spec.compile().body("box").inertia)[[1, 0, 2]])
    assert payload.areas == pytest.approx((3.0 * 0.3, 0.8 * 0.3, 0.8 * 3.0))


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


@pytest.mark.thorough
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


@pytest.mark.parametrize(
    ("shape", "euler", "steps", "most"),
    [
        ("box", [0.3, 0.1, 0.2], 60, 1e-3),
        ("box", [1.2, -0.4, 1.0], 60, 1e-3),
        ("bodies", [-0.5, 0.4, 0.0], 60, 1e-3),
        ("mesh", [0.3, 0.4, 0.0], 30, 2e-3),
    ],
)
def test_what_falls_tilted_on_the_floor_is_thrown_back_as_in_mujoco(shape, euler, steps, most, brick):
    off = {"vehicle.payload.center_of_mass": [0.0, 0.1, 0.0]}
    payload = {"box": BOX | off, "bodies": SEVERAL, "mesh": of_mesh(brick)}[shape]
    start = {"ground.height": -2.2 if shape == "bodies" else -1.8, "initial.euler": euler}
    a, b = in_both(thrown(payload | SLIPPERY | start, 0.8))
    touched = [np.flatnonzero(f["contact_force"][:, 2] > 0.0)[0] for f in (a, b)]
    assert abs(touched[0] - touched[1]) <= 1
    after = slice(0, touched[0] + steps)
    assert np.abs(a["contact_force"][after]).max() > 50.0
    assert np.abs(a["position"] - b["position"])[after].max() < most
    assert np.abs(a["attitude"] - b["attitude"])[after].max() < 3.0 * most


SPOILED = {
    "opened": (
        lambda m: m.update_faces(np.arange(len(m.faces)) > 2),
        r"must be closed.* of 288 edges have not two triangles, from \[.*\] to \[.*\] m: .* mass, inertia and corners",
    ),
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


def made_of(path, *parts):
    """A mesh of several, as a file; a hole is a part that is inside out."""
    trimesh = pytest.importorskip("trimesh")
    trimesh.util.concatenate(parts).export(path)
    return tl.load_mission("iris", of_mesh(path) | {"vehicle.payload.density": 30.0}).vehicle.payload.mass


def test_a_mesh_that_counts_a_place_twice_is_refused_and_one_with_a_hole_or_in_parts_is_not(tmp_path):
    """Volumes are those of the boxes; what overlaps, or an inner surface that is turned outside, weighs too much."""
    box = pytest.importorskip("trimesh").creation.box
    outer, inner, wall = box((0.1, 1.6, 0.05)), box((0.08, 1.58, 0.03)), box((0.0998, 1.5998, 0.0498))
    across, beside, apart = box((0.5, 0.1, 0.05)), box((0.5, 0.1, 0.05)), box((0.1, 0.1, 0.1))
    beside.apply_translation((0.0, 0.0, 0.05))
    apart.apply_translation((0.0, 1.2, 0.0))
    path = tmp_path / "made.stl"
    for parts in ((outer, inner), (outer, across)):
        with pytest.raises(tl.InputError, match=r"m³ count the place \[.*\] m 2 times: bodies overlap, or an inner"):
            made_of(path, *parts)
    for hole in (inner, wall):
        hole.invert()
        assert made_of(path, outer, hole) == pytest.approx(30.0 * (outer.volume - abs(hole.volume)), rel=1e-4)
    assert made_of(path, outer, beside) == pytest.approx(30.0 * (outer.volume + beside.volume), rel=1e-6)
    assert made_of(path, outer, apart) == pytest.approx(30.0 * (outer.volume + apart.volume), rel=1e-6)
    apart.invert()
    with pytest.raises(tl.InputError, match="0 times: a body is inside out"):
        made_of(path, outer, apart)


@pytest.mark.parametrize(("length", "radius"), [(0.4, 0.1), (0.2, 0.3), (1.0, 0.06)])
def test_a_thick_short_beam_is_a_cylinder(length, radius):
    """By trimesh, whose cylinder has 1,000 sides; only slender beams are the thin rod of the paper."""
    trimesh = pytest.importorskip("trimesh")
    solid = trimesh.creation.cylinder(radius=radius, height=length, sections=1000)
    changes = {"vehicle.payload.length": length, "vehicle.payload.radius": radius}
    payload = tl.load_mission("hover", changes).vehicle.payload
    across, _, along = payload.mass / solid.volume * np.diag(solid.moment_inertia)
    assert payload.moments == pytest.approx((across, along, across), rel=1e-4)
    thin = tl.load_mission("hover").vehicle.payload
    assert thin.moments[0] == thin.mass * thin.length**2 / 12.0


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


@pytest.mark.thorough
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


def test_mass_centre_and_inertia_are_those_that_mujoco_gives_the_bodies():
    mujoco = pytest.importorskip("mujoco")
    payload = tl.load_mission("iris", SEVERAL).vehicle.payload
    spec, kinds, (rod, box, wedge) = mujoco.MjSpec(), mujoco.mjtGeom, BODIES
    body = spec.worldbody.add_body(name="all")
    rod_ends = np.ravel(rod["ends"])
    body.add_geom(type=kinds.mjGEOM_CYLINDER, fromto=rod_ends, size=[rod["radius"], 0.0, 0.0], mass=rod["mass"])
    half, quat = 0.5 * np.array(box["size"]), np.empty(4)
    mujoco.mju_euler2Quat(quat, np.array(box["euler"])[[2, 0, 1]], "zxy")
    body.add_geom(type=kinds.mjGEOM_BOX, size=half, pos=box["position"], quat=quat, mass=box["mass"])
    spec.add_mesh(name="wedge", uservert=np.ravel(WEDGE), inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_EXACT)
    body.add_geom(type=kinds.mjGEOM_MESH, meshname="wedge", mass=wedge["mass"])
    made, R = spec.compile().body("all"), np.empty(9)
    mujoco.mju_quat2Mat(R, made.iquat)
    R = R.reshape(3, 3)
    assert payload.mass == pytest.approx(made.mass[0])
    assert payload.center_of_mass == pytest.approx(made.ipos, abs=1e-9)
    assert R @ np.diag(made.inertia) @ R.T == pytest.approx(payload.tensor, abs=1e-9)


FLAT = [  # to walls along x and y
    {"mass": 0.3, "ends": [[0.0, -1.5, 0.0], [0.0, 1.5, 0.0]], "radius": 0.06},
    {"mass": 0.1, "size": [0.2, 0.5, 0.2], "position": [0.6, 0.0, 0.0]},
    {"mass": 0.1, "size": [0.2, 0.5, 0.2], "position": [-0.6, 0.0, 0.0]},
]
WALLS = {  # start, end, velocity
    "rod by an edge of the wall": ([0.08, 0.6], [2.0, 0.6], [0.15, 0.0, 0.0]),
    "box by its face": ([0.72, -2.0], [0.72, 2.0], [0.15, 0.0, 0.0]),
    "other box by an edge of the wall": ([-0.72, 0.1], [-2.0, 0.1], [-0.15, 0.0, 0.0]),
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", WALLS)
def test_each_body_meets_walls_by_itself_at_the_instant_of_mujoco_and_is_held(name):
    start, end, velocity = WALLS[name]
    wall = {"walls": [{"start": start, "end": end, "top": 9.0}], "initial.velocity": velocity}
    small = {"guard_radius": 0.05, "rotor_radius": 0.01}
    fleet = {f"vehicle.quadrotors.{i}.{key}": value for i in range(2) for key, value in small.items()}
    bodies = {"vehicle.payload.shape": "bodies", "vehicle.payload.bodies": FLAT}
    a, b = in_both(thrown(bodies | SLIPPERY | fleet | wall, 0.8))
    first = [np.flatnonzero(f["contact_force"][:, 0])[0] for f in (a, b)]
    assert abs(first[0] - first[1]) <= 1
    assert clearances(a).beam[first[0]] == pytest.approx(0.0, abs=3e-4)
    assert clearances(a).beam[first[0] :].max() < 0.02  # inside no deeper than the rounding, or back outside
    assert a["rates"][-1] @ b["rates"][-1] > 0.0


def test_models_and_pictures_show_every_body(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    from tandemlift.apps.export.write import export

    mission = tl.load_mission("iris", SEVERAL)
    vehicle = Vehicle.from_settings(mission.vehicle)
    shapes = {shape.name: shape for shape in vehicle_shapes(vehicle) if shape.name.startswith("body_")}
    assert sorted(shapes) == ["body_1_rod", "body_2_box", "body_3_payload"]
    middle = np.mean(BODIES[0]["ends"], axis=0)
    assert shapes["body_1_rod"].position == pytest.approx(vehicle.origin + middle)
    assert shapes["body_2_box"].position == pytest.approx(vehicle.origin + np.array(BODIES[1]["position"]))
    model = mujoco.MjModel.from_xml_path(str(export(mission, tmp_path / "several.xml")))
    assert all(model.geom(name).contype == 0 for name in ("hull", "hull2", "hull3"))
    link = ElementTree.parse(export(mission, tmp_path / "several.sdf")).find(".//link[@name='payload']")
    length = float(np.linalg.norm(np.diff(BODIES[0]["ends"], axis=0)))
    rod = link.find("collision[@name='beam_body_1_rod']/geometry/cylinder")
    assert float(rod.find("length").text) == pytest.approx(length, abs=1e-6)
