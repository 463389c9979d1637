"""On the floor: a vehicle that stands stays, and one that falls loses energy and never gains any."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.types import GRAVITY
from tandemlift.simulation.preparation.assemble import assemble

DT = 0.001
STOPPED = {"phases.lift_start": 100.0, "phases.land_start": 200.0, "estimator.tare_start": 300.0, "pushes": []}


def resting(changes):
    """A flight of `iris` whose rotors never start."""
    mission = tl.load_mission("iris", STOPPED | changes)
    return mission, tl.fly(mission)


def test_a_vehicle_that_stands_stays_where_it_is():
    _, flight = resting({"mission.duration": 14.0, "initial.euler": [0.002, -0.001, 0.3], "ground.height": -0.15})
    settled = flight.time >= 4.0  # s: it has dropped and come to rest
    weight = 3.5 * GRAVITY
    assert np.ptp(flight["position"][settled], axis=0).max() < 1e-6  # m
    assert np.ptp(flight["euler"][settled], axis=0).max() < 1e-6  # rad
    assert np.all(flight["rotor_thrusts"] == 0.0)
    np.testing.assert_allclose(flight["contact_force"][-1], [0.0, 0.0, weight], atol=1e-6)


def test_it_stands_as_deep_in_the_floor_as_its_settings_say():
    mission, flight = resting({"mission.duration": 3.0, "ground.height": -0.15, "ground.sinkage": 4e-4})
    lowest = tl.Vehicle.from_settings(mission.vehicle).lever_arms[:, 2].min() - 0.18
    assert flight["position"][-1, 2] + lowest == pytest.approx(-0.15 - 4e-4, abs=1e-9)


def soles(mission):
    """Centre of every foot's ball joint from the centre of mass (4N, 3) [m, body axes], and the floor's law."""
    floor = assemble(mission).model.plant.floor
    return np.concatenate([np.array(feet).T for feet in floor.feet]), floor


def energies(mission, flight):
    """Kinetic and potential energy, and what the normal springs of the feet hold [J]."""
    vehicle = tl.Vehicle.from_settings(mission.vehicle)
    v, w, m = flight["velocity"], flight["rates"], vehicle.mass
    kinetic = 0.5 * m * np.sum(v * v, axis=1) + 0.5 * np.sum(w * (w @ vehicle.inertia), axis=1)
    feet, floor = soles(mission)
    rotation = Rotation.from_quat(np.roll(flight["attitude"], -1, axis=1))
    z = flight["position"][:, 2, None] + np.stack([rotation.apply(foot)[:, 2] for foot in feet], axis=1)
    depth = np.maximum(floor.height + floor.radius - z, 0.0)
    return kinetic + m * GRAVITY * flight["position"][:, 2], 0.5 * floor.stiffness * np.sum(depth**2, axis=1)


DROPS = {
    "level": {"initial.euler": 0.0},
    "tilted": {"initial.euler": [0.15, -0.1, 0.4], "initial.rates": [1.0, -0.5, 0.3]},
    "thrown": {"initial.velocity": [0.8, -0.5, -0.5], "initial.euler": [-0.1, 0.2, 0.0]},
}


@pytest.mark.parametrize("friction", [0.0, 0.8])
@pytest.mark.parametrize("drop", DROPS.values(), ids=DROPS)
def test_a_drop_with_stopped_rotors_never_gains_energy(drop, friction):
    changes = {"ground.height": -0.5, "ground.friction": friction, "mission.log_interval": DT, "crash.impulse": 1e3}
    mission, flight = resting(changes | drop | {"mission.duration": 4.0, "vehicle.drag.force": 0.0})
    motion, springs = energies(mission, flight)
    energy, floor = motion + springs, soles(mission)[1]
    grips = (friction * flight["contact_force"][:, 2]) ** 2 / (2.0 * floor.tangential_stiffness)  # the most they hold
    assert springs.max() > 1.0
    assert np.all(energy[1:] <= np.minimum.accumulate(energy + grips)[:-1] + 1e-9)  # J
    if friction:
        assert np.abs(flight["velocity"][-1]).max() < 1e-6
        assert energy[-1] < energy[0] - 10.0
