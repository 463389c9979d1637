"""`tl.feel`: the closed form is SciPy's and what is flown, and checks name what the vehicle cannot do."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import tandemlift as tl
from tandemlift.analysis.studies.closed_form import AxisFeel, axes_of
from tandemlift.analysis.studies.feel import feel_checks
from tandemlift.parts.guidance.admittance import FEELS


@pytest.mark.parametrize("seed", range(2))
def test_the_keys_of_a_feel_come_out_of_the_flight_with_ideal_parts(seed):
    """Ideal rotors, no sensors, the push known: the admittance has its final speed, and 95 % of it in time."""
    rng = np.random.default_rng(seed)
    force, speed, time = rng.uniform(0.5, 4.0), rng.uniform(0.1, 1.2), rng.uniform(1.2, 4.0)
    feel = {"force": force, "speed": speed, "time": time}
    changes = {"admittance.gate": ("hard", "soft")[seed % 2], "admittance.feel": feel, "pushes": []}
    mission = tl.load_mission("one-push", changes)
    k = tl.feel(mission).axes[0]
    assert (k.push, k.final_speed, k.time) == (pytest.approx(force), pytest.approx(speed), pytest.approx(time))
    simulation = tl.Simulation(mission)
    for share in (0.95, 0.9975):
        simulation.step([force, 0.0, 0.0], steps=round(1000 * time))
        assert simulation.state[3] == pytest.approx(share * speed, rel=0.02)


def test_each_preset_passes_its_checks_in_iris():
    feels = {preset: tl.feel(tl.load_mission("iris", {"admittance.feel.preset": preset})) for preset in FEELS}
    assert [(preset, c.text) for preset, feel in feels.items() for c in feel.checks if c.verdict == "fails"] == []


def test_an_answer_that_the_rotors_cannot_give_fails_with_the_bound():
    feel = {"force": 1.0, "speed": [1.5, 0.4, 0.4], "time": [0.5, 2.0, 2.0]}
    report = tl.feel(tl.load_mission("iris", {"admittance.feel": feel}))
    failed = {(c.check, c.subject): c for c in report.checks if c.verdict == "fails"}
    rotors = failed["rotors", "x"]
    assert rotors.limit == pytest.approx(9.81 * np.tan(0.25), rel=1e-3)
    acceleration = np.log(20.0) * 1.5 / 0.5
    assert rotors.value == pytest.approx(acceleration - 1.0 / 3.5, rel=1e-3)
    bound = np.log(20.0) * 1.5 / (rotors.limit + 1.0 / 3.5)
    assert f"allow it at least {bound:.2g} s for 1.5 m/s" in rotors.text
    assert ("rotors", "y") not in failed


def results(name, changes):
    """The verdicts of a mission's checks by name and axis."""
    mission = tl.load_mission(name, changes)
    return {(c.check, c.subject): c for c in feel_checks(mission, axes_of(mission))}


@pytest.mark.parametrize(
    ("name", "changes", "check", "said"),
    [
        ("iris", {"admittance.feel": {"speed": 2.5, "time": 5.0}}, ("speed", "x"), "raise compliance.max_speed"),
        ("zigzag", {"admittance.feel": {"time": 0.8}}, ("acceleration", "x"), "at least 1 s for 0.5 m/s"),
        ("iris", {"admittance.threshold": 0.02}, ("noise", ""), "raise the threshold"),
        ("iris", {"admittance.threshold": 0.08}, ("drift", ""), "tare (estimator.tare_start)"),
        ("iris", {"compliance.yaw.threshold": 0.05}, ("drift", "yaw"), "turns while nobody pushes"),
        ("iris", {"controller.max_tilt": 0.03}, ("rotors", "x"), "thrust and tilt give 0.294 m/s²"),
        (
            "iris",
            {"vehicle.payload.mass": 2.2, "admittance.mass": 0.1},
            ("rotors", "z"),
            "the vehicle cannot respond so fast",
        ),
        ("iris", {"compliance.yaw.inertia": 0.3}, ("rotors", "yaw"), "leave out compliance.yaw.inertia"),
        ("zigzag", {"corridor.width": 2.2}, ("passage", ""), "touches it"),
        ("zigzag", {"admittance.feel": {"speed": 1.2, "time": 3.0}}, ("stop", ""), "lower speed or time"),
    ],
    ids=lambda x: "".join(x) if isinstance(x, tuple) else "",
)
def test_what_cannot_be_had_fails_and_says_what_to_do(name, changes, check, said):
    found = results(name, changes)[check]
    assert found.verdict == "fails"
    assert found.value > found.limit
    assert said in found.text


def drift(**changes):
    mission = tl.load_mission("iris", {key.replace("__", "."): value for key, value in changes.items()})
    return [result for result in feel_checks(mission, axes_of(mission)) if result.check == "drift"]


