"""The structured tier: against missions linearized again, and against a flight."""

from __future__ import annotations

import math
import warnings
from functools import cache

import numpy as np
import pytest
from listings import LISTINGS

import tandemlift as tl
from tandemlift.analysis.certification.structured import Worst, growing, structured_tier, worst_mission
from tandemlift.analysis.certification.uncertain_loop import DeviatingLoop
from tandemlift.analysis.certification.uncertainty import (
    LIMIT,
    family_at,
    hovers_of,
    parameters_of,
    rational,
    uncertain_tables,
)
from tandemlift.analysis.linearization.loop_margins import ON_CIRCLE
from tandemlift.core.errors import InputError
from tandemlift.missions import check, load_mission, mission_from_text, tables_of

pytest.importorskip("scipy")
BOX = {"mass": 0.1, "inertia_y": 0.15, "thrust": 0.1, "lag": 0.3, "delay": 0.005}


@cache
def iris():
    return load_mission("iris")


@cache
def tier():
    return structured_tier(iris(), BOX)


@cache
def deviations():
    widths = parameters_of(iris().hover, BOX)
    hovers = hovers_of(iris(), widths)
    return DeviatingLoop(family_at(hovers, hovers.w), widths)


def claim(quantity, subject="box"):
    (found,) = [c for c in tier().claims if (c.quantity, c.subject) == (quantity, subject)]
    return found


def unstable(values):
    return growing(iris(), values)[0] > ON_CIRCLE


@pytest.mark.thorough
def test_no_corner_of_the_guaranteed_box_is_unstable_when_the_mission_is_linearized_there():
    rng, factor = np.random.default_rng(3), 0.98 * claim("guaranteed factor").value
    for _ in range(5):
        signs = {name: rng.choice((-1.0, 1.0)) for name in BOX} | {"lag": 1.0}
        values = {name: factor * sign * BOX[name] for name, sign in signs.items()}
        assert not unstable(values | {"delay": math.floor(factor * 5.0) * 1e-3})


@pytest.mark.thorough
def test_the_guarantee_ends_where_the_search_finds_oscillation():
    proven, found, flown = (claim(f"{which}") for which in ("guaranteed factor", "factor found", "factor to fly"))
    assert 1.0 < proven.value <= found.value <= flown.value
    assert proven.verdict == "met"
    assert claim("gap").value == pytest.approx(found.value / proven.value)
    assert claim("gap").value < 1.1
    w, bounds = tier().curves["frequency"], tier().curves["upper_bound"]
    assert w[np.argmax(bounds)] == pytest.approx(found.frequency, rel=0.1)


@pytest.mark.thorough
def test_the_worst_mission_flies_to_oscillation_at_the_predicted_frequency():
    (name,) = tier().files
    mission = mission_from_text(name, tier().files[name])
    assert mission.mission.name == "iris-worst"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tl.FlightWarning)
        flight, calm = tl.fly(mission), tl.fly(load_mission("iris", {"pushes": [], "phases.land_start": 60.0}))
    late = flight.time > mission.mission.duration - 10.0
    rates = flight["rates"][late] - flight["rates"][late].mean(axis=0)
    axis = rates.std(axis=0).argmax()
    assert rates[:, axis].std() > 20.0 * calm["rates"][(calm.time > 22.0) & (calm.time < 32.0)][:, axis].std()
    power = np.abs(np.fft.rfft(rates[:, axis] * np.hanning(len(rates)), 8 * len(rates)))
    flown = 2.0 * np.pi * np.fft.rfftfreq(8 * len(rates), flight.time[1] - flight.time[0])[power.argmax()]
    assert flown == pytest.approx(claim("factor to fly").frequency, rel=0.1)


def test_the_worst_of_a_mission_that_is_not_built_in_is_written_whole():
    mission = load_mission("iris", {"admittance.damping": [7.0, 7.0, 7.0]})
    values = {"delay": 0.004, "thrust": -0.2, "inertia_y": 0.3}
    text = worst_mission(mission, values, Worst(2.0, values, 12.3))
    assert "extends" not in text
    assert "12.3 rad/s" in text
    worst = mission_from_text("iris-worst.toml", text)
    assert worst.admittance == mission.admittance
    assert worst.plant.inertia_scale == (1.0, 1.3, 1.0)
    assert worst.plant.thrust_scale == pytest.approx(0.8)
    assert worst.faults == ()
    assert worst.actuators.delay == pytest.approx(0.014)


