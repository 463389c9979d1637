"""A payload with its mass off its middle and its axes: in both engines, felt rightly, drawn and written as it is."""

from xml.etree import ElementTree

import numpy as np
import pytest
from storm import PERFECT

import tandemlift as tl
from tandemlift.engines.models.visuals import vehicle_shapes
from tandemlift.parts.contact.hull import hull
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.clearances import clearances

OFF = [0.02, 0.3, -0.01]
PRODUCTS = [0.004, 0.0, 0.02]
CENTER = {
    "vehicle.payload.center_of_mass": OFF,
    "vehicle.payload.inertia": [0.17, 0.03, 0.16],
    "vehicle.payload.products": PRODUCTS,
}


def vehicle_of(**changes):
    return Vehicle.from_settings(tl.load_mission("iris", CENTER | changes).vehicle)


def test_mass_and_inertia_are_those_of_the_parts_at_their_places():
    """Summed over mass points, six of each part on its principal axes, with its moments about its own centre."""
    vehicle, points = vehicle_of(), []
    xy, xz, yz = PRODUCTS
    own = np.array([[0.17, xy, xz], [xy, 0.03, yz], [xz, yz, 0.16]])
    parts = [(vehicle.payload.mass, OFF, own)]
    parts += [(q.mass, q.position, np.diag(q.inertia)) for q in vehicle.quadrotors]
    for mass, place, tensor in parts:
        moments, axes = np.linalg.eigh(tensor)
        squares = (sum(moments) / 2.0 - moments) / mass  # of the distances along each axis
        for axis in range(3):
            away = axes[:, axis] * np.sqrt(3.0 * squares[axis])
            points += [(mass / 6.0, np.array(place) + side * away) for side in (1.0, -1.0)]
    masses, places = np.array([m for m, _ in points]), np.array([p for _, p in points])
    center = masses @ places / masses.sum()
    assert vehicle.mass == pytest.approx(masses.sum())
    assert vehicle.center_of_mass == pytest.approx(center)
    assert vehicle.origin == pytest.approx(-center)
    assert vehicle.payload_center == pytest.approx(np.array(OFF) - center)
    r = places - center
    J = sum(m * (d @ d * np.eye(3) - np.outer(d, d)) for m, d in zip(masses, r, strict=True))
    assert vehicle.inertia == pytest.approx(J, abs=1e-12)


@pytest.fixture(scope="module")
def both():
    pytest.importorskip("mujoco")
    mission = tl.load_mission("iris", CENTER | {"mission.duration": 26.0})
    return tl.fly(mission), tl.fly(mission, engine="mujoco")


def test_it_flies_the_same_in_mujoco(both):
    a, b = both
    assert np.abs(a["push_force"]).max() > 1.0
    for name, most in (("position", 1e-3), ("attitude", 2e-4), ("joint_force", 0.01), ("joint_torque", 0.005)):
        flies = a.time > 3.0  # uneven on the floor it rocks first
        assert np.abs(a[name] - b[name])[flies].max() < most, name


def test_the_push_and_its_place_on_the_beam_are_felt_as_they_are():
    """A steady push of 2 N half a metre from the middle of the beam, by sensors without errors."""
    vehicle = vehicle_of()
    point = (vehicle.origin + np.array([0.0, 0.5, 0.0])).tolist()
    push = {"force": [2.0, 0.0, 0.0], "time": 30.0, "sigma": 2.0, "point": point}
    flight = tl.fly(tl.load_mission("iris", CENTER | PERFECT | {"pushes": [push], "mission.duration": 31.0}))
    peak = np.abs(flight.time - 30.0) < 0.1
    assert flight["push_estimate"][peak].mean(axis=0) == pytest.approx([2.0, 0.0, 0.0], abs=0.05)
    assert flight["push_point_estimate"][peak].mean() == pytest.approx(0.5, abs=0.01)
    assert flight["payload_mass_estimate"][peak].mean() == pytest.approx(vehicle.payload.mass, abs=0.002)


def test_nothing_pushes_and_it_stays():
    flight = tl.fly(tl.load_mission("iris", CENTER | {"pushes": [], "mission.duration": 30.0}))
    assert flight.findings == ()
    assert np.abs(flight["push_estimate"][flight.time > 14.0]).max() < 0.3
    assert np.abs(flight["position"][flight.time > 14.0, :2]).max() < 0.05


def test_the_beam_stays_where_it_is_whatever_its_mass():
    """Its middle is at the origin, in pictures, in contact and in the distance from walls."""
    vehicle = vehicle_of()
    (beam,) = [shape for shape in vehicle_shapes(vehicle) if shape.name == "beam"]
    assert beam.position == pytest.approx(vehicle.origin)
    ends = hull(vehicle, vehicle.mass, 1e-3).beam.center
    assert np.mean(ends, axis=1) == pytest.approx(vehicle.origin)
    wall = {"walls": [{"start": [3.0, -4.0], "end": [3.0, 4.0]}], "mission.duration": 0.1, "pushes": []}
    flight = tl.fly(tl.load_mission("iris", CENTER | wall))
    start = flight["position"][0, 0] + vehicle.origin[0]
    assert clearances(flight).beam[0] == pytest.approx(3.0 - start - vehicle.payload.radius, abs=1e-6)


def test_models_for_mujoco_and_gazebo_have_the_mass_off_the_middle(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    from tandemlift.apps.export.write import export

    mission, vehicle = tl.load_mission("iris", CENTER), vehicle_of()
    model = mujoco.MjModel.from_xml_path(str(export(mission, tmp_path / "off.xml")))
    assert model.body("payload").ipos == pytest.approx(vehicle.payload_center, abs=1e-6)
    R = np.empty(9)
    mujoco.mju_quat2Mat(R, model.body("payload").iquat)
    R = R.reshape(3, 3)
    assert R @ np.diag(model.body("payload").inertia) @ R.T == pytest.approx(vehicle.payload.tensor, abs=1e-6)
    assert model.site("payload").pos == pytest.approx(vehicle.origin, abs=1e-6)
    link = ElementTree.parse(export(mission, tmp_path / "off.sdf")).find(".//link[@name='payload']")
    assert np.fromstring(link.find("pose").text, sep=" ")[:3] == pytest.approx(vehicle.origin, abs=1e-6)
    written = {part.tag: float(part.text) for part in link.find("inertial/inertia")}
    assert [written[name] for name in ("ixy", "ixz", "iyz")] == pytest.approx(PRODUCTS, abs=1e-6)
    assert np.fromstring(link.find("inertial/pose").text, sep=" ")[:3] == pytest.approx(OFF, abs=1e-6)


def test_products_that_no_body_has_are_refused_with_the_moments_that_they_would_give():
    with pytest.raises(tl.InputError, match=r"products of inertia of a body; its principal moments would be -0\.0"):
        vehicle_of(**{"vehicle.payload.products": [0.0, 0.0, 0.09]})
