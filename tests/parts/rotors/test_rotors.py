"""Real rotors: lag, limits, delay, faults and ground effect against their closed forms."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.vector import ZERO, Absent, Quat, Vec3, each
from tandemlift.missions import load_mission
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.ground_effect import ground_effect_from, ground_effect_ratio
from tandemlift.parts.rotors.rotor_faults import RotorFaults
from tandemlift.parts.rotors.rotors import RotorState, rotors_from, rotors_step

VEHICLE = Vehicle.from_settings(load_mission("paper").vehicle)
UP, DOWN, CONSTANT, MOST = 0.0125, 0.025, 5.84e-6, 5.84e-6 * 1100.0**2
LEVEL = State(Vec3(0.0, 0.0, 5.0), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
EIGHT = each(8)


def rotors(step=0.001, *, late=False, faults=None, surface=None):
    plain = rotors_from(VEHICLE, step, late, (), None, 1.0)
    return plain._replace(faults=faults or Absent(), surface=surface or Absent())


def spun(command, speed, steps, step=0.001):
    """Thrusts and speeds over steps under a held command [N], all rotors alike."""
    r, memory = rotors(step), RotorState(EIGHT(*(speed,) * 8), EIGHT(*(0.0,) * 8))
    thrusts, speeds = [], []
    for k in range(steps):
        thrust, memory = rotors_step(r, memory, EIGHT(*(command,) * 8), LEVEL, k * step)
        thrusts.append(thrust[3])
        speeds.append(memory.speed[3])
    return np.array(thrusts), np.array(speeds)


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.01])
@pytest.mark.parametrize(("first", "last", "tau"), [(0.0, 900.0, UP), (1000.0, 300.0, DOWN)])
def test_speed_follows_its_closed_form_up_and_down_at_any_step(step, first, last, tau):
    _, speeds = spun(CONSTANT * last**2, first, 40, step)
    t = step * np.arange(1, 41)
    assert speeds == pytest.approx(last + (first - last) * np.exp(-t / tau), rel=1e-12)


@pytest.mark.parametrize(("first", "last", "tau"), [(0.0, 900.0, UP), (1000.0, 300.0, DOWN)])
def test_the_impulse_of_a_step_is_that_of_the_lag(first, last, tau):
    thrusts, _ = spun(CONSTANT * last**2, first, 5, 0.004)

    def thrust(t):
        return CONSTANT * (last + (first - last) * math.exp(-t / tau)) ** 2

    for k, mean in enumerate(thrusts):
        impulse, _ = quad(thrust, 0.004 * k, 0.004 * (k + 1), epsabs=1e-14)
        assert mean * 0.004 == pytest.approx(impulse, rel=1e-11)


@pytest.mark.parametrize("command", [-5.0, 0.0, 3.0, MOST, 50.0, 1e9])
def test_thrust_stays_within_limits_and_settles_there(command):
    thrusts, _ = spun(command, 500.0, 800)
    assert thrusts.min() >= 0.0
    assert thrusts.max() <= MOST * (1.0 + 1e-12)
    assert thrusts[-1] == pytest.approx(min(max(command, 0.0), MOST), abs=1e-9)


def test_a_stopped_rotor_ends_at_rest_and_not_in_denormal_numbers():
    _, speeds = spun(0.0, 1000.0, 12_000)
    assert speeds[-1] < 1e-100
    assert speeds.min() > 1e-150


def test_a_late_command_is_the_one_that_arrives():
    r = rotors(late=True)
    arriving, given = EIGHT(*(5.0,) * 8), EIGHT(*(1.0,) * 8)
    late, after = rotors_step(r, RotorState(EIGHT(*(800.0,) * 8), arriving), given, LEVEL, 0.0)
    at_once, _ = rotors_step(rotors(), RotorState(EIGHT(*(800.0,) * 8), given), arriving, LEVEL, 0.0)
    assert late == at_once
    assert after.arriving == given


def test_a_rotor_fails_at_its_time_and_keeps_its_share():
    times, left = (
        EIGHT(*[2.0 if i == 4 else 1e18 for i in range(8)]),
        EIGHT(*[0.3 if i == 4 else 1.0 for i in range(8)]),
    )
    speed = math.sqrt(4.0 / CONSTANT)
    r, memory = rotors(faults=RotorFaults(times, left)), RotorState(EIGHT(*(speed,) * 8), EIGHT(*(0.0,) * 8))
    before, _ = rotors_step(r, memory, EIGHT(*(4.0,) * 8), LEVEL, 1.999)
    after, _ = rotors_step(r, memory, EIGHT(*(4.0,) * 8), LEVEL, 2.0)
    assert list(before) == pytest.approx([4.0] * 8, rel=1e-12)
    assert list(after) == pytest.approx([4.0] * 4 + [1.2] + [4.0] * 3, rel=1e-12)


@pytest.mark.parametrize("height", [0.1, 0.2, 0.5, 2.0])
def test_thrust_near_the_floor_is_that_of_cheeseman_and_bennett(height):
    surface, radius = ground_effect_from(VEHICLE, -1.0), 0.128
    low = LEVEL._replace(position=Vec3(0.0, 0.0, height - 1.0 - float(VEHICLE.lever_arms[0, 2])))
    assert list(ground_effect_ratio(surface, low)) == pytest.approx(
        [1.0 / (1.0 - (radius / (4.0 * height)) ** 2)] * 8, rel=1e-12
    )


def test_ground_effect_is_bounded_on_the_floor_and_gone_high_up():
    surface = ground_effect_from(VEHICLE, 0.0)
    on_it = ground_effect_ratio(surface, LEVEL._replace(position=ZERO))
    assert max(on_it) == pytest.approx(4.0 / 3.0, rel=1e-12)
    assert max(ground_effect_ratio(surface, LEVEL)) < 1.0001


def test_each_rotor_of_a_tilted_vehicle_gains_by_its_own_height():
    """Heights by SciPy's rotation; in flight the ratio multiplies the thrust of the free rotor."""
    turned, low = Rotation.from_euler("zxy", [0.8, 0.2, -0.15]), Vec3(0.4, -0.3, 0.5)
    state = LEVEL._replace(position=low, attitude=Quat(*turned.as_quat(scalar_first=True).tolist()))
    surface = ground_effect_from(VEHICLE, 0.0)
    height = 0.5 + turned.apply(np.transpose(surface.rotors))[:, 2]
    assert np.ptp(height) > 0.15
    ratio = 1.0 / (1.0 - (0.128 / (4.0 * np.maximum(height, 0.064))) ** 2)
    assert list(ground_effect_ratio(surface, state)) == pytest.approx(ratio.tolist(), rel=1e-12)
    memory, command = RotorState(EIGHT(*(800.0,) * 8), EIGHT(*(0.0,) * 8)), EIGHT(*(4.0,) * 8)
    near, _ = rotors_step(rotors(surface=surface), memory, command, state, 0.0)
    free, _ = rotors_step(rotors(), memory, command, state, 0.0)
    assert list(near) == pytest.approx((np.array(free) * ratio).tolist(), rel=1e-12)


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
