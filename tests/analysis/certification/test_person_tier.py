"""The admittance at the hand against simulated pushes, closed forms and flights; contact against ISO's numbers."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.certification.admittance_map import admittance_family, family_limit
from tandemlift.analysis.certification.contact_limits import REGIONS, tolerated_speed
from tandemlift.analysis.certification.felt_admittance import (
    ArmImpedance,
    FeltAdmittance,
    felt_admittance,
    is_coupled_stable,
    stiffness_limit,
)
from tandemlift.analysis.certification.flown import flown_limit, hover_as_flown, trial_of
from tandemlift.analysis.certification.person import ArmBox, leading_impedance, passivity, person_tier
from tandemlift.missions import load_mission

W = np.geomspace(0.01, 300.0, 500)
GRIP = (0.0, 0.0, -0.0642857)  # m, of iris's payload from the centre of mass


@cache
def felt():
    return felt_admittance(load_mission("iris"))


def one_axis(Y):
    return FeltAdmittance(W, Y[:, None, None])


def simulated(frequency, amplitude=0.1):
    """Velocity of iris's grip over a sinusoidal push on it, from the steps of a simulation."""
    hover, at = hover_as_flown(load_mission("iris", {"admittance.threshold": 0.001}))
    sim = tl.Simulation(hover.model_copy(update={"mission": hover.mission.model_copy(update={"duration": at + 9.0})}))
    sim.step(steps=round(at / sim.dt))
    rows = []
    for k in range(6000):
        t = k * sim.dt
        push = [0.3 + amplitude * math.sin(frequency * (t + 0.5 * sim.dt)), 0.3, 0.3]
        state = sim.step(push, point=GRIP)
        if k > 3500:
            rows.append((t + sim.dt, state[3] + state[11] * GRIP[2]))
    time, velocity = np.array(rows).T
    turns = frequency * time
    shapes = np.column_stack([np.sin(turns), np.cos(turns), np.ones_like(time), time, time**2])
    sine, cosine = np.linalg.lstsq(shapes, velocity, rcond=None)[0][:2]
    return (sine + 1j * cosine) / amplitude


@pytest.mark.parametrize("frequency", [6.0, 13.0, 28.0])
def test_the_admittance_at_the_hand_is_that_of_a_simulated_push(frequency):
    f = felt()
    Y = np.interp(frequency, f.w, f.Y[:, 0, 0].real) + 1j * np.interp(frequency, f.w, f.Y[:, 0, 0].imag)
    assert abs(Y - simulated(frequency)) < 0.03 * max(abs(Y), 0.05)


def test_a_slow_push_meets_the_virtual_damping():
    mission = load_mission("iris")
    for i in range(3):
        assert felt().Y[0, i, i].real == pytest.approx(1.0 / mission.admittance.damping[i], rel=0.02)


def test_a_pure_admittance_is_stable_with_every_arm_and_a_delayed_one_up_to_the_closed_form():
    s = 1j * W
    pure = one_axis(1.0 / (2.0 * s + 3.0))
    assert stiffness_limit(pure, 1.0) == math.inf
    assert is_coupled_stable(pure, ArmImpedance(500.0, 2.0, 3.0).impedance(W))
    # M s² + C s + k e^{−sT} = 0 at s = jω:  tan ωT = C/(M ω), k = ω √(C² + M² ω²)
    delay, low, high = 0.1, 1e-3, 10.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if math.tan(middle * delay) < 3.0 / (2.0 * middle) else (low, middle)
    limit = low * math.hypot(3.0, 2.0 * low)
    late = one_axis(np.exp(-s * delay) / (2.0 * s + 3.0))
    assert stiffness_limit(late, 0.0) == pytest.approx(limit, rel=0.01)


