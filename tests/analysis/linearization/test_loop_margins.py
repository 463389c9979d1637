"""Loops cut at the rotors: against python-control, and against closed forms."""

from __future__ import annotations

import warnings
from functools import cache

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.certification.mission_check import LOOP_CHECKS
from tandemlift.analysis.linearization.loop_margins import (
    axis_margins,
    margins_of,
    open_loop,
    rotors_response,
    single_loop,
)
from tandemlift.missions import load_mission, tables_of
from tandemlift.missions.flight_checks import CHECKS


@cache
def loop_of(name, controller=None):
    return open_loop(load_mission(name, controller=controller))


@pytest.mark.thorough
def test_margins_are_those_of_python_control():
    control = pytest.importorskip("control")
    loop = loop_of("iris")
    L = loop.L * rotors_response(loop.w, 0.01, 0.01875)[:, None, None]
    for i, found in enumerate(axis_margins(loop.w, L)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            loop_there = control.frd(single_loop(L, i), loop.w, smooth=True)
            gains, phases, _, _, crossovers, _ = control.stability_margins(loop_there, returnall=True)
        assert found.gain == pytest.approx(gains[gains > 1.0].min(), rel=0.02)
        assert found.least_gain == pytest.approx(gains[gains < 1.0].max(), rel=0.02)
        assert found.nearest_gain == pytest.approx(min(gains, key=lambda gain: abs(np.log(gain))), rel=0.02)
        least = np.abs(phases).argmin()
        assert found.phase == pytest.approx(phases[least], abs=0.5)
        assert found.crossover == pytest.approx(crossovers[least], rel=0.01)


@pytest.mark.parametrize("name", ["iris", "rotor-loss"])
def test_every_axis_has_the_usual_margins(name):
    """6 dB and 45 deg alone; 5.5 dB and 35 deg at once, as the disk margin α, the inverse of the peak of |S − T|/2."""
    mission, loop = load_mission(name), loop_of(name)
    L = loop.L * rotors_response(loop.w, mission.actuators.delay, mission.hover.lag)[:, None, None]
    for i, found in enumerate(axis_margins(loop.w, L)):
        assert found.gain > 2.0, found.axis
        assert found.least_gain < 0.5, found.axis
        assert found.phase > 45.0, found.axis
        own = single_loop(L, i)
        disk = 2.0 / np.abs((1.0 - own) / (1.0 + own)).max()
        assert 20.0 * np.log10((2.0 + disk) / (2.0 - disk)) > 5.5, found.axis
        assert np.degrees(2.0 * np.arctan(disk / 2.0)) > 35.0, found.axis


def test_margins_of_a_known_loop_are_its_closed_forms():
    """L = k e^(−sT)/s: 90° − k T of phase, and the gain may grow by π/(2 k T)."""
    w = np.geomspace(0.1, 300.0, 400)
    k, T = 4.0, 0.1
    found = margins_of("yaw", w, k * np.exp(-1j * w * T) / (1j * w))
    assert found.phase == pytest.approx(90.0 - np.degrees(k * T), abs=0.05)
    assert found.crossover == pytest.approx(k, rel=1e-3)
    assert found.gain == pytest.approx(np.pi / (2.0 * k * T), rel=2e-3)
    assert found.least_gain == 0.0


def test_a_loop_that_needs_its_gain_has_a_least_one():
    """L = k (s + 1)²/s³: its phase is −180° at ω = 1, where |L| = 2 k; stable from k = 1/2 on."""
    w = np.geomspace(0.01, 300.0, 800)
    s = 1j * w
    found = margins_of("roll", w, 2.0 * (s + 1.0) ** 2 / s**3)
    assert found.least_gain == pytest.approx(0.25, rel=2e-3)
    assert (found.gain, found.nearest_gain) == (np.inf, found.least_gain)


@pytest.mark.thorough
def test_both_limits_of_the_gain_are_told_and_which_is_near():
    rows = {r.subject: r for r in tl.check(load_mission("iris")) if r.check == "loop gain"}
    for axis, near in (("z", "most"), ("roll", "least"), ("pitch", "least"), ("yaw", "least")):
        far = {"most": "least", "least": "most"}[near]
        assert rows[f"{axis}, {near} (nearer)"].margin < rows[f"{axis}, {far}"].margin
    limits = [rows[f"{axis}, least (nearer)"].value for axis in ("roll", "pitch", "yaw")]
    assert limits == pytest.approx([0.346, 0.418, 0.122], rel=0.01)


def test_a_vehicle_that_calms_down_slowly_is_not_called_unstable():
    """A lighter vehicle swings after its lift, and rests 20 s later: its loops are those of the rest."""
    fleet = tables_of(load_mission("iris"))["vehicle"]["quadrotors"]
    for q, x, y in zip(fleet, (-0.228, -0.164), (0.916, -1.394), strict=True):
        q["position"][:2] = [x, y]
    changes = {"vehicle.quadrotors": fleet, "plant.inertia_scale": [1.344, 1.05, 1.35], "plant.mass_scale": 1.088}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tl.FlightWarning)
        assert open_loop(load_mission("iris", changes, controller="super-twisting")).stable


def test_offsets_of_thrusts_are_for_real_rotors_only():
    with pytest.raises(tl.InputError, match=r'thrust_offsets: actuators.model must be "rotors"'):
        tl.linearize(load_mission("hover"), inputs=["thrust_offsets"])


@pytest.mark.thorough
def test_all_checks_of_a_mission_are_in_the_tables_and_well():
    results = tl.check(load_mission("iris"))
    assert {r.check for r in results} <= {check.name for check in (*CHECKS, *LOOP_CHECKS)}
    assert [r for r in results if r.verdict == "fails"] == []
    assert {"loop delay", "loop lag", "loop phase", "loop gain", "loop mode"} <= {r.check for r in results}


def test_a_controller_in_plain_python_has_no_linear_model_and_says_so(monkeypatch):
    from tandemlift.parts.controllers import control
    from tandemlift.simulation.plan import FlightPlan

    mission = load_mission("hover")
    monkeypatch.setattr(control, "interpreted", {type(FlightPlan(mission).model.pilot.controller)})
    (result,) = [r for r in tl.check(mission) if r.check == "loop"]
    assert "plain Python" in result.text
