"""Centres of mass off the pilot's and off the payload's middle: in both engines, felt rightly, drawn and written."""

from xml.etree import ElementTree

import numpy as np
import pytest
from flights import in_both
from plugin_peer import Plugin, RigidBody
from storm import PERFECT

import tandemlift as tl
from tandemlift.engines.gazebo import GazeboBody
from tandemlift.engines.gazebo_wire import Wire
from tandemlift.engines.models.links import links_of
from tandemlift.engines.models.visuals import vehicle_shapes
from tandemlift.engines.mujoco import MuJoCoBody
from tandemlift.parts.contact.hull import hull
from tandemlift.parts.mechanics.vehicle import Vehicle, parallel_axis_term
from tandemlift.pictures.drawing.clearances import clearances

OFF = [0.005, 0.03, -0.02]
OFFSET = {"plant.center_of_mass_offset": OFF}
PAYLOAD_OFF = [0.02, 0.3, -0.01]
PRODUCTS = [0.004, 0.0, 0.02]
CENTER = {
    "vehicle.payload.center_of_mass": PAYLOAD_OFF,
    "vehicle.payload.inertia": [0.17, 0.03, 0.16],
    "vehicle.payload.products": PRODUCTS,
}
DT = 0.001
SCALES = {"plant.mass_scale": 1.05, "plant.inertia_scale": [1.05, 1.05, 1.05]}
TILTED = {"initial.euler": [0.1, -0.2, 0.3], "initial.rates": [0.5, -0.4, 0.3], "initial.velocity": [0.3, 0.0, -0.2]}


TOLERANCES = {  # of an offset that the pilot does not know, and of a payload's that it knows
    "vehicle": {"position": 1e-3, "attitude": 1e-3, "joint_force": 0.1},
    "payload": {"position": 1e-3, "attitude": 2e-4, "joint_force": 0.01, "joint_torque": 0.005},
}


@pytest.mark.thorough
@pytest.mark.parametrize("off", TOLERANCES)
def test_it_flies_the_same_in_mujoco(off):
    changes = OFFSET | SCALES if off == "vehicle" else CENTER
    a, b = in_both(tl.load_mission("iris", changes | {"mission.duration": 16.0}))
    assert np.abs(a["push_force"]).max() > 1.0
    flies = a.time > 3.0  # uneven on the floor it rocks first
    for name, most in TOLERANCES[off].items():
        assert np.abs(a[name] - b[name])[flies].max() < most, name


def test_hover_balances_the_weight_at_the_real_centre():
    """The rotors' moment about the modelled centre is that of the weight's reaction, off it."""
    level = {"pushes": [], "ground.effect": False, "mission.duration": 24.0}
    flight = tl.fly(tl.load_mission("iris", OFFSET | level))
    vehicle = Vehicle.from_settings(tl.load_mission("iris").vehicle)
    wrench, weight = flight["rotor_thrusts"][flight.time > 12.0].mean(axis=0) @ vehicle.effect.T, vehicle.weight
    assert wrench[:3] == pytest.approx([weight, weight * OFF[1], -weight * OFF[0]], abs=0.03)


def test_links_of_models_have_mass_centre_and_inertia_of_the_real_vehicle():
    mission = tl.load_mission("iris", OFFSET | SCALES)
    vehicle, links = Vehicle.from_settings(mission.vehicle), links_of(mission, Vehicle.from_settings(mission.vehicle))
    masses, places = np.array([link.mass for link in links]), np.array([link.position + link.center for link in links])
    assert masses.sum() == pytest.approx(1.05 * vehicle.mass)
    assert masses @ places / masses.sum() == pytest.approx(OFF, abs=1e-12)
    about = [parallel_axis_term(m, d - OFF) for m, d in zip(masses, places, strict=True)]
    total = sum(about) + sum(link.inertia for link in links)
    assert total == pytest.approx(vehicle.real_inertia(mission.plant), abs=1e-12)


def test_gazebo_tells_of_the_real_centre_and_is_read_at_the_modelled_one():
    """A stand-in for the plugin, of the vehicle with the real payload, beside MuJoCo."""
    pytest.importorskip("mujoco")
    mission = tl.load_mission(
        "iris", OFFSET | TILTED | {"ground.model": "none", "ground.effect": False, "phases.rotors": "always"}
    )
    vehicle = Vehicle.from_settings(mission.vehicle)
    link = links_of(mission, vehicle)[0]
    xy, xz, yz = link.inertia[0, 1], link.inertia[0, 2], link.inertia[1, 2]
    real = {
        "mass": link.mass,
        "center_of_mass": link.center,
        "inertia": np.diag(link.inertia),
        "products": (xy, xz, yz),
    }
    payload = type(vehicle.payload)(**{key: np.array(value).tolist() for key, value in real.items()})
    body = RigidBody(Vehicle(payload, vehicle.quadrotors))
    thrusts, force, moment = np.linspace(3.0, 5.0, 8), np.array([2.0, 1.0, -3.0]), np.array([0.1, -0.2, 0.05])
    with Plugin(body, DT, mass=vehicle.mass) as plugin:
        flown = GazeboBody(mission, vehicle, connect=lambda *_: (None, Wire(plugin.port, 2)))
        beside = MuJoCoBody(mission, vehicle)
        for _ in range(50):
            flown.advance(thrusts, np.zeros(0), force, moment)
            beside.advance(thrusts, np.zeros(0), force, moment)
        assert flown.state == pytest.approx(beside.state, abs=1e-4)
        assert flown.readings == pytest.approx(beside.readings, abs=0.02)
        flown.close()


# a payload with its mass off its middle and its axes


def vehicle_of(**changes):
    return Vehicle.from_settings(tl.load_mission("iris", CENTER | changes).vehicle)


def test_mass_and_inertia_are_those_of_the_parts_at_their_places():
    """Summed over mass points, six of each part on its principal axes, with its moments about its own centre."""
    vehicle, points = vehicle_of(), []
    xy, xz, yz = PRODUCTS
    own = np.array([[0.17, xy, xz], [xy, 0.03, yz], [xz, yz, 0.16]])
    parts = [(vehicle.payload.mass, PAYLOAD_OFF, own)]
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
    assert vehicle.payload_center == pytest.approx(np.array(PAYLOAD_OFF) - center)
    r = places - center
    J = sum(m * (d @ d * np.eye(3) - np.outer(d, d)) for m, d in zip(masses, r, strict=True))
    assert vehicle.inertia == pytest.approx(J, abs=1e-12)


@pytest.mark.thorough
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


@pytest.mark.thorough
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
    assert np.fromstring(link.find("inertial/pose").text, sep=" ")[:3] == pytest.approx(PAYLOAD_OFF, abs=1e-6)
