"""FMUs have the bits of native flights, in an importer written from the standards; and refuse what cannot be."""

import re
from functools import cache

import numpy as np
import pytest
from c_flights import same, unfused
from fmu_importer import DISCARD, ERROR, OK, Fmu, Instance

import tandemlift as tl
from tandemlift.codegen import fmu_binaries
from tandemlift.codegen.fmu import fmu_of
from tandemlift.codegen.fmu_sources import flight_part, pilot_part
from tandemlift.flight.channels import column_names
from tandemlift.simulation.caller_values import portable_mission
from tandemlift.simulation.parameter_changes import scheduled_change
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation.traced_assembly import trace_assembly
from tandemlift.simulation.preparation.vehicle_step import is_of_vehicle
from tools import need

BOTH = pytest.mark.parametrize("fmi", [2, 3])
IN_TARGETS = [pytest.param("zigzag", marks=pytest.mark.targets)]
MEASURED = ("position", "velocity", "attitude", "rates", "push_force")


@pytest.fixture(scope="module")
def fmu(tmp_path_factory):
    """FMUs by mission, part and version; a part is compiled once, and its library has both versions."""
    need("gcc")
    folder = tmp_path_factory.mktemp("fmus")
    made = pytest.MonkeyPatch()
    made.setattr(fmu_binaries, "FLAGS", fmu_binaries.FLAGS.replace("-O2", "-O0"))  # the bits are those of any level

    @cache
    def both(name, part):
        mission = portable_mission(tl.load_mission(name))
        described = pilot_part(mission) if part == "pilot" else flight_part(mission, part)
        two, three = (folder / f"{described.identifier}{fmi}.fmu" for fmi in (2, 3))
        two.write_bytes(fmu_of(described, 2, ["host"]))
        three.write_bytes(fmu_of(described, 3, []))
        first = Fmu(two)
        return {2: first, 3: Fmu(three, first.path)}

    yield lambda name, part, fmi: both(name, part)[fmi]
    made.undo()


@cache
def flown(name, **changes):
    return tl.fly(unfused(tl.load_mission(name, changes)))


def columns_of(flight, fmi, names):
    """The numbers of channels, row by row, in the order of an FMU's outputs of these names."""
    if fmi == 3:
        return np.hstack([np.reshape(flight[name], (len(flight.time), -1)) for name in names])
    labels = {}
    for name in flight.channels:
        values = np.reshape(flight[name], (len(flight.time), -1))
        labels |= dict(zip(column_names(name, flight.info(name), flight[name].shape[1:]), values.T, strict=True))
    return np.stack([labels[name] for name in names], axis=1)


def recorded(instance, outputs, steps, size):
    """Outputs at the start and after each of so many steps."""
    references, count = instance.references(outputs)
    assert instance.begin() == OK, instance.said
    rows = [instance.get(references, count)]
    for k in range(steps):
        assert instance.step(k * size, size) == OK, instance.said
        rows.append(instance.get(references, count))
    return np.array(rows)


@pytest.mark.thorough
@BOTH
@pytest.mark.parametrize("name", ["hover", "iris", *IN_TARGETS])
def test_a_whole_flight_has_the_bits_of_the_record(name, fmi, fmu):
    flight, described = flown(name), fmu(name, "flight", fmi)
    names = described.of("output")
    rows = recorded(Instance(described), names, len(flight.time) - 1, float(flight.time[1]))
    assert same(rows, columns_of(flight, fmi, names))
    assert len(names) == (sum(not name.endswith("_stamp") for name in flight.channels) if fmi == 3 else rows.shape[1])


