"""Flights in single precision: close to those in double, alike in every lane, block and thread, refused elsewhere."""

import platform
import subprocess
import sys
from functools import cache

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.errors import InputError

SINGLE = {"mission.precision": "single"}
LOST = {"quadrotor": 1, "rotor": 1, "time": 7.0}
FALLS = {"mission.duration": 9.0, "faults": [{**LOST, "quadrotor": q, "rotor": r} for q in (1, 2) for r in (1, 2, 3)]}
CLOSE = {  # missions with changes, and how far apart the positions may be [m]
    "paper": ({}, 1e-5),
    "flight-ready": ({"mission.duration": 25.0}, 1e-3),
    "iris": ({"mission.duration": 24.0}, 1e-3),
    "rotor-loss": ({"mission.duration": 16.0}, 2e-2),
    "four": ({"mission.duration": 20.0}, 1e-3),
}


def same(one, other):
    return {k: v for k, v in one.items() if k != "wall_s"} == {k: v for k, v in other.items() if k != "wall_s"}


@cache
def flown(name):
    mission = tl.load_mission(name, CLOSE[name][0])
    return tl.fly(mission), tl.fly_many([mission], precision="single")[0]


@pytest.mark.parametrize("name", CLOSE)
def test_a_flight_ends_as_in_double_precision_with_the_same_findings(name):
    double, single = flown(name)
    assert single.outcome == double.outcome
    assert [f.kind for f in single.findings] == [f.kind for f in double.findings]
    assert single.mission["mission"]["precision"] == "single"


@pytest.mark.parametrize("name", CLOSE)
def test_a_flight_stays_close_to_that_in_double_precision(name):
    double, single = flown(name)
    assert np.abs(double["position"] - single["position"]).max() < CLOSE[name][1]
    errors = [np.linalg.norm(flight.results["position_rmse_m"]) for flight in (double, single)]
    assert errors[1] == pytest.approx(errors[0], rel=0.01)


def test_sums_over_all_steps_are_as_exact_as_a_float():
    double, single = flown("paper")
    for name in ("human_impulse_n_s", "human_work_j", "position_rmse_m"):
        assert single.results[name] == pytest.approx(double.results[name], rel=3e-6, abs=1e-6)


def test_a_flight_has_the_same_numbers_in_any_lane_block_and_thread():
    missions = [tl.load_mission("iris", {"mission.duration": 6.0, "mission.seed": seed}) for seed in range(19)]
    found = tl.fly_many(missions, "metrics", threads=2, precision="single")
    turned = tl.fly_many(missions[::-1], "metrics", threads=1, precision="single")[::-1]
    alone = [tl.fly_many([missions[i]], "metrics", precision="single")[0] for i in (0, 7, 18)]
    block = tl.Block(tl.load_mission("iris", {"mission.duration": 6.0}), 19, threads=1, precision="single")
    while not block.ended.all():
        block.step(steps=500)
    assert all(map(same, found, turned))
    assert all(same(found[i], one) for i, one in zip((0, 7, 18), alone, strict=True))
    for lane in (0, 11, 18):
        assert same({**found[lane], "command_at_start": None}, block.metrics(lane))


def test_parameters_that_differ_from_lane_to_lane_change_no_other_lane():
    changes = [{"plant.mass_scale": 1.0 + 0.01 * i, "mission.duration": 6.0} for i in range(5)]
    missions = [tl.load_mission("iris", one) for one in changes]
    together = tl.fly_many(missions, "metrics", precision="single")
    assert all(
        same(one, tl.fly_many([m], "metrics", precision="single")[0]) for one, m in zip(together, missions, strict=True)
    )


