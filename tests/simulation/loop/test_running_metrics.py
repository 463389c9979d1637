"""Running metrics of random steps, against NumPy on all of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tandemlift.core.vector import Absent, Vec3, vec3
from tandemlift.simulation.loop.running_metrics import (
    EMPTY,
    NO_EFFORT,
    StepContribution,
    added,
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
