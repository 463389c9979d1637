"""The point that is taken by default, and what of a noisy flight is averaged there."""

from __future__ import annotations

import numpy as np
import pytest
from linearized import QUIET

import tandemlift as tl
from tandemlift.missions import load_mission

QUIETLY = {"pushes": [], "mission.duration": 14.0, "phases.land_start": 60.0}
SEEDS = range(6)
PUSH = 0.1  # N, below the threshold


@pytest.mark.thorough
def test_a_push_is_heard_at_the_default_point_and_the_model_says_so():
    model = tl.linearize(load_mission("iris"))
    assert model.time == pytest.approx(12.5)
    assert "Tare: over, pushes are used." in model.assumptions
    inside = tl.linearize(load_mission("iris"), 10.0)
    assert "Tare: not over for 2 s, pushes are ignored." in inside.assumptions
    assert any("pushes are used once the tare is over, in 2 s" in kink.text for kink in inside.kinks)


@pytest.mark.thorough
def test_a_tare_in_hover_is_waited_for():
    model = tl.linearize(load_mission("iris", {"estimator.tare": "hover", "supervision.model": "on"}))
    assert "Tare: over, pushes are used." in model.assumptions


def test_without_a_tare_the_point_is_where_it_was():
    model = tl.linearize(load_mission("paper"))
    assert model.time == 9.5
    assert not any("Tare" in said or "lag" in said for said in model.assumptions)


def test_noise_does_not_pick_the_lag_of_a_rotor():
    """Of two instants in the same hover the rotors' decay is the same, and that of the mean lag, 18.75 ms."""
    for at in (12.5, 12.53):
        model = tl.linearize(load_mission("iris", QUIETLY), at, steps=1)
        rotors = [i for i, v in enumerate(model.states) if v.name.startswith("rotors.speed")]
        assert np.diag(model.A)[rotors] == pytest.approx(np.exp(-0.001 / 0.01875), rel=1e-9)
    assert any("mean of up and down, 12.5 and 25 ms" in said for said in model.assumptions)
    assert any(kink.law == "by_direction" and "12.5 and 25 ms" in kink.text for kink in model.kinks)


def test_a_flight_without_noise_keeps_the_lag_that_it_has():
    model = tl.linearize(load_mission("iris", QUIETLY | QUIET), 12.5, steps=1)
    rotors = [i for i, v in enumerate(model.states) if v.name.startswith("rotors.speed")]
    decays = np.exp(-0.001 / np.array([0.0125, 0.025]))
    assert all(np.abs(decays - x).min() < 1e-9 for x in np.diag(model.A)[rotors])
    assert not any(kink.law == "by_direction" and "noise" in kink.text for kink in model.kinks)


@pytest.mark.thorough
@pytest.mark.parametrize("axis", [0, 1])
def test_the_model_of_a_noisy_flight_answers_a_push_as_flights_do(axis):
    """The difference of flights with and without a push, the same noise in both, in the mean over seeds."""
    force = PUSH * np.eye(3)[axis]
    flown, modelled = [], []
    for seed in SEEDS:
        mission = load_mission("iris", {**QUIETLY, "mission.seed": seed})
        found = []
        for push in (force, np.zeros(3)):
            simulation = tl.Simulation(mission)
            while simulation.time < 12.5 - 1e-9:
                simulation.step()
            if not found:
                model = tl.linearize(simulation, inputs=["push_force"], outputs=["position"], kink_tolerance=-1.0)
                assert model.point.x0[:13] == pytest.approx(simulation.state, rel=1e-12)
            found.append(np.array([simulation.step(push=push)[axis] for _ in range(400)])[4::5])
        flown.append(found[0] - found[1])
        x, way = np.zeros(len(model.states)), []
        for _ in range(80):
            x = model.A @ x + model.B @ force
            way.append(x[axis])
        modelled.append(way)
    mean = np.mean(flown, axis=0)
    assert np.mean(modelled, axis=0) == pytest.approx(mean, abs=0.12 * np.abs(mean).max())
