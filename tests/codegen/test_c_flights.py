"""Whole flights in C have the bits of native ones: every built-in mission, twenty draws each, diverging ones too."""

import ctypes
import subprocess

import numpy as np
import pytest
from c_flights import STRICT, CFlight, differences, same, unfused
from passing import thrown, upright

import tandemlift as tl
from tandemlift.codegen.c_package import code_texts, written
from tandemlift.core.types import leaves
from tandemlift.missions import built_in, changed
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation.traced_assembly import trace_assembly
from tools import need


def mission_of(name, **changes):
    return unfused(tl.load_mission(name, {key.replace("__", "."): value for key, value in changes.items()}))


@pytest.mark.thorough
def test_a_short_flight_in_c_has_the_bits_of_the_native_one(tmp_path):
    mission = mission_of("one-push")
    wrong, lost = differences(CFlight(mission, tmp_path), mission, range(5))
    assert not wrong
    assert lost > 0  # so a flight that diverges was compared too


@pytest.mark.thorough
def test_a_flight_that_strikes_a_wall_hard_has_the_bits_of_the_native_one_in_c(tmp_path):
    wall = upright((-1.0, 0.3), (1.0, 0.3), -0.2)
    mission = unfused(thrown({"initial.velocity": [0.3, 0.0, -8.0], "walls": [wall, upright((1, -3), (1, 3))]}, 0.1))
    assert np.abs(tl.fly(mission)["contact_force"]).max() > 1e4  # an impulse, beyond what springs give
    in_c = CFlight(mission, tmp_path, "gcc", "-O0", "-Wno-error=parentheses")
    wrong, _ = differences(in_c, mission, range(3))
    assert not wrong


class Preparation:
    """A mission's `flight_prepare` in C."""

    def __init__(self, mission, folder):
        files = written(code_texts(mission), folder)
        name = next(f.name for f in files if f.name.endswith("_flight.h")).removesuffix("_flight.h")
        library, sources = folder / "prepare.so", [folder / f"{name}_flight.c", folder / f"{name}_flight_prepare.c"]
        subprocess.run(["gcc", *STRICT, "-O0", "-shared", "-fPIC", *sources, "-o", library, "-lm"], check=True)
        self._prepare = getattr(ctypes.CDLL(str(library)), f"{name}_flight_prepare")
        self._size = leaves(FlightPlan(mission).model)

    def __call__(self, values):
        """(What it returns, the numbers of the flight)."""
        given, prepared = np.array(values), np.zeros(100_000)
        failed = self._prepare(ctypes.c_void_p(given.ctypes.data), ctypes.c_void_p(prepared.ctypes.data))
        return failed, prepared[: self._size]


@pytest.mark.thorough
def test_numbers_of_another_mission_are_prepared_in_c_as_by_assembly_where_it_would_not_branch_otherwise(tmp_path):
    mission, other = mission_of("one-push"), mission_of("one-push", vehicle__payload__mass=211.5)
    prepare = Preparation(mission, tmp_path)
    failed, found = prepare(trace_assembly(other).values)
    assert failed == 0
    assert same(found, FlightPlan(other).start().numbers)
    assert not same(found, FlightPlan(mission).start().numbers)
    traced = trace_assembly(mission)
    failed, _ = prepare(np.full(len(traced.values), np.nan))
    assert 1 <= failed <= len(traced.guards)


TABLES = """#include "{p}_flight_prepare.h"
#include <string.h>
int tables_differ(void);
int tables_differ(void)
{{
    static {p}_Prepared prepared;
    static {p}_FlightModel model;
    static {p}_Inputs inputs;
    {p}_flight_mission(&model, &inputs);
    return {p}_flight_prepare(&{p}_flight_numbers, &prepared)
        + (memcmp(prepared.inputs.walls, inputs.walls, (size_t)inputs.wall_count * sizeof *inputs.walls) != 0)
        + (memcmp(prepared.inputs.legs, inputs.legs, (size_t)inputs.leg_count * sizeof *inputs.legs) != 0)
        + (inputs.wall_count == 0) + (inputs.leg_count == 0);
}}
"""


@pytest.mark.thorough
def test_walls_and_legs_of_a_path_keep_their_constant_numbers_when_numbers_are_prepared(tmp_path):
    mission = mission_of("zigzag")
    files = written(code_texts(mission), tmp_path)
    name = next(f.name for f in files if f.name.endswith("_flight.h")).removesuffix("_flight.h")
    (tmp_path / "tables.c").write_text(TABLES.format(p=name))
    sources = [tmp_path / f"{name}_flight.c", tmp_path / f"{name}_flight_prepare.c", tmp_path / "tables.c"]
    subprocess.run(
        ["gcc", *STRICT, "-O0", "-shared", "-fPIC", *sources, "-o", tmp_path / "tables.so", "-lm"], check=True
    )
    assert ctypes.CDLL(str(tmp_path / "tables.so")).tables_differ() == 0


@pytest.mark.targets
@pytest.mark.parametrize("name", sorted(built_in()))
def test_every_mission_is_prepared_in_c_as_by_assembly(name, tmp_path):
    mission = mission_of(name)
    other = changed(mission, "vehicle.payload.mass", mission.vehicle.payload.mass * 1.01)
    failed, found = Preparation(mission, tmp_path)(trace_assembly(other).values)
    assert failed == 0
    assert same(found, FlightPlan(other).start().numbers)


@pytest.mark.targets
@pytest.mark.parametrize("name", sorted(built_in()))
def test_twenty_draws_of_every_mission_have_the_bits_of_native_flights(name, tmp_path):
    mission = mission_of(name)
    wrong, lost = differences(CFlight(mission, tmp_path), mission, range(20))
    assert not wrong
    assert lost > 0


@pytest.mark.targets
@pytest.mark.parametrize("name", ["paper", "iris", "zigzag", "rotor-loss"])
def test_clang_makes_the_same_bits(name, tmp_path):
    need("clang")
    mission = mission_of(name)
    wrong, _ = differences(CFlight(mission, tmp_path, "clang", "-O3"), mission, range(5))
    assert not wrong


@pytest.mark.targets
@pytest.mark.parametrize("controller", ["geometric", "lqr", "pid", "smc", "super-twisting"])
def test_every_controller_has_the_bits_of_native_flights(controller, tmp_path):
    mission = mission_of("one-push", controller__name=controller)
    wrong, _ = differences(CFlight(mission, tmp_path), mission, range(5))
    assert not wrong


@pytest.mark.targets
@pytest.mark.parametrize("wrench", ["momentum", "hybrid", "kalman", "extended-kalman", "unscented", "fused"])
def test_every_observer_has_the_bits_of_native_flights(wrench, tmp_path):
    mission = mission_of("iris", estimator__wrench=wrench, mission__duration=14.0)
    wrong, _ = differences(CFlight(mission, tmp_path), mission, range(2))
    assert not wrong