def test_drift_counts_where_joints_are_measured_and_for_as_long_as_the_bias_is_not_learned():
    assert drift()
    assert drift(pilot__push="truth") == []
    long, longer, short = (
        drift(mission__duration=t, sensors__joints__force_drift=0.01)[0] for t in (900.0, 1800.0, 25.0)
    )
    assert long.value == longer.value > short.value


def test_without_a_tare_the_bias_of_the_joints_counts():
    tared, free = (
        results("iris", {"estimator.tare_start": start, "estimator.identify_mass": False}) for start in (9.0, None)
    )
    assert free["drift", ""].value > tared["drift", ""].value + 2.0 * 0.3
    assert "bias, as there is no tare" in free["drift", ""].text


def test_the_rotors_are_relieved_by_the_push_and_hold_against_it_at_the_end():
    light = results("iris", {"admittance.mass": 1.0})["rotors", "x"]
    assert light.value == pytest.approx(0.7 / 1.0 - 1.0 / 3.5)
    as_heavy = results("iris", {"admittance.mass": 3.5})["rotors", "x"]
    assert as_heavy.value == pytest.approx(1.0 / 3.5)
    assert as_heavy.limit == pytest.approx(9.81 * math.tan(0.25), rel=1e-3)


def test_built_in_missions_pass_their_checks_and_ideal_parts_have_neither_limits_nor_noise():
    checks = (check for name in ("zigzag", "gusts") for check in results(name, {}).values())
    assert [c.text for c in checks if c.verdict == "fails" and c.check != "wind on the payload"] == []
    assert results("one-push", {}) == {}


SIZE = st.floats(0.1, 10.0)


def speed_of(k, hold):
    """Time [s] and speed [m/s] under the push for `hold` seconds and after it, by SciPy."""

    def rates(force):
        return lambda t, s: [s[1], (force - k.damping * s[1] - k.stiffness * s[0]) / k.mass]

    tolerance = {"rtol": 1e-9, "atol": 1e-11, "t_eval": np.linspace(0.0, hold, 20_001)}
    pushed = solve_ivp(rates(k.beyond), (0.0, hold), [0.0, 0.0], **tolerance)
    free = solve_ivp(rates(0.0), (0.0, hold), pushed.y[:, -1], **tolerance)
    return pushed.t, pushed.y[1], free.y


@given(SIZE, SIZE, SIZE, st.booleans())
@settings(max_examples=10)
def test_the_numbers_are_those_of_the_curve(mass, damping, push, subtracts_threshold):
    k = AxisFeel("y", mass, damping, 0.0, 0.05, subtracts_threshold, push)
    time, speed, after = speed_of(k, 30.0 * k.time_constant)
    assert np.interp(k.time, time, speed) == pytest.approx(0.95 * k.final_speed, rel=1e-3)
    assert speed[-1] == pytest.approx(k.final_speed)
    assert after[0, -1] - after[0, 0] == pytest.approx(k.stop_distance, rel=1e-3)
    assert speed[1] / time[1] == pytest.approx(k.acceleration, rel=1e-2)


@pytest.mark.parametrize(("damping", "stiffness"), [(0.5, 4.0), (9.0, 4.0), (40.0, 4.0)])
def test_with_a_spring_the_time_is_that_in_which_the_motion_decays_to_5_percent(damping, stiffness):
    """The largest deviation over half a period, at one time and `k.time` later."""
    k = AxisFeel("x", 1.0, damping, stiffness, 0.3, True, 1.5)
    time, speed, _ = speed_of(k, 3.0 * k.time)
    early, late = (np.abs(speed[(time >= t) & (time < t + 1.6)]).max() for t in (k.time, 2.0 * k.time))
    assert late == pytest.approx(0.05 * early, rel=0.25)


def test_without_damping_there_is_no_final_speed_and_with_a_spring_it_is_zero():
    free = AxisFeel("x", 1.0, 0.0, 0.0, 0.3, False, 1.0)
    assert (free.final_speed, free.time, free.time_constant) == (math.inf,) * 3
    assert AxisFeel("x", 1.0, 2.0, 5.0, 0.3, False, 1.0).final_speed == 0.0


def test_the_standard_push_is_the_feel_s_force_or_one_newton_and_beyond_the_threshold():
    firm = axes_of(tl.load_mission("iris", {"admittance.feel.preset": "firm"}))
    assert [k.push for k in firm] == [2.0, 2.0, 2.0, 0.5]
    assert [k.axis for k in firm] == ["x", "y", "z", "yaw"]
    assert firm[0].final_speed == pytest.approx(0.6)
    assert firm[3].final_speed == pytest.approx((0.5 - 0.15) / 1.6)
    strict = axes_of(tl.load_mission("one-push", {"admittance.threshold": [0.3, 0.8, 3.0]}))
    assert [k.push for k in strict] == [1.0, 1.6, 6.0]
    assert not any(k.subtracts_threshold for k in strict)