@pytest.mark.thorough
@BOTH
@pytest.mark.parametrize("name", ["paper", "iris", *IN_TARGETS])
def test_a_pilot_has_the_thrusts_of_the_native_one(name, fmi, fmu):
    flight, mission = flown(name), unfused(tl.load_mission(name))
    pilot, instance, dt = tl.Pilot(mission), Instance(fmu(name, "pilot", fmi)), mission.mission.step
    rows = np.hstack([flight[channel] for channel in MEASURED])
    rotors = flight["rotor_thrusts"].shape[1]
    assert instance.begin() == OK
    for k, row in enumerate(np.repeat(rows[:: len(rows) // 40], 50, axis=0)):
        for channel, at, end in zip(MEASURED, (0, 3, 6, 10, 13), (3, 6, 10, 13, 16), strict=True):
            instance.set(channel, row[at:end])
        assert instance.step(k * dt, dt) == OK
        assert same(instance.number("thrusts", rotors), pilot.step(np.ascontiguousarray(row)))


@pytest.mark.thorough
@BOTH
@pytest.mark.parametrize("name", ["hover", "iris", *IN_TARGETS])
def test_a_vehicle_under_thrusts_and_pushes_has_the_bits_of_the_simulation(name, fmi, fmu):
    mission, described = unfused(tl.load_mission(name)), fmu(name, "vehicle", fmi)
    sim, instance, dt = tl.Simulation(mission), Instance(described), mission.mission.step
    chance, rotors = np.random.default_rng(1), 4 * len(mission.vehicle.quadrotors)
    weight = flown(name)["rotor_thrusts"][-1]
    assert instance.begin() == OK
    channels = [channel for channel in sim.channels if is_of_vehicle(channel)]
    assert len(described.of("output")) >= len(channels) >= 10
    for k in range(1500):
        thrusts, push = weight + 0.1 * chance.normal(size=rotors), chance.normal(size=3)
        for key, value in (("thrusts", thrusts), ("push", push), ("point", (0.0, 0.1, 0.0))):
            instance.set(key, value)
        sim.step(push, thrusts, point=(0.0, 0.1, 0.0))
        if k % 50 == 0:  # its outputs, with these inputs, are the sample of the step that comes
            for channel in channels:
                values = np.atleast_1d(sim[channel])
                assert same(instance.number(channel, len(values)), values), channel
        assert instance.step(k * dt, dt) == OK
    assert same(instance.number("position", 3), sim.state[:3])
    assert same(instance.number("rates", 3), sim.state[10:])


@BOTH
def test_a_flight_follows_a_desired_velocity_and_commanded_thrusts_once_they_are_said_to_count(fmi, fmu):
    mission = unfused(tl.load_mission("hover"))
    sim, instance, dt = tl.Simulation(mission), Instance(fmu("hover", "flight", fmi)), mission.mission.step
    weight, velocity = 1.02 * flown("hover")["rotor_thrusts"][-1], (0.4, -0.3, 0.1)
    assert instance.begin() == OK
    instance.set("desired_velocity", velocity)
    instance.set("thrusts", weight)
    for k in range(900):
        counts, commanded = 200 <= k < 600, k >= 700
        if k in (200, 600, 700):
            assert instance.truth("desired_velocity_given", counts) == instance.truth("thrusts_given", commanded) == OK
        assert instance.step(k * dt, dt) == OK
        sim.step(thrusts=weight if commanded else None, velocity=velocity if counts else None)
        if k in (199, 599, 699, 899):
            assert same(instance.number("position", 3), sim.state[:3]), k
            assert same(instance.number("velocity", 3), sim.state[3:6]), k
    assert not same(sim.state[3:6], np.zeros(3))


@BOTH
def test_a_pilot_begins_enabled_and_holds_its_place_once_it_is_not(fmi, fmu):
    """Before anything is set, each input has the start of its description."""
    instance, native = Instance(fmu("iris", "pilot", fmi)), tl.Pilot(unfused(tl.load_mission("iris")))
    assert instance.truth("enabled") is True
    assert [instance.truth(name) for name in ("land", "lift", "stop")] == [False] * 3
    assert instance.begin() == OK
    state = np.eye(16)[6]
    state[13] = 3.0  # N: a push
    for k in range(20):
        if k == 10:
            assert instance.truth("enabled", False) == OK
        instance.set("push_force", state[13:])
        assert instance.step(k * 0.001, 0.001) == OK
        assert same(instance.number("thrusts", 8), native.step(state, enabled=k < 10))


@pytest.mark.thorough
def test_pilot_and_vehicle_together_fly_the_whole_flight(fmu):
    flight, mission = flown("paper"), tl.load_mission("paper")
    pilot, vehicle = Instance(fmu("paper", "pilot", 3)), Instance(fmu("paper", "vehicle", 3))
    assert pilot.begin() == vehicle.begin() == OK
    dt, rotors, every = mission.mission.step, flight["rotor_thrusts"].shape[1], mission.mission.log_every
    for k in range(20_000):
        for channel, size in zip(MEASURED, (3, 3, 4, 3, 3), strict=True):
            value = vehicle.number(channel, size)
            pilot.set(channel, value)
            assert k % every or same(value, flight[channel][k // every])
        assert pilot.step(k * dt, dt) == OK  # first, so that its thrusts act in the same step
        vehicle.set("thrusts", pilot.number("thrusts", rotors))
        assert vehicle.step(k * dt, dt) == OK
    assert np.abs(flight["push_force"][:2000]).max() > 1.0


@BOTH
def test_a_parameter_is_the_key_of_the_mission(fmi, fmu):
    flight, instance = flown("hover", **{"vehicle.payload.mass": 0.52}), Instance(fmu("hover", "flight", fmi))
    names = instance.fmu.of("output")
    assert instance.set("vehicle.payload.mass", 0.52) == OK
    rows = recorded(instance, names, 500, float(flight.time[1]))
    assert same(rows, columns_of(flight, fmi, names)[:501])
    assert not same(rows, columns_of(flown("hover"), fmi, names)[:501])
    assert instance.set("vehicle.payload.mass", 0.5) == ERROR
    assert "vehicle.payload.mass: is a parameter" in instance.said[-1]


@BOTH
@pytest.mark.parametrize(
    ("key", "value", "text"),
    [
        ("vehicle.payload.mass", -1.0, r"vehicle\.payload\.mass = -1: must be > 0 and <= inf"),
        ("vehicle.payload.mass", np.nan, r"vehicle\.payload\.mass = -?nan: must be > 0"),
    ],
)
def test_values_out_of_bounds_fail_at_the_end_of_initialization(key, value, text, fmi, fmu):
    instance = Instance(fmu("hover", "flight", fmi))
    instance.set(key, value)
    assert instance.begin() == ERROR
    assert re.search(text, instance.said[-1])
    assert instance.step(0.0, 0.001) == ERROR
    assert instance("Reset") == OK
    instance.initialize()
    assert instance.begin() == OK


@BOTH
def test_values_that_need_other_code_fail_with_their_keys(fmi, fmu):
    for part in ("pilot", "flight"):
        instance = Instance(fmu("hover", part, fmi))
        assert instance.set("controller.smoothing_bandwidth", 30.0) == OK  # none is smoothed in this mission
        assert instance.begin() == ERROR
        assert instance.said[-1].startswith("controller.smoothing_bandwidth: the values need other code")


@BOTH
def test_a_pilot_takes_no_step_with_a_number_that_is_not_finite(fmi, fmu):
    pilot, mission = Instance(fmu("paper", "pilot", fmi)), unfused(tl.load_mission("paper"))
    native, still = tl.Pilot(mission), np.eye(16)[6]
    assert pilot.begin() == OK
    for wrong in (np.nan, np.inf):
        pilot.set("attitude", [1.0, 0.0, wrong, 0.0])
        assert pilot.step(0.0, 0.001) == DISCARD
        assert re.search(r"attitude\S*y = -?(nan|inf) is not finite", pilot.said[-1])
    pilot.set("attitude", [1.0, 0.0, 0.0, 0.0])
    for k in range(100):
        assert pilot.step(k * 0.001, 0.001) == OK
        assert same(pilot.number("thrusts", 8), native.step(still))
    pilot = Instance(fmu("paper", "pilot", fmi))
    pilot.set("velocity", [np.nan, 0.0, 0.0])
    assert pilot.begin() == ERROR


@BOTH
def test_a_flight_takes_no_step_with_a_push_that_is_not_finite_and_names_it(fmi, fmu):
    flown, other = Instance(fmu("hover", "flight", fmi)), Instance(fmu("hover", "flight", fmi))
    assert flown.begin() == other.begin() == OK
    for wrong in (np.nan, -np.inf):
        flown.set("push", [0.0, wrong, 0.0])
        assert flown.step(0.0, 0.001) == DISCARD
        assert re.search(r"push\S*y = -?(nan|inf) is not finite", flown.said[-1])
    flown.set("push", [0.0, 0.0, 0.0])
    for k in range(20):
        assert flown.step(k * 0.001, 0.001) == other.step(k * 0.001, 0.001) == OK
    assert same(flown.number("velocity", 3), other.number("velocity", 3))
    begun = Instance(fmu("hover", "flight", fmi))
    begun.set("push", [np.nan, 0.0, 0.0])
    assert begun.begin() == ERROR


@BOTH
def test_a_tunable_parameter_that_is_set_between_steps_has_the_bits_of_a_change(fmi, fmu):
    described, key, value = fmu("hover", "flight", fmi), "controller.gains.xi.0", 3.0
    change = {"time": 0.7, "key": key, "value": value, "duration": 0.0}
    expected = tl.fly(unfused(tl.load_mission("hover", {"changes": [change], "mission.duration": 2.0})))
    instance, (outputs, count) = Instance(described), Instance(described).references(described.of("output"))
    every, rows = round(float(expected.time[1]) / 0.001), []
    assert instance.begin() == OK
    name = key if fmi == 2 else "controller.gains.xi"
    gains = list(tl.load_mission("hover").controller.gains.xi)
    for k in range(2000):
        if k % every == 0:
            rows.append(instance.get(outputs, count))
        if k == 700:
            new = [value, *gains[1:]]
            assert instance.set(name, value if fmi == 2 else new) == OK
        assert instance.step(k * 0.001, 0.001) == OK, instance.said
    assert same(np.array(rows), columns_of(expected, fmi, described.of("output"))[: len(rows)])


@BOTH
def test_a_fixed_parameter_is_not_set_between_steps_and_a_tunable_one_within_its_bounds(fmi, fmu):
    instance = Instance(fmu("hover", "flight", fmi))
    assert instance.begin() == OK
    assert instance.set("vehicle.payload.mass", 0.7) == ERROR
    assert "vehicle.payload.mass: is a parameter, and set before" in instance.said[-1]
    assert instance.step(0.0, 0.001) == OK
    assert instance.set(*(("controller.gains.xi.0", -1.0) if fmi == 2 else ("controller.gains.xi", [-1.0] * 6))) == OK
    assert instance.step(0.001, 0.001) == ERROR
    assert "controller.gains.xi.0 = -1: must be" in instance.said[-1]


def test_tunable_are_the_parameters_that_changes_of_a_mission_can_change():
    mission = portable_mission(tl.load_mission("hover"))
    plan = FlightPlan(mission, interactive=True)
    variables = [v for v in flight_part(mission, "flight").variables if v.causality == "parameter"]
    tunable = [label for v in variables if v.is_tunable for label in v.labels]
    fixed = [label for v in variables if not v.is_tunable for label in v.labels]
    assert len(tunable) > 50
    assert len(fixed) > 50
    traced = trace_assembly(mission)
    values = dict(zip(traced.keys, traced.values, strict=True))

    def can(key):
        for factor in (1.01, 0.99):
            try:
                scheduled_change(plan, key, values[key] * factor or 0.01, 100, 0.0)
            except tl.InputError:
                continue
            return True
        return False

    other_code = {key for guard in traced.guards for key in traced.keys_of(guard)}
    rng = np.random.default_rng(5)
    assert [key for key in rng.choice(tunable, 20, replace=False) if not can(key)] == []
    assert [key for key in rng.choice(fixed, 20, replace=False) if can(key) and key not in other_code] == []


@BOTH
def test_steps_off_the_sample_time_are_refused_by_name(fmi, fmu):
    def begun():
        instance = Instance(fmu("hover", "flight", fmi), start=2.0)
        assert instance.begin() == OK
        return instance

    exact, multiple, rounded, summed = begun(), begun(), begun(), begun()
    for k in range(10):
        assert exact.step(2.0 + k * 0.001, 0.001) == OK
    assert multiple.step(2.0, 0.01) == OK
    assert rounded.step(2.0, 0.01 * (1.0 + 1e-8)) == OK
    for k in range(10):
        assert summed.step(2.0 + k * 0.001 + (-1) ** k * 0.00045, 0.001) == OK  # as where steps are summed for days
    assert same(exact.number("velocity", 3), summed.number("velocity", 3))
    assert same(exact.number("velocity", 3), multiple.number("velocity", 3))
    assert same(exact.number("velocity", 3), rounded.number("velocity", 3))
    for time, size in (
        (2.0, 0.0015),
        (2.0, 0.0),
        (2.0, -0.001),
        (2.0, np.nan),
        (2.001, 0.001),
        (2.0006, 0.001),
        (2.0, 0.00100001),
    ):
        instance = begun()
        assert instance.step(time, size) == ERROR
        assert instance.said[-1].startswith("step-off-sample-time: ")


@pytest.mark.thorough
@BOTH
def test_a_state_is_restored_also_in_another_instance(fmi, fmu):
    described = fmu("iris", "flight", fmi)
    one, names = Instance(described), described.of("output")
    references, count = one.references(names)
    assert one.begin() == OK
    for k in range(300):
        assert one.step(k * 0.01, 0.01) == OK
    state = one.saved()
    data = one.packed(state)
    ends = []
    other = Instance(described)
    assert other.begin() == OK
    status, again = other.unpacked(data)
    assert status == OK
    for instance, kept in ((one, None), (one, state), (other, again)):
        if kept is not None:
            assert instance.restore(kept) == OK
        for k in range(300, 400):
            assert instance.step(k * 0.01, 0.01) == OK
        ends.append(instance.get(references, count))
    assert same(ends[0], ends[1])
    assert same(ends[0], ends[2])
    assert other.unpacked(data[:-1])[0] == ERROR
    assert other.unpacked(bytes(len(data)))[0] == ERROR


@BOTH
def test_a_flight_ends_with_its_mission(fmi, fmu):
    mission = tl.load_mission("hover").mission
    instance = Instance(fmu("hover", "flight", fmi))
    assert instance.begin() == OK
    assert instance.step(0.0, mission.duration) == OK
    status = instance.step(mission.duration, 0.001)
    assert "mission.duration" in instance.said[-1]
    assert status == DISCARD


@BOTH
def test_a_vehicle_goes_on_beyond_the_mission_until_it_falls_and_shows_where(fmi, fmu):
    """In one step of the importer the outputs at its end are those of many steps."""
    duration, ends = tl.load_mission("hover").mission.duration, []
    for size in (duration, 0.001):
        vehicle, k = Instance(fmu("hover", "vehicle", fmi)), 0
        vehicle.set("thrusts", flown("hover")["rotor_thrusts"][0])
        assert vehicle.begin() == OK
        assert vehicle.step(0.0, 2.0 * duration) == OK
        vehicle.set("thrusts", np.zeros(8))
        while (status := vehicle.step(2.0 * duration + k * size, size)) == OK:
            k, place = k + 1, vehicle.number("position", 3)
        assert status == DISCARD
        assert "a crash or divergence" in vehicle.said[-1]
        ends.append(vehicle.number("position", 3))
    assert k > 100
    assert same(place, ends[1])
    assert same(ends[0], ends[1])


def test_another_token_and_unknown_references_are_refused(fmu):
    for fmi in (2, 3):
        assert not Instance(fmu("paper", "pilot", fmi), token="{0}").at
    instance = Instance(fmu("paper", "pilot", 3))
    assert instance.set("thrusts", np.zeros(8)) == ERROR
    assert "is an output" in instance.said[-1]
    instance.fmu.places["none"] = 10**6
    assert instance.set("none", [0.0]) == ERROR
    assert instance.set("position", [0.0]) == ERROR
    assert "has 3 numbers, but 1 are given" in instance.said[-1]


def test_all_functions_are_there_and_those_of_other_kinds_refuse(fmu):
    for fmi, name in ((2, "GetDerivatives"), (2, "GetDirectionalDerivative"), (3, "EnterEventMode"), (3, "GetClock")):
        instance = Instance(fmu("paper", "pilot", fmi))
        assert instance(name) == ERROR
        assert instance.said[-1] == f"fmi{fmi}{name}: this FMU has no such thing"


@pytest.mark.thorough
def test_descriptions_have_keys_units_bounds_and_arrays(fmu):
    flat, arrays = fmu("iris", "flight", 2), fmu("iris", "flight", 3)
    mass = next(v for v in flat.variables if v.get("name") == "vehicle.payload.mass")
    assert mass.get("description") == "mass of the payload"
    assert mass.find("Real").attrib == {"unit": "kg", "min": "0.0", "start": "0.5"} | mass.find("Real").attrib
    point = next(v for v in arrays.variables if v.get("name") == "admittance.stiffness")
    assert [d.get("start") for d in point.findall("Dimension")] == ["3"]
    assert len(point.get("start").split()) == 3
    assert len(set(flat.places)) == len(flat.variables) > 300
    assert len(fmu("iris", "vehicle", 3).of("parameter")) < len(arrays.of("parameter"))
    assert not any(key.startswith("controller.") for key in fmu("iris", "vehicle", 3).of("parameter"))
