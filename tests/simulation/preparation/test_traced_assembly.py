"""A mission's numbers as a graph: against the plain assembly by NumPy and libm, and against itself at other numbers."""

from __future__ import annotations

import functools
import math
import re
import warnings

import numpy as np
import pytest
from mission_graphs import assembled_numbers, machine_code, values_of, varied
from odd_numbers import bits

import tandemlift as tl
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.compiler.tracer.valued_graph import evaluated
from tandemlift.core.types import flat, layout_and_numbers
from tandemlift.core.vector import layout
from tandemlift.simulation.pilot_api import pilot_at_start
from tandemlift.simulation.preparation.assemble import assemble
from tandemlift.simulation.preparation.traced_assembly import (
    counts_of_mission,
    numbers_of_mission,
    trace_assembly,
    with_numbers,
    with_values,
)

MISSIONS = [
    *("hover", "four", "iris", "zigzag", "doorway", "two-x500", "crazyflie-stick"),
    *("zigzag, interactive", "rotor-loss, interactive", "iris, other parts"),
]
ROUNDED = (
    r"(sensors|actuators|person)\.(joints\.|motion\.|additional\.\d+\.)?(delay|interval|first_sample)|"
    r"sensor_faults\.\d+\.(time|until)"
)
PLANNED = r"mission\.(duration|step|log_interval)|vehicle\.quadrotors\.\d+\.heading"

OTHER_PARTS = {  # what no built-in mission has: other devices and faults, turbulence, a full tensor of inertia
    "wind": {"model": "air", "velocity": [2.0, 1.0, 0.0], "turbulence": 7.7},
    "wind.gusts": [{"velocity": [2.0, 0.0, 0.0], "start": 3.0, "rise": 1.0, "hold": 2.0}],
    "sensors.additional": [
        {"name": "altimeter", "bias": 0.1, "noise": 0.1, "delay": 0.02, "resolution": 0.01},
        {"name": "magnetometer", "bias": 0.05, "drift": 0.01},
    ],
    "sensor_faults": [
        {"sensor": "gyroscope", "kind": "bias", "time": 4.0, "size": [0.1, 0.0, 0.0]},
        {"sensor": "imu", "kind": "stale", "time": 6.0, "until": 6.5},
    ],
    "supervision.model": "on",
    "detection.model": "residual",
    "ground.effect": True,
    "observer.model": "extended-state",
    "compliance.tank.model": "tank",
    "compliance.yaw.model": "compliant",
    "requests": [{"time": 3.0, "action": "lift"}, {"time": 20.0, "action": "land"}],
    "faults": [{"quadrotor": 1, "rotor": 2, "time": 9.0, "efficiency": 0.5, "known_after": 0.1}],
    "vehicle.quadrotors.0.position": [0.05, 1.0, 0.075],
    "vehicle.quadrotors.0.lag_up": 0.0,
    "plant.inertia_scale": [1.1, 0.9, 1.0],
}


@functools.cache
def mission_of(name):
    first, _, kind = name.partition(", ")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mission = tl.load_mission(first, OTHER_PARTS if kind == "other parts" else {})
        return interactive_mission(mission) if kind == "interactive" else mission


@functools.cache
def trace_of(name):
    return trace_assembly(mission_of(name))


def assert_close(found, wanted):
    """Equal within a relative 1e-12, or to rounding of what cancels; numbers that are not finite are the same."""
    finite = np.isfinite(wanted)
    assert np.array_equal(found[~finite], wanted[~finite], equal_nan=True)
    found, wanted = found[finite], wanted[finite]
    assert np.all(np.abs(found - wanted) <= 1e-12 * np.abs(wanted) + 1e-16)


@pytest.mark.thorough
@pytest.mark.parametrize("name", MISSIONS)
def test_the_graph_gives_the_numbers_of_the_plain_assembly(name):
    plain, traced = assemble(mission_of(name)), trace_of(name)
    made = with_values(traced.assembled, traced.graph)
    assert [layout(made.model), layout(made.given)] == [layout(plain.model), layout(plain.given)]
    assert [table.shape for table in made.tables] == [table.shape for table in plain.tables]
    assert {type(x) for x in layout_and_numbers(made.model)[1]} == {float}
    assert_close(np.array(assembled_numbers(made)), np.array(list(map(float, assembled_numbers(plain)))))


