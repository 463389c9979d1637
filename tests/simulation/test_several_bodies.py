"""A payload of several bodies: its mass and inertia, contact with floor and walls, models and pictures."""

from xml.etree import ElementTree

import numpy as np
import pytest
from flights import in_both
from passing import thrown

import tandemlift as tl
from tandemlift.engines.models.visuals import vehicle_shapes
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.clearances import clearances

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.core.errors.FlightWarning")

WEDGE = [[0.5, 0.0, 0.0], [0.2, 0.2, 0.0], [0.2, -0.2, 0.0], [0.3, 0.0, 0.3]]
BODIES = [
    {"mass": 0.2, "ends": [[0.1, -1.5, 0.0], [-0.1, 1.5, 0.1]], "radius": 0.06},
    {"mass": 0.15, "size": [0.4, 0.3, 0.2], "position": [0.0, 0.9, -0.1], "euler": [0.3, -0.2, 0.5]},
    {"mass": 0.1, "corners": WEDGE},
]
SEVERAL = {"vehicle.payload.shape": "bodies", "vehicle.payload.bodies": BODIES}
SLIPPERY = {"ground.friction": 0.0}  # MuJoCo's friction holds, ours creeps


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


@pytest.mark.parametrize("euler", [[0.3, 0.1, 0.2], [-0.5, 0.4, 0.0]])
def test_they_fall_tilted_on_the_floor_and_are_thrown_back_as_in_mujoco(euler):
    start = {"ground.height": -2.2, "initial.euler": euler}
    a, b = in_both(thrown(SEVERAL | SLIPPERY | start, 0.8))
    touched = [np.flatnonzero(f["contact_force"][:, 2] > 0.0)[0] for f in (a, b)]
    assert abs(touched[0] - touched[1]) <= 1
    after = slice(0, touched[0] + 60)
    assert np.abs(a["contact_force"][after]).max() > 50.0
    assert np.abs(a["position"] - b["position"])[after].max() < 1e-3
    assert np.abs(a["attitude"] - b["attitude"])[after].max() < 3e-3


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


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"vehicle.payload.mass": 0.9}, r"mass = 0\.9: must be left out, because it comes from bodies"),
        ({"vehicle.payload.bodies.0.size": [1.0, 1.0, 1.0]}, r"bodies\.0: must have either ends and radius"),
        ({"vehicle.payload.bodies.0.radius": None}, r"bodies\.0: must have ends and radius together"),
        ({"vehicle.payload.bodies.0.euler": [0.1, 0.0, 0.0]}, r"bodies\.0: must have no position and no euler"),
        ({"vehicle.payload.bodies": []}, r"must have one table of bodies or more"),
        ({"vehicle.payload.bodies.2.corners.3": [0.3, 0.0, 0.0]}, r"corners of a convex body; these 4"),
    ],
)
def test_what_contradicts_is_refused_by_name(changes, says):
    with pytest.raises(tl.InputError, match=says):
        tl.load_mission("iris", SEVERAL | changes)


def test_a_saved_flight_has_the_bodies(tmp_path):
    flight = tl.fly(tl.load_mission("iris", SEVERAL | {"mission.duration": 0.01}))
    flight.save(tmp_path / "flight")
    kept = Vehicle.from_mission(tl.Flight.load(tmp_path / "flight").mission).payload
    assert kept == tl.load_mission("iris", SEVERAL).vehicle.payload
