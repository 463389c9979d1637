"""A vehicle whose real centre of mass is off the pilot's: in both engines, at its joints, in models, and told of."""

import numpy as np
import pytest
from plugin_peer import Plugin, RigidBody

import tandemlift as tl
from tandemlift.engines.gazebo import GazeboBody
from tandemlift.engines.gazebo_wire import Wire
from tandemlift.engines.models.links import links_of
from tandemlift.engines.mujoco import MuJoCoBody
from tandemlift.parts.mechanics.vehicle import Vehicle, parallel_axis_term

OFF = [0.005, 0.03, -0.02]
OFFSET = {"plant.center_of_mass_offset": OFF}
DT = 0.001
SCALES = {"plant.mass_scale": 1.05, "plant.inertia_scale": [1.05, 1.05, 1.05]}
TILTED = {"initial.euler": [0.1, -0.2, 0.3], "initial.rates": [0.5, -0.4, 0.3], "initial.velocity": [0.3, 0.0, -0.2]}


def flown(changes, **options):
    return tl.fly(tl.load_mission("iris", OFFSET | changes), **options)


def real_vehicle(mission, vehicle):
    """The vehicle that its links make, for an offset alone."""
    center = tuple(links_of(mission, vehicle)[0].center)
    return Vehicle(vehicle.payload.model_copy(update={"center_of_mass": center}), vehicle.quadrotors)


@pytest.fixture(scope="module")
def both():
    pytest.importorskip("mujoco")
    return [flown(SCALES | {"mission.duration": 26.0}, engine=engine) for engine in ("compiled", "mujoco")]


def test_it_flies_the_same_in_mujoco(both):
    a, b = both
    assert np.abs(a["push_force"]).max() > 1.0
    for name, most in (("position", 1e-3), ("attitude", 1e-3), ("joint_force", 0.1)):
        flies = (a.time > 3.0) & (a.time < 20.0)  # uneven on the floor it rocks first; later a rotor is at its limit
        assert np.abs(a[name] - b[name])[flies].max() < most, name


def test_hover_balances_the_weight_at_the_real_centre():
    """The rotors' moment about the modelled centre is that of the weight's reaction, off it."""
    flight = flown({"pushes": [], "ground.effect": False, "mission.duration": 24.0})
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


def test_the_real_vehicle_is_one_with_the_payloads_mass_off_its_place():
    """With an offset alone: the payload keeps its inertia, and lies where that takes it."""
    mission = tl.load_mission("iris", OFFSET)
    vehicle = Vehicle.from_settings(mission.vehicle)
    payload = links_of(mission, vehicle)[0]
    assert payload.inertia == pytest.approx(vehicle.payload.tensor, abs=1e-12)
    real = real_vehicle(mission, vehicle)
    assert real.center_of_mass - vehicle.center_of_mass == pytest.approx(OFF, abs=1e-12)
    assert real.inertia == pytest.approx(vehicle.real_inertia(mission.plant), abs=1e-12)


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


def test_a_check_tells_of_a_rotor_that_the_weight_off_the_centre_overloads():
    with pytest.warns(UserWarning, match="in hover a rotor of quadrotor 1 would give") as told:
        tl.load_mission("iris", {"plant.center_of_mass_offset": [0.0, 0.7, 0.0]})
    assert told
