"""Running metrics of random steps, against NumPy on all of them."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tandemlift.core.vector import Absent, Vec3, each, vec3
from tandemlift.parts.guidance.estimate_errors import NO_ERRORS, PushErrors, error_metrics, with_errors
from tandemlift.parts.guidance.guidance import ThrustFraction
from tandemlift.parts.rotors.rotors import Rotors
from tandemlift.simulation.loop.running_metrics import (
    EMPTY,
    NO_EFFORT,
    StepContribution,
    added,
    at_limit,
    contribution_of,
    count,
    effort_of,
    summary,
)

VECTORS = ("position", "velocity", "attitude", "tilt", "moment", "push")
NUMBERS = ("thrust", "power", "height")
STEP = 0.01  # s


def steps(seed, number):
    """Random contributions by name, each a row a step; pushes are active at random."""
    rng = np.random.default_rng(seed)
    made = {name: rng.normal(size=(number, 3)) for name in VECTORS} | {n: rng.normal(size=number) for n in NUMBERS}
    return made | {"saturated": rng.integers(0, 2, number) * 1.0, "push_active": rng.integers(0, 2, number) * 1.0}


def counted(rows, part=slice(None)):
    memory = EMPTY
    for k in range(len(rows["power"]))[part]:
        numbers = {name: vec3(row[k]) if name in VECTORS else float(row[k]) for name, row in rows.items()}
        memory = count(memory, StepContribution(**numbers, clearance=Absent(), effort=Absent()))
    return memory


@given(st.integers(0, 2**32), st.integers(1, 40))
def test_sums_and_extremes_are_those_of_all_steps(seed, number):
    x = steps(seed, number)
    c = counted(x)
    assert c.steps == number
    for name in ("position", "attitude"):
        assert getattr(c, f"{name}_squares") == pytest.approx((x[name] ** 2).sum(axis=0))
    for name in ("position", "velocity", "tilt", "moment"):
        assert getattr(c, f"{name}_max") == pytest.approx(np.abs(x[name]).max(axis=0))
    assert (c.thrust_min, c.thrust_max, c.highest) == (x["thrust"].min(), x["thrust"].max(), x["height"].max())
    assert c.push_sum == pytest.approx(x["push"].sum(axis=0))
    assert (c.power_sum, c.saturated) == pytest.approx((x["power"].sum(), x["saturated"].sum()))


@given(st.lists(st.booleans(), max_size=40))
def test_a_push_counts_once_however_long_it_stays_active(active):
    x = steps(0, len(active)) | {"push_active": np.array(active, float)}
    assert counted(x).triggers == np.count_nonzero(np.diff([0, *map(int, active)]) == 1)


@given(st.integers(0, 2**32), st.integers(2, 40), st.data())
def test_metrics_are_those_of_both_parts_of_a_flight(seed, number, data):
    x, at = steps(seed, number), data.draw(st.integers(1, number - 1))
    found = summary(counted(x, slice(at)), counted(x, slice(at, None)), STEP)
    late = {name: row[at:] for name, row in x.items()}
    wanted = {
        "position_rmse_m": np.sqrt((x["position"] ** 2).mean(axis=0)),
        "position_rmse_after_10s_m": np.sqrt((late["position"] ** 2).mean(axis=0)),
        "position_max_error_m": np.abs(x["position"]).max(axis=0),
        "position_max_error_after_10s_m": np.abs(late["position"]).max(axis=0),
        "attitude_rmse_rad": np.sqrt((x["attitude"] ** 2).mean(axis=0)),
        "velocity_max_error_after_10s_m_s": np.abs(late["velocity"]).max(axis=0),
        "max_tilt_after_10s_rad": np.abs(late["tilt"]).max(axis=0),
        "thrust_min_after_10s_n": late["thrust"].min(),
        "thrust_max_after_10s_n": late["thrust"].max(),
        "moment_max_abs_after_10s_n_m": np.abs(late["moment"]).max(axis=0),
        "human_impulse_n_s": x["push"].sum(axis=0) * STEP,
        "human_work_j": x["power"].sum() * STEP,
        "push_triggers_after_10s": np.count_nonzero(np.diff([0.0, *late["push_active"]]) == 1.0),
        "rotor_saturated_share": x["saturated"].mean(),
    }
    assert found.keys() == wanted.keys()
    for name, value in wanted.items():
        assert found[name] == pytest.approx(value.tolist() if np.ndim(value) else value), name


def test_effort_counts_only_while_the_grip_is_held():
    effort = NO_EFFORT
    for k in range(10):
        effort = added(effort, effort_of(float(k < 4), Vec3(0.0, 3.0, 4.0), Vec3(0.6, 0.0, -0.8)))
    assert effort == pytest.approx((4.0, 20.0, 4.0))


ROTORS = Rotors(**{**dict.fromkeys(Rotors._fields), "max_thrust": each(2)(5.0, 5.0)})
RNG = np.random.default_rng(0)
NAMES = (
    "position", "velocity", "euler", "rates", "moment", "push_force", "push_moment",
    "reference_position", "reference_velocity", "reference_euler",
)  # fmt: skip
ROWS = {name: RNG.uniform(-1.0, 1.0, 3) for name in NAMES}
SAMPLE = SimpleNamespace(thrust=20.0, **{name: vec3(row) for name, row in ROWS.items()})


def errors(running=1.0):
    decision = SimpleNamespace(
        thrusts=each(2)(1.0, 0.0), guidance=SimpleNamespace(running=ThrustFraction(running), channels=Absent())
    )
    plant = SimpleNamespace(walls=Absent(), frame=None)
    state = SimpleNamespace(near=Absent(), state=None, person=Absent(), metrics=EMPTY)
    model = SimpleNamespace(rotors=ROTORS, plant=plant, flight_state=state)
    return contribution_of(model, SimpleNamespace(decision=decision, estimates=Absent()), SAMPLE, Absent())


def test_errors_are_the_reference_less_what_is_and_power_is_force_times_speed():
    found, x = errors(), ROWS
    assert found.position == pytest.approx(x["reference_position"] - x["position"])
    assert found.velocity == pytest.approx(x["reference_velocity"] - x["velocity"])
    assert found.attitude == pytest.approx(x["reference_euler"] - x["euler"])
    assert found.power == pytest.approx(x["push_force"] @ x["velocity"] + x["push_moment"] @ x["rates"])
    assert (found.thrust, found.height) == (20.0, x["position"][2])
    assert (found.tilt, found.moment, found.push) == (SAMPLE.euler, SAMPLE.moment, SAMPLE.push_force)


def test_rotors_that_stand_still_are_not_saturated():
    assert (errors(1.0).saturated, errors(0.0).saturated) == (1.0, 0.0)
    assert [at_limit(f, 5.0) for f in (-1.0, 0.0, 1e-9, 4.9, 5.0, 6.0)] == [1.0, 1.0, 0.0, 0.0, 1.0, 1.0]


def test_errors_of_an_estimate_give_its_delay_and_its_noise():
    """A late estimate of a smooth push, with an offset of the moment: least squares find the delay."""
    step, delay, t = 1e-3, 0.02, 1e-3 * np.arange(4000)
    true, found = (3.0 * np.exp(-(((t - late) - 2.0) ** 2) / 0.72) for late in (0.0, delay))
    sums = NO_ERRORS
    for k in range(len(t)):
        off = Vec3(found[k] - true[k], 0.0, 0.0)
        sums = with_errors(sums, PushErrors(1.0, off, Vec3(0.0, 0.1, 0.0), Vec3(true[k], 0.0, 0.0)))
    metrics = error_metrics(sums, Absent(), step)
    assert metrics["push_delay_s"] == pytest.approx(delay, rel=0.02)
    assert metrics["push_force_rmse_n"] == pytest.approx([np.sqrt(np.mean((found - true) ** 2)), 0.0, 0.0])
    assert metrics["push_moment_rmse_n_m"] == pytest.approx([0.0, 0.1, 0.0])
    assert error_metrics(Absent(), Absent(), step) == {}
