"""Real rotors: lag, limits and strength against closed forms; flights (simulation/) hold delay, faults and ground."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each
from tandemlift.missions import load_mission
from tandemlift.parts.flight_checks.hover_loads import WindOnParts
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.ground_effect import ground_effect_from, ground_effect_ratio
from tandemlift.parts.rotors.rotors import RotorState, rotors_from, rotors_step

VEHICLE = Vehicle.from_settings(load_mission("paper").vehicle)
UP, DOWN, CONSTANT, MOST = 0.0125, 0.025, 5.84e-6, 5.84e-6 * 1100.0**2
LEVEL = State(Vec3(0.0, 0.0, 5.0), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
EIGHT = each(8)


def spun(command, speed, steps, step=0.001):
    """Thrusts and speeds over steps under a held command [N], all rotors alike."""
    r, memory = rotors_from(VEHICLE, step, False, (), None, 1.0), RotorState(EIGHT(*(speed,) * 8), EIGHT(*(0.0,) * 8))
    thrusts, speeds = [], []
    for k in range(steps):
        thrust, memory = rotors_step(r, memory, EIGHT(*(command,) * 8), LEVEL, k * step)
        thrusts.append(thrust[3])
        speeds.append(memory.speed[3])
    return np.array(thrusts), np.array(speeds)


@pytest.mark.parametrize("step", [0.0005, 0.01])
@pytest.mark.parametrize(("first", "last", "tau"), [(0.0, 900.0, UP), (1000.0, 300.0, DOWN)])
def test_speed_follows_its_closed_form_up_and_down_at_any_step(step, first, last, tau):
    _, speeds = spun(CONSTANT * last**2, first, 40, step)
    t = step * np.arange(1, 41)
    assert speeds == pytest.approx(last + (first - last) * np.exp(-t / tau), rel=1e-12)


@pytest.mark.parametrize("command", [-5.0, 0.0, 3.0, MOST, 50.0, 1e9])
def test_thrust_stays_within_limits_and_settles_there(command):
    thrusts, _ = spun(command, 500.0, 800)
    assert thrusts.min() >= 0.0
    assert thrusts.max() <= MOST * (1.0 + 1e-12)
    assert thrusts[-1] == pytest.approx(min(max(command, 0.0), MOST), abs=1e-9)


def test_a_stopped_rotor_ends_at_rest_and_not_in_denormal_numbers():
    _, speeds = spun(0.0, 1000.0, 1200, 0.01)
    assert speeds[-1] < 1e-100
    assert speeds.min() > 1e-150


def test_ground_effect_is_bounded_on_the_floor_and_gone_high_up():
    surface = ground_effect_from(VEHICLE, 0.0)
    on_it = ground_effect_ratio(surface, LEVEL._replace(position=ZERO))
    assert max(on_it) == pytest.approx(4.0 / 3.0, rel=1e-12)
    assert max(ground_effect_ratio(surface, LEVEL)) < 1.0001


def test_ideal_rotors_give_any_thrust_at_once():
    command = EIGHT(-3.0, 0.0, 100.0, *(1.0,) * 5)
    assert rotors_step(Absent(), Absent(), command, LEVEL, 0.0) == (command, Absent())


@pytest.mark.parametrize("scale", [0.8, 1.3])
def test_rotors_of_another_strength_hover_under_the_command_that_is_theirs(scale):
    still = {"pushes": [], "plant.thrust_scale": scale, "mission.duration": 20.0, "phases.land_start": 40.0}
    flight = tl.fly(load_mission("iris", still))
    late = flight.time > 15.0
    commanded = flight["rotor_commands"][late].sum(axis=1).mean()
    assert commanded == pytest.approx(VEHICLE.weight / scale, rel=0.03)  # noise: rotors speed up sooner
    assert flight["position"][late, 2] == pytest.approx(flight["reference_position"][late, 2], abs=5e-3)


def test_ideal_rotors_have_no_strength_of_their_own():
    with pytest.raises(tl.InputError, match=r"plant\.thrust_scale = 1\.1: must be 1, or actuators\.model"):
        load_mission("paper", {"plant.thrust_scale": 1.1})


def test_stronger_rotors_lift_what_the_pilots_could_not():
    heavy = {"plant.mass_scale": 1.7}
    with pytest.raises(tl.InputError, match="rotors lift 56"):
        load_mission("iris", heavy)
    hover = load_mission("iris", heavy | {"plant.thrust_scale": 1.2}).hover
    assert hover.lift == pytest.approx(1.2 * 8 * MOST)
    assert hover.share == pytest.approx(1.7 * VEHICLE.weight / hover.lift)


def test_the_wind_pushes_payload_and_quadrotors_by_their_areas_and_coefficients():
    wind, yaw = np.array([3.0, -2.0, 1.0]), 0.7
    mission = load_mission("iris", {"wind.model": "air", "wind.velocity": wind.tolist(), "wind.density": 1.1})
    vehicle = Vehicle.from_settings(mission.vehicle)
    found = WindOnParts(mission.wind, vehicle, yaw, mission.mission.step)
    turned, payload = Rotation.from_euler("z", yaw), vehicle.payload
    air = turned.inv().apply(wind)

    def force(areas, coefficient):
        return turned.apply(0.5 * 1.1 * coefficient * np.array(areas) * air * np.linalg.norm(air))

    on_beam = force(payload.areas, payload.drag_coefficient)
    assert found.on_payload(0.0) == pytest.approx(on_beam)
    fleet = sum(force(q.drag_area, q.drag_coefficient) for q in vehicle.quadrotors)
    assert found.at(None)[0] == pytest.approx(on_beam + fleet)