@pytest.mark.parametrize("name", MISSIONS)
def test_every_number_is_an_input_or_fixed_for_a_reason(name):
    traced, mission = trace_of(name), mission_of(name)
    numbers = numbers_of_mission(mission)
    assert {*traced.keys, *traced.fixed} >= {*numbers, *counts_of_mission(mission)}
    assert not {*traced.keys} & {*traced.fixed}
    assert traced.values == tuple(numbers[key] for key in traced.keys)
    fixed = [key for key in traced.fixed if key in numbers]
    assert all(re.fullmatch(f"{PLANNED}|{ROUNDED}", key) for key in fixed), fixed
    assert all(len(reason) > 20 for reason in traced.fixed.values())
    assert len(traced.keys) >= 0.95 * len(numbers)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["iris, other parts", "rotor-loss, interactive", "zigzag"])
def test_the_graph_at_other_numbers_is_a_fresh_trace_to_the_last_bit(name):
    traced = trace_of(name)
    numbers = varied(traced, 0)
    fresh = trace_assembly(with_numbers(mission_of(name), numbers))
    assert fresh.keys == traced.keys
    wanted = values_of(fresh, fresh.graph.values)
    made = machine_code(traced)(list(numbers.values()))
    assert [bool(truth) for truth in made[wanted.size :]] == [guard.holds for guard in traced.guards]
    assert np.array_equal(bits(made[: wanted.size]), bits(wanted))
    again = values_of(traced, evaluated(traced.graph, list(numbers.values())))
    assert np.array_equal(bits(again), bits(wanted))
    assert np.mean(wanted != values_of(traced, traced.graph.values)) > 0.3  # most of what is no start value


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("vehicle.quadrotors.0.position.0", 0.2),  # a full tensor of inertia instead of a diagonal one
        ("controller.gains.a.2", 2.5),  # a power instead of a cube
        ("pushes.0.point.1", 0.4),  # a push with a moment
    ],
)
def test_numbers_that_need_another_graph_fail_a_guard_that_names_them(key, value):
    traced, mission = trace_of("hover"), mission_of("hover")
    if key not in traced.keys:
        mission = tl.load_mission("one-push")
        traced = trace_assembly(mission)
    inputs = [value if name == key else x for name, x in zip(traced.keys, traced.values, strict=True)]
    nodes = evaluated(traced.graph, inputs)
    failed = [guard for guard in traced.guards if nodes[guard.condition.node] != guard.holds]
    assert failed
    assert all(key in traced.keys_of(guard) for guard in failed)
    fresh = assemble(with_numbers(mission, {key: value}))
    assert layout(fresh.model) != layout(traced.assembled.model) or layout(fresh.given) != layout(
        traced.assembled.given
    )


def test_a_changed_mission_within_the_guards_is_close_to_its_plain_assembly():
    """NumPy's inverses and eigenvalues, and libm's functions, at numbers that no built-in mission has."""
    for name in ("iris", "zigzag"):
        traced = trace_of(name)
        numbers = varied(traced, 7, spread=0.2)
        known = dict(zip(traced.keys, traced.values, strict=True))
        numbers |= {key: value for key, value in known.items() if key.endswith("guard_radius")}  # all rotors in guards
        plain = assemble(with_numbers(mission_of(name), numbers))
        made = values_of(traced, evaluated(traced.graph, list(numbers.values())))
        assert_close(made, np.array(list(map(float, assembled_numbers(plain)))))


def test_the_pilot_alone_is_traced_too():
    mission = tl.load_mission("iris")
    traced, plain = trace_assembly(mission, pilot_at_start), pilot_at_start(mission)
    made = with_values(traced.assembled, traced.graph)
    assert layout(made) == layout(plain)
    assert_close(np.array(flat(made)), np.array(flat(plain)))
    assert "sensors.delay" in traced.keys  # which is no part of the pilot


def test_a_flight_that_is_not_fused_is_close_to_one_that_is():
    one, other = (
        tl.fly(tl.load_mission("iris", {"mission.duration": 1.0, "mission.fma": fused})) for fused in (True, False)
    )
    for channel in one:
        assert np.allclose(one[channel], other[channel], rtol=0.0, atol=1e-9, equal_nan=True), channel


def test_nothing_of_a_trace_stays_in_a_cache():
    import gc
    import weakref

    mission = tl.load_mission("iris")
    traced = trace_assembly(mission)
    graph = weakref.ref(traced.graph)
    del traced
    gc.collect()
    assert graph() is None
    assert all(math.isfinite(x) for x in flat(assemble(mission).model.plant))