@pytest.mark.thorough
def test_a_flight_that_crashes_among_others_ends_at_its_own_step():
    missions = [tl.load_mission("iris", {**FALLS, "plant.mass_scale": scale}) for scale in (1.0, 1.1)]
    missions.append(tl.load_mission("iris", {"mission.duration": 9.0}))
    double, single = tl.fly_many(missions), tl.fly_many(missions, precision="single")
    assert [flight.outcome for flight in single] == [flight.outcome for flight in double]
    crashed = [(a, b) for a, b in zip(double, single, strict=True) if a.outcome == "crashed"]
    assert 0 < len(crashed) < 3
    for a, b in crashed:
        assert b.results["steps"] == pytest.approx(a.results["steps"], abs=20)
        assert len(b.time) == -(-b.results["steps"] // 10)
    for mission, flight in zip(missions, single, strict=True):
        (again,) = tl.fly_many([mission], precision="single")
        assert same(again.results, flight.results)
        assert np.array_equal(again["position"], flight["position"])


def test_flights_beside_one_that_crashes_in_the_last_step_have_their_last_sample():
    crash = tl.load_mission("iris", FALLS)
    (fallen,) = tl.fly_many([crash], precision="single")
    assert fallen.outcome == "crashed"
    length = {"mission.duration": fallen.results["steps"] * 0.001}
    missions = [tl.load_mission("iris", {**FALLS, **length, "plant.mass_scale": scale}) for scale in (1.0, 0.8)]
    lost, flying = tl.fly_many(missions, precision="single")
    (alone,) = tl.fly_many(missions[1:], precision="single")
    assert (lost.outcome, lost.results["steps"]) == ("crashed", fallen.results["steps"])
    assert flying.results["steps"] == alone.results["steps"]
    assert same(alone.results, flying.results)
    assert np.array_equal(alone["position"], flying["position"])


def test_a_block_reads_and_takes_floats():
    block = tl.Block("paper", 3, precision="single")
    block.step(np.full((3, 3), 0.5), steps=10)
    assert block["position"].dtype == block.actions.dtype == np.float32
    assert block.mission.mission.precision == "single"


RUN = """
import sys
from tandemlift.compiler.machine_code import machine
machine._ready()
machine.processor = lambda: (sys.argv[1], "")
import tandemlift as tl
mission = tl.load_mission("paper", {"mission.duration": 2.0, "mission.fma": sys.argv[2] == "fma"})
flight, = tl.fly_many([mission], precision="single")
print(flight["position"].tobytes().hex()[-4000:], flight["rotor_thrusts"].tobytes().hex()[-4000:])
"""


@pytest.mark.thorough
@pytest.mark.skipif(
    platform.machine().lower() not in ("x86_64", "amd64"), reason="its processors are of the x86 family"
)
def test_a_machine_without_wide_vectors_has_the_same_bits(tmp_path):
    def bits(processor, rounding):
        env = {"TANDEMLIFT_CACHE": str(tmp_path / processor / rounding), "TANDEMLIFT_OPTIMISE": "0", "PATH": ""}
        done = subprocess.run(
            [sys.executable, "-c", RUN, processor, rounding], env=env, capture_output=True, text=True, check=True
        )
        return done.stdout

    assert bits("x86-64-v3", "fma") == bits("skylake-avx512", "fma")
    assert bits("x86-64-v2", "twice") == bits("x86-64-v3", "twice")


def changed_in_flight():
    return {"changes": [{"time": 1.0, "key": "admittance.damping", "value": 3.0}]}


REFUSALS = {
    "a simulation stepped by hand": (lambda: tl.Simulation(tl.load_mission("paper", SINGLE)), "only fly, fly_many"),
    "a pilot alone": (lambda: tl.Pilot(tl.load_mission("paper", SINGLE)), "a pilot alone"),
    "another engine": (lambda: tl.fly(tl.load_mission("hover", SINGLE), "mujoco"), "the engine 'mujoco'"),
    "a certificate": (lambda: tl.certify(tl.load_mission("paper", SINGLE)), "a certificate"),
    "a linear model": (lambda: tl.linearize(tl.load_mission("paper", SINGLE)), "only fly, fly_many"),
    "changes in flight": (
        lambda: tl.fly(tl.load_mission("hover", {**SINGLE, **changed_in_flight()})),
        "changes in flight",
    ),
}


@pytest.mark.parametrize("name", REFUSALS)
def test_what_needs_doubles_refuses_single_precision_with_the_reason(name):
    call, reason = REFUSALS[name]
    with pytest.raises(InputError, match=rf"mission.precision = 'single': must be 'double' here, because {reason}"):
        call()


def test_a_refused_mission_among_others_does_not_stop_them():
    missions = [tl.load_mission("hover", {**changed_in_flight(), "mission.duration": 3.0}), tl.load_mission("paper")]
    refused, flown = tl.fly_many(missions, "metrics", precision="single", refusals=True)
    assert isinstance(refused, InputError)
    assert flown["outcome"] == "landed"


@pytest.mark.parametrize(
    "call", [lambda how: tl.fly_many(["paper"], precision=how), lambda how: tl.Block("paper", 1, precision=how)]
)
def test_there_are_two_precisions(call):
    with pytest.raises(InputError, match=r"precision = .half.: must be 'double' or 'single'"):
        call("half")


def test_a_key_of_one_lane_cannot_be_its_precision():
    block = tl.Block("paper", 2)
    with pytest.raises(InputError, match=r"mission\.precision = .single.: must be the same in all lanes"):
        block.reset(1, keys=SINGLE)
