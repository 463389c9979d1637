"""Rotors in flight: what acts is the delayed command through the lag, the fault and the ground, within limits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from storm import COMMAND, DT, storm, storms

import tandemlift as tl
from tandemlift.simulation.preparation.assemble import assemble

FAULT, LEFT = 0.45, 0.8  # s; share of the thrust
EVERY = {
    "mission.log_interval": DT,
    "mission.duration": 0.6,
    "faults": [{"quadrotor": 2, "rotor": 3, "time": FAULT, "efficiency": LEFT, "known_after": 0.05}],
    "pushes.0.time": 0.4,
}
BOTH_TAUS = 0.0125, 0.025  # s, up and down


@pytest.fixture(scope="module")
def flown():
    mission = storm(EVERY)
    return mission, tl.fly(mission)


def check_ground_ratios(mission, flight):
    """Thrust over thrust in free air of every rotor (T, 4N), by Cheeseman and Bennett."""
    vehicle = tl.Vehicle.from_settings(mission.vehicle)
    floor = assemble(mission).model.plant.floor.height
    rotation = Rotation.from_quat(np.roll(flight["attitude"], -1, axis=1))
    ratios = []
    for q, d in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True):
        for x, y in q.rotors:
            z = flight["position"][:, 2] + rotation.apply(np.add(d, [x, y, 0.0]))[:, 2] - floor
            assert z.min() > 0.5 * q.rotor_radius
            ratios.append(1.0 / (1.0 - (q.rotor_radius / (4.0 * z)) ** 2))
    return np.array(ratios).T


def mean_thrusts(commands, constant):
    """Mean over each step of k Ω², with Ω̇ = (√(command/k) − Ω)/τ from rest, by SciPy."""
    count = commands.shape[1]

    def rate(t, y, wanted):
        speed = y[:count]
        tau = np.where(wanted > speed, *BOTH_TAUS)
        return np.concatenate([(wanted - speed) / tau, constant * speed**2])

    y, means = np.zeros(2 * count), []
    for row in commands:
        y[count:] = 0.0
        step = solve_ivp(rate, (0.0, DT), y, "DOP853", rtol=1e-12, atol=1e-12, args=(np.sqrt(row / constant),))
        y = step.y[:, -1]
        means.append(y[count:] / DT)
    return np.array(means)


def test_thrusts_are_the_delayed_commands_through_lag_fault_and_ground_as_scipy_integrates_them(flown):
    mission, flight = flown
    first = np.flatnonzero(flight["rotor_commands"].any(axis=1))[0]
    assert flight.time[first] == pytest.approx(0.3)  # the lift
    commands = flight["rotor_commands"][first:-COMMAND]
    acting = slice(first + COMMAND, None)
    share = np.ones_like(commands)
    share[flight.time[acting] >= FAULT - 1e-9, 6] = LEFT
    ratios = check_ground_ratios(mission, flight)[acting]
    expected = mean_thrusts(commands, mission.vehicle.quadrotors[0].thrust_constant) * share * ratios
    assert ratios.max() > 1.01
    np.testing.assert_allclose(flight["rotor_thrusts"][acting], expected, rtol=1e-9, atol=1e-9)
    assert np.all(flight["rotor_thrusts"][: first + COMMAND] == 0.0)


def test_a_rotor_fails_at_its_time_and_not_a_step_sooner_or_later(flown):
    _, flight = flown
    healthy = tl.fly(storm(EVERY | {"faults.0.time": 900.0}))
    k = round(FAULT / DT)
    assert np.array_equal(flight["rotor_thrusts"][:k], healthy["rotor_thrusts"][:k])
    assert flight["rotor_thrusts"][k, 6] == pytest.approx(LEFT * healthy["rotor_thrusts"][k, 6], rel=1e-12)
    assert np.array_equal(np.delete(flight["rotor_thrusts"][k], 6), np.delete(healthy["rotor_thrusts"][k], 6))


def test_a_pilot_that_knows_of_a_fault_asks_for_what_is_left_of_it_from_then_on(flown):
    _, flight = flown
    unknown = tl.fly(storm(EVERY | {"faults.0.known_after": 900.0}))
    k = round((FAULT + 0.05) / DT)
    assert np.array_equal(flight["rotor_commands"][:k], unknown["rotor_commands"][:k])
    ratio = flight["rotor_commands"][k] / unknown["rotor_commands"][k]
    np.testing.assert_allclose(ratio, [1.0] * 6 + [1.0 / LEFT, 1.0], rtol=1e-12)


def test_no_command_and_no_thrust_ever_leaves_its_limits():
    for mission in storms(6):
        flight = tl.fly(mission)
        most = mission.vehicle.quadrotors[0].thrust_limit
        assert flight["rotor_commands"].min() >= 0.0
        assert flight["rotor_commands"].max() <= most * (1.0 + 1e-12)
        assert flight["rotor_thrusts"].min() >= 0.0
        assert np.all(flight["rotor_thrusts"] <= most * check_ground_ratios(mission, flight) * (1.0 + 1e-12))
        assert np.all(flight["allocation_fraction"] <= 1.0)
