"""The limits of random missions: how engines look for them one by one, and the table."""

import importlib
from pathlib import Path

import certify_random_missions
import pytest
from certify_random_missions import flown_one_by_one, table
from random_missions.fleets import random_fleet

from tandemlift.analysis.certification.flown import LimitTrial

EVIDENCE = Path(certify_random_missions.__file__).parent
ROW = {"mission": "1", "base": "iris", "engine": "compiled", "bound": "largest", "ended": "oscillation"}


@pytest.mark.parametrize(("nominal", "limit"), [(1.0, 2.3), (1.0, 0.4)], ids=["growing", "falling"])
@pytest.mark.parametrize("error", [0.8, 1.0, 1.25])
def test_a_limit_is_found_from_predictions_on_either_side(monkeypatch, nominal, limit, error):
    monkeypatch.setattr(certify_random_missions.tl, "fly", lambda value, engine: value)
    monkeypatch.setattr(certify_random_missions, "frequency_of", lambda flight: 7.0)
    trial = LimitTrial(lambda x: x, lambda x: "oscillation" if (x >= limit) == (limit > 1.0) else "", nominal)
    found = flown_one_by_one(trial, error * limit, "mujoco")
    assert found.above == pytest.approx(limit, rel=0.025)
    assert (found.frequency, found.ended) == (7.0, "oscillation")


def test_a_vehicle_that_is_unstable_as_it_is_ends_the_search_at_its_nominal_value(monkeypatch):
    monkeypatch.setattr(certify_random_missions.tl, "fly", lambda value, engine: value)
    monkeypatch.setattr(certify_random_missions, "frequency_of", lambda flight: 7.0)
    found = flown_one_by_one(LimitTrial(lambda x: x, lambda x: "oscillation", 1.0), 1.2, "mujoco")
    assert found.below == 1.0


def test_the_table_counts_limits_of_either_side_by_how_early_flights_oscillate():
    rows = [
        {**ROW, "parameter": "mass", "bound": "least", "ratio": "1.25"},  # of the least mass: 0.8 of the way
        {**ROW, "parameter": "mass", "ratio": "1.05"},
        {**ROW, "parameter": "delay", "ratio": "0.7"},
        {**ROW, "mission": "2", "parameter": "", "ended": "unstable hover"},
    ]
    text = table(rows)
    assert "| compiled | mass | 2 | 50.0 % | 0.800, 0.925, 1.050 | 0 |" in text
    assert "| compiled | delay | 1 | 0.0 % | 0.700, 0.700, 0.700 | 1 |" in text
    assert "2 missions. Other ends: unstable hover 1." in text


def test_a_random_fleet_hovers_with_quadrotors_that_differ_in_mass_arm_lag_and_thrust():
    for number in range(3):
        mission = random_fleet(number, 52)
        fleet, hover = mission.vehicle.quadrotors, mission.hover
        assert len(fleet) == 2 + number
        for values in ([q.mass for q in fleet], [q.arm for q in fleet], hover.lags, hover.most.tolist()):
            assert len(set(values)) == len(fleet)
        assert (hover.thrusts > 0.0).all()
        assert hover.share < 0.65
        assert random_fleet(number, 52) == mission


def test_every_script_of_the_evidence_finds_what_it_imports():
    for script in sorted(EVIDENCE.glob("*.py")):
        module = importlib.import_module(script.stem)
        assert hasattr(module, "main") or "__main__" not in script.read_text("utf-8")
