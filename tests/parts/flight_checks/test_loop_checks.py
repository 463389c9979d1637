"""The closed forms of the control loops: against linear models of flights, and against loops that are known."""

import warnings

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.linearization.loop_margins import is_stable, largest, open_loop, single_loop
from tandemlift.missions import load_mission, tables_of
from tandemlift.parts.flight_checks.controller_checks import stiffness_of
from tandemlift.parts.flight_checks.loop_checks import (
    PushFeedback,
    delay_to_crossing,
    eigenvalues_by_axis,
    excess_turns,
    loop_delays,
)


@pytest.mark.parametrize("controller", ["nftsmc", "geometric", "super-twisting"])
def test_the_closed_forms_of_a_load_agree_with_the_linear_model(controller):
    mission = load_mission("iris", controller=controller)
    lag, loop = mission.hover.lag, open_loop(mission)
    max_delay = {found.axis: found.bears for found in loop_delays(mission.control_loop)}
    cut = loop.L / (1.0 + 1j * loop.w * lag)[:, None, None]
    for i, axis in enumerate(("z", "roll", "pitch", "yaw")):
        delay, _ = delay_to_crossing(loop.w, single_loop(cut, i))
        assert max_delay[axis] == pytest.approx(delay + 0.0015, rel=0.08), axis  # beside the step and the readings


@pytest.mark.thorough
@pytest.mark.parametrize("case", range(4))
def test_the_closed_forms_agree_with_the_linear_model_wherever_the_quadrotors_are(case):
    """Off the axes, with another inertia than the pilot believes: products of inertia mix roll, pitch and yaw."""
    rng = np.random.default_rng(case)
    fleet = tables_of(load_mission("iris"))["vehicle"]["quadrotors"]
    for q in fleet:
        q["position"] = [float(x) for x in np.array(q["position"]) + rng.normal(0.0, [0.25, 0.2, 0.05])]
    changes = {"vehicle.quadrotors": fleet, "plant.inertia_scale": [float(x) for x in rng.uniform(0.8, 1.25, 3)]}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", tl.FlightWarning)
        mission = load_mission("iris", changes, controller=("nftsmc", "pid", "geometric", "smc")[case])
    lag, loop = mission.hover.lag, open_loop(mission)
    max_delay = min(found.bears for found in loop_delays(mission.control_loop))
    assert max_delay == pytest.approx(largest(lambda delay: is_stable(loop, delay, lag)) + 0.0015, rel=0.06)


@pytest.mark.parametrize("mirrored", [1.0, -1.0])
def test_a_quadrotor_off_the_axis_does_not_make_a_loop_oscillate(mirrored):
    with warnings.catch_warnings():
        warnings.simplefilter("error", tl.FlightWarning)
        mission = load_mission("iris", {"vehicle.quadrotors.0.position": [0.03 * mirrored, 1.0, 0.075]})
    for found, centred in zip(
        loop_delays(mission.control_loop), loop_delays(load_mission("iris").control_loop), strict=True
    ):
        assert found.bears == pytest.approx(centred.bears, rel=1e-3), found.axis


@pytest.mark.parametrize(("k", "stable"), [(1.0, True), (-1.0, False)])
def test_the_turns_of_a_loop_say_whether_it_is_stable_without_delay(k, stable):
    """An integrator with positive and negative gain; a double one with and without lead."""
    w = np.geomspace(0.02, 300.0, 120)
    assert (abs(excess_turns(w, k / (1j * w))) < 1.0) == stable
    lead = 1.0 + 1j * w if stable else 1.0 - 0.5j * w
    assert (abs(excess_turns(w, lead / (1j * w) ** 2)) < 1.0) == stable


def test_loops_that_mix_are_told_apart_by_their_eigenvalues():
    """L = T diag(l) T⁻¹ has the loops l, in the order of the axes that T hardly mixes; two of them cross."""
    w = np.geomspace(0.02, 300.0, 400)
    loops = np.array([5.0 / (1j * w), 3.0 / (1j * w) ** 2, 9.0 / (1j * w * (1.0 + 0.02j * w)), 1.0 / (1j * w)])
    T = np.eye(4) + 0.2 * np.array([[0, 0, 0, 0], [0, 0, 1, -1], [0, -1, 0, 1], [0, 1, 0.5, 0]])
    mixed = np.einsum("ij,jw,jk->wik", T, loops, np.linalg.inv(T))
    assert eigenvalues_by_axis(mixed) == pytest.approx(loops, rel=1e-9)


def test_a_lead_time_of_the_low_passs_own_takes_half_of_the_low_pass_away():
    s, bandwidth = 1j * np.geomspace(0.1, 100.0, 20), 12.0
    push = PushFeedback(0.0, 0.0, 0.0, bandwidth, 0.0, 0.3)
    assert push.compensated(s, 1.0 / bandwidth) == pytest.approx(1.0 / (1.0 + s / bandwidth))
    assert push.compensated(s, 0.0) == pytest.approx(1.0 / (1.0 + s / bandwidth) ** 2)


def test_a_horizontal_offset_is_held_by_the_weight_at_the_angle_that_balances_it():
    """A gain of an angle [1/s²] over that of its error, 40 to 8 for each metre: 0.2 rad/m of a weight of 30 N."""
    asked = np.zeros((4, 5, 3))
    asked[0, 0, 2] = 50.0
    asked[2, 0, 0], asked[2, 2, 1] = 8.0, 40.0
    asked[1, 0, 1], asked[1, 2, 0] = -6.0, 20.0
    assert stiffness_of(30.0, asked) == pytest.approx([6.0, 9.0, 50.0])