@pytest.mark.thorough
@pytest.mark.parametrize(
    "signs",
    [{"mass": -1.0}, {"mass": -1.0, "thrust": -1.0, "lag": 1.0, "delay": 1.0, "inertia_y": 1.0}, {"thrust": 1.0}],
)
def test_the_model_of_all_parameters_loses_stability_where_the_mission_linearized_there_does(signs):
    most = min((2.0 if sign > 0.0 else 0.9) / BOX[name] for name, sign in signs.items())
    values = deviations().along(signs, deviations().limit(signs, most))
    assert not unstable({name: 0.94 * p for name, p in values.items()})
    assert unstable({name: 1.06 * p for name, p in values.items()})


def test_the_strongest_rotor_sets_the_scale_weaker_ones_have_faults_and_the_rest_its_keys():
    tables = tables_of(iris())
    off = uncertain_tables(tables, {"thrust": -0.1, "rotor.3": -0.5, "mass": 0.2, "lag": 1.0, "delay": 0.003})
    (fault,) = check({**off, "pushes": []}).faults
    assert (fault.quadrotor, fault.rotor, fault.efficiency) == (1, 3, 0.5)
    assert off["plant"]["thrust_scale"] == pytest.approx(0.9)
    one = check({**uncertain_tables(tables, {"thrust": 0.1, "rotor.2": 0.25}), "pushes": []})
    assert one.plant.thrust_scale == pytest.approx(1.1 * 1.25)
    assert [fault.efficiency for fault in one.faults] == pytest.approx([0.8] * 7)
    assert off["plant"]["mass_scale"] == pytest.approx(1.2)
    assert off["vehicle"]["quadrotors"][1]["lag_down"] == pytest.approx(2.0 * iris().vehicle.quadrotors[1].lag_down)
    assert off["actuators"]["delay"] == pytest.approx(0.013)
    assert uncertain_tables(tables, {})["faults"] == []


def test_a_rational_function_is_met_between_and_beyond_its_two_values():
    rng = np.random.default_rng(2)
    U, W, V = (rng.normal(size=size) + 1j * rng.normal(size=size) for size in ((3, 7, 2), (3, 2, 9), (3, 2, 2)))

    def at(p):
        return U @ np.linalg.inv(np.eye(2) / p - V) @ W

    trim = rational(at(-0.1), at(0.2), -0.1, 0.2)
    assert trim.V.shape == (3, 2, 2)
    for p in (-0.3, 0.07, 0.5):
        assert trim.U @ np.linalg.inv(np.eye(2) / p - trim.V) @ trim.W == pytest.approx(at(p))


@pytest.mark.parametrize(
    ("box", "text"),
    [
        ({"mas": 0.1}, "mass"),
        ({"mass": 0.0}, r"mass = 0: its half width must be in \(0, 0.9\)"),
        ({"delay": 1.0}, r"delay = 1: its half width must be in \(0, 0.2\)"),
        (
            {**BOX, **{f"rotor.{i}": 0.1 for i in range(1, 9)}},
            rf"13 uncertain parameters: must be at most {LIMIT}.*min",
        ),
    ],
)
def test_a_box_that_cannot_be_is_refused(box, text):
    with pytest.raises(InputError, match=text):
        structured_tier(iris(), box)


def test_a_mission_without_a_stable_linear_hover_has_a_reason_and_no_claims():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tl.FlightWarning)
        late = structured_tier(load_mission("iris", {"actuators.delay": 0.08}), {"lag": 0.1})
        heavy = structured_tier(load_mission("iris", {"plant.center_of_mass_offset": [0.0, 0.75, 0.0]}), {"lag": 0.1})
    assert late.claims == ()
    assert "not stable" in late.reason
    assert late.assumptions
    assert heavy.claims == ()
    assert "saturates" in heavy.reason
    ideal = structured_tier(load_mission("paper"), {"lag": 0.1, "rotors": 0.1})
    assert "no parameter" in ideal.reason


def test_a_controller_in_plain_python_has_a_reason_and_no_claims():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tl.FlightWarning)
        plain = structured_tier(load_mission("iris", controller=str(LISTINGS / "my_pd_plain.py")), BOX)
    assert plain.claims == ()
    assert "plain Python" in plain.reason
