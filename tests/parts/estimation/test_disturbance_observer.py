"""The disturbance observer: against closed forms and SciPy's linear simulation."""

from typing import NamedTuple

import numpy as np
import pytest
from scipy.signal import StateSpace, lsim

import tandemlift as tl
from tandemlift.core.low_pass import low_pass_step
from tandemlift.core.vector import ZERO, Quat, Vec3, each, vec3
from tandemlift.parts.guidance.disturbance_observer import correction, growth, observer_step, start_observer
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.parts.rotors.allocation import mixer_from

H = 1e-3
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)


class Told(NamedTuple):
    state: State
    push: Vec3
    moment: Vec3


def started(**keys):
    changes = {f"observer.{key}": value for key, value in keys.items()}
    mission = tl.load_mission("iris", {"vehicle.drag.force": 0.0, "vehicle.drag.moment": 0.0, **changes})
    vehicle = Vehicle.from_settings(mission.vehicle)
    return vehicle, *start_observer(
        mission.observer,
        vehicle,
        mixer_from(vehicle.effect),
        mission.mission.step,
        mission.initial,
        hovers=mission.actuators.start == "hover",
    )


def test_the_model_of_the_thrusts_is_as_late_as_the_rotors_and_the_sample():
    """Behind a ramp, a critically damped low-pass stays by its slope times lag, delay and step together."""
    vehicle, observer, memory = started(rotor_lag=0.08, rotor_delay=0.03)
    late, state = 0.08 + 0.03 + H, memory.thrust._replace(value=0.0)
    assert vehicle.count == 2
    for k in range(2000):
        state = low_pass_step(observer.thrust, state, 5.0 * k * H)
    assert 5.0 * 1999 * H - state.value == pytest.approx(5.0 * late, rel=0.02)


def hover(vehicle):
    thrusts = vehicle.allocation(((1.0,) * 4,)) @ [vehicle.weight, 0.0, 0.0, 0.0]
    return each(vehicle.rotor_count)(*thrusts.tolist())


def estimates(force, steps, push=ZERO, **keys):
    """What is found of a force f(t) [N] on a vehicle whose rotors carry its weight, at every step."""
    vehicle, k, memory = started(**keys)
    memory = memory._replace(thrust=memory.thrust._replace(value=vehicle.weight))
    thrusts, velocity, found = hover(vehicle), np.zeros(3), []
    for i in range(steps):
        told = Told(State(ZERO, vec3(velocity), LEVEL, ZERO), push, ZERO)
        unknown, memory = observer_step(k, memory, told, thrusts, 1.0, 1.0, H)
        found.append(unknown.force)
        velocity = velocity + (force(i * H) + np.array(push)) / vehicle.mass * H
    return np.array(found)


def test_the_linear_observer_is_the_low_pass_of_second_order_that_the_theory_gives():
    found = estimates(lambda t: np.array([1.0, 0.0, -0.5]), 2000, model="extended-state", force_bandwidth=8.0)
    w = 8.0  # d_hat/d = w²/(s + w)²
    system = StateSpace([[0.0, 1.0], [-w * w, -2.0 * w]], [[0.0], [w * w]], [[1.0, 0.0]], [[0.0]])
    times = np.arange(2000) * H
    _, expected, _ = lsim(system, np.ones(2000), times)
    assert np.abs(found[:, 0] - expected).max() < 0.012  # two steps late
    assert np.abs(found[:, 2] + 0.5 * expected).max() < 0.012
    assert not found[:, 1].any()


def test_super_twisting_follows_no_faster_than_its_slope():
    found = estimates(lambda t: np.array([20.0, 0.0, 0.0]), 3000, model="super-twisting", force_slope=12.0)
    slopes = np.diff(found[:, 0]) / H
    assert slopes.max() <= 12.0 * (1.0 + 1e-9)
    assert slopes[100:1000].min() > 11.9  # while it is far away
    assert abs(found[-1, 0] - 20.0) < 0.2


def test_super_twisting_finds_a_ramp_within_its_slope_in_finite_time_where_the_linear_one_lags():
    def ramp(t):
        return np.array([3.0 * t, 0.0, 0.0])

    times = np.arange(4000) * H
    linear = estimates(ramp, 4000, model="extended-state", force_bandwidth=4.0)[:, 0]
    assert abs(linear[-1] - 3.0 * times[-1] + 3.0 * 2.0 / 4.0) < 0.02  # 2/w late, for ever
    steep = estimates(ramp, 4000, model="super-twisting", force_bandwidth=400.0, force_slope=6.0)[:, 0]
    assert np.abs(steep[1000:] - 3.0 * times[1000:]).max() < 0.06


def test_a_push_that_is_measured_is_no_disturbance():
    found = estimates(lambda t: np.zeros(3), 1000, push=Vec3(2.0, -1.0, 0.5), model="super-twisting")
    assert np.abs(found).max() < 1e-9


def test_the_parts_of_the_injection_meet_continuously():
    w, slope = 5.0, 2.0
    e = np.linspace(-1.0, 1.0, 20001)
    assert np.allclose(correction(e, w, slope)[np.abs(e) <= 0.08], 2.0 * w * e[np.abs(e) <= 0.08])
    assert np.abs(np.diff(correction(e, w, slope))).max() <= 2.0 * w * 1e-4 * (1.0 + 1e-9)
    assert np.abs(growth(e, w, slope)).max() == slope
    far = np.abs(e) > 0.08
    assert np.allclose(np.abs(correction(e, w, slope))[far], 2.0 * np.sqrt(slope * np.abs(e[far])))


def test_nothing_is_estimated_on_the_ground():
    vehicle, k, memory = started(model="super-twisting")
    for _ in range(100):
        told = Told(State(ZERO, Vec3(1.0, 0.0, 0.0), LEVEL, Vec3(0.3, 0.2, 0.1)), ZERO, ZERO)
        unknown, memory = observer_step(k, memory, told, hover(vehicle) * 0.0, 0.0, 1.0, H)
        assert unknown.force == ZERO
        assert unknown.moment == ZERO
    learned = memory._replace(acceleration=Vec3(0.1, 0.2, 0.3), turning=Vec3(0.3, 0.2, 0.1))
    unknown, memory = observer_step(k, learned, told, hover(vehicle) * 0.0, 0.0, 1.0, H)
    assert (unknown.force, unknown.moment) == (ZERO, ZERO)  # what was learned in flight is forgotten


def test_a_disturbing_moment_is_found_about_every_axis():
    vehicle, k, memory = started(model="super-twisting", moment_bandwidth=20.0)
    memory = memory._replace(thrust=memory.thrust._replace(value=vehicle.weight))
    J, moment, rates = vehicle.inertia, np.array([0.4, -0.03, 0.2]), np.zeros(3)
    for _ in range(1500):
        told = Told(State(ZERO, ZERO, LEVEL, vec3(rates)), ZERO, ZERO)
        unknown, memory = observer_step(k, memory, told, hover(vehicle), 1.0, 1.0, H)
        rates = rates + np.linalg.solve(J, moment - np.cross(rates, J @ rates)) * H
    assert np.array(unknown.moment) == pytest.approx(moment, rel=0.02, abs=1e-3)


def test_an_observer_without_limits_of_the_rotors_is_refused():
    with pytest.raises(tl.InputError, match=r"observer.model = .super-twisting.: must be .none. unless allocation"):
        tl.load_mission("paper", {"observer.model": "super-twisting"})