@pytest.mark.parametrize(("gain", "passive"), [(1.2, True), (1.3, False)])
def test_an_admittance_lighter_than_its_robot_is_passive_up_to_keeminks_limit_of_the_gain(gain, passive):
    """Keemink et al., 2018: a velocity loop of gain K_p makes m_r = 10 kg, b_r = 5 N s/m feel as m_v = 2 kg.

    It is passive up to K_p = b_r m_v/(m_r - m_v) = 1.25; beyond, no spring is stable in its hand (Routh).
    """
    w = np.geomspace(0.01, 300.0, 20_000)
    robot, virtual, s = 10.0 * 1j * w + 5.0, 2.0 * 1j * w, 1j * w
    Y = (gain / virtual + 1.0) / (robot + gain)
    claims = passivity(FeltAdmittance(w, Y[:, None, None] * np.eye(3)))
    assert [claim.value == math.inf for claim in claims] == [passive] * 3
    for stiffness in (1.0, 30.0, 1000.0):
        assert is_coupled_stable(FeltAdmittance(w, Y[:, None, None]), stiffness / s) is passive


@pytest.mark.thorough
def test_flights_in_the_hand_of_an_arm_begin_to_oscillate_at_the_predicted_stiffness():
    mission = load_mission("iris")
    predicted = stiffness_limit(felt(), mission.person.damping)
    flown = flown_limit(trial_of(mission, "arm stiffness"), predicted)
    assert flown.ended == "oscillation"
    assert predicted == pytest.approx(flown.above, rel=0.1)
    assert predicted < 1.02 * flown.above


def test_the_admittance_at_the_hand_turns_with_the_heading():
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    turned, expected = felt_admittance(load_mission("iris", {"initial.euler": [0.0, 0.0, math.pi / 2.0]})), felt().Y
    assert np.abs(turned.Y - turn @ expected @ turn.T).max() < 0.05 * np.abs(expected).max()  # pushed from another side


def test_an_arm_below_its_limit_holds_a_vehicle_calmly_at_any_heading():
    mission = load_mission("iris", {"initial.euler": [0.0, 0.0, 2.0], "person.grip": 0.8})
    trial = trial_of(mission, "arm stiffness")
    flight = tl.fly(trial.mission(10.0))
    assert not trial.ended(flight)
    assert np.abs(flight["push_force"]).max() < 0.05


@pytest.mark.thorough
def test_models_of_other_masses_and_dampings_follow_from_three():
    mission = load_mission("iris")
    family, own = admittance_family(mission), (2.0, 3.0)
    keys = {"admittance.mass": [own[0]] * 3, "admittance.damping": [own[1]] * 3}
    other = felt_admittance(mission, keys)
    assert family_limit(family, *own, 1.0) == pytest.approx(stiffness_limit(other, 1.0), rel=0.03)


def test_a_person_who_leads_without_delay_feels_like_their_gain_at_low_frequency():
    mission = load_mission("zigzag")
    Z = leading_impedance(mission.person, np.array([1e-3]), mission.person.delay)
    assert Z[0].real == pytest.approx(mission.person.gain, rel=0.01)


@pytest.mark.parametrize(("region", "speed"), [("chest", 0.99), ("hand", 1.43), ("skull", 0.24), ("face", 0.17)])
def test_tolerated_speeds_of_three_and_a_half_kilograms(region, speed):
    assert tolerated_speed(REGIONS[region], 3.5) == pytest.approx(speed, abs=0.005)


@pytest.mark.thorough
def test_the_tier_names_the_arm_of_the_mission_as_its_bar():
    mission = load_mission("iris")
    claims = {c.quantity: c for c in person_tier(mission, ArmBox()).claims}
    assert claims["arm stiffness limit"].bar == mission.person.stiffness
    assert claims["energy of a contact"].value == pytest.approx(0.5 * 3.5 * max(mission.compliance.max_speed) ** 2)


def test_an_empty_box_of_arms_is_refused():
    with pytest.raises(tl.InputError, match="arm damping = 0: must be above 0"):
        ArmBox(100.0, 0.0, 0.6).checked()
