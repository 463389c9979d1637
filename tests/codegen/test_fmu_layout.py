"""What stands in an FMU: its variables and their places, its description for both versions, its libraries."""

import ctypes
import re
from xml.etree import ElementTree

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.codegen import fmu_binaries
from tandemlift.codegen.fmu_binaries import HOST, chosen_platforms, host, libraries
from tandemlift.codegen.fmu_description import base_unit, model_description, sources
from tandemlift.codegen.fmu_sources import flight_part, pilot_part
from tandemlift.codegen.fmu_variables import _labelled
from tandemlift.core.errors import InputError
from tandemlift.flight.channels import Channel
from tandemlift.simulation.caller_values import portable_mission
from tools import need

PARTS = ("pilot", "vehicle", "flight")
INPUTS = {
    "pilot": [
        *("position", "velocity", "attitude", "rates", "push_force", "push_moment", "land", "lift", "stop", "enabled"),
        *("rotor_failed", "allocated_thrust", "state_invalid", "limited_reason"),
    ],
    "vehicle": ["push", "point", "thrusts"],
    "flight": ["push", "point", "thrusts", "thrusts_given", "desired_velocity", "desired_velocity_given"],
}


@pytest.fixture(scope="module")
def parts():
    """The three FMUs of a mission, not compiled."""
    mission = portable_mission(tl.load_mission("hover"))
    return {name: pilot_part(mission) if name == "pilot" else flight_part(mission, name) for name in PARTS}


@pytest.fixture(scope="module")
def described(parts):
    """Their descriptions by name and version."""
    return {
        (name, fmi): ElementTree.fromstring(model_description(part, fmi, "{token}"))
        for name, part in parts.items()
        for fmi in (2, 3)
    }


def numbers(variables):
    return [v.at + i for v in variables for i in range(len(v.labels))]


@pytest.mark.parametrize("name", PARTS)
def test_each_number_of_an_fmu_has_one_place_inputs_behind_parameters_and_outputs_behind_inputs(name, parts):
    by = {kind: [v for v in parts[name].variables if v.causality == kind] for kind in ("parameter", "input", "output")}
    places = {kind: numbers(variables) for kind, variables in by.items()}
    whole = [place for kind in by for place in places[kind]]
    assert len(set(whole)) == len(whole)
    assert max(places["parameter"]) < min(places["input"])
    assert max(places["input"]) < min(places["output"])
    ends = sorted(places["output"])
    assert ends == list(range(ends[0], ends[-1] + 1))
    (text,) = (t for file, t in parts[name].texts.items() if file.endswith("fmu_values.c"))
    tables = re.findall(r"\{((?:\s*\d+,?)+)\s*\}", text)
    sizes = next(t for t in (list(map(int, re.findall(r"\d+", one))) for one in tables) if len(t) > 100)
    assert len(sizes) == max(whole) + 1
    assert {i: size for i, size in enumerate(sizes) if size} == {v.at: len(v.labels) for v in parts[name].variables}


@pytest.mark.parametrize("name", PARTS)
def test_inputs_are_those_of_a_step_and_begin_at_rest_with_the_pilot_enabled(name, parts, described):
    found = {v.name: v for v in parts[name].variables if v.causality == "input"}
    assert list(found) == INPUTS[name]
    at_rest = {"attitude": (1.0, 0.0, 0.0, 0.0), "enabled": (1.0,)}
    for key, variable in found.items():
        assert variable.start == at_rest.get(key, (0.0,) * len(variable.labels)), key
        assert variable.is_array == (len(variable.labels) > 1), key
    truths = {key for key, variable in found.items() if variable.is_truth}
    assert truths == {*found} & {"land", "lift", "stop", "enabled", "thrusts_given", "desired_velocity_given"}
    for fmi in (2, 3):
        start = {v.get("name"): v for v in described[name, fmi].find("ModelVariables")}
        if "enabled" in found:
            own = start["enabled"] if fmi == 3 else start["enabled"].find("Boolean")
            assert own.get("start") == "true"
        for key in truths - {"enabled"}:
            own = start[key] if fmi == 3 else start[key].find("Boolean")
            assert own.get("start") == "false"


@pytest.mark.parametrize("name", PARTS)
def test_the_c_code_begins_with_the_numbers_of_the_description(name, parts):
    """Those of a quaternion, and of the pilot that follows, are not 0."""
    starts = [x for v in parts[name].variables if v.causality == "input" for x in v.start]
    (text,) = (t for file, t in parts[name].texts.items() if file.endswith("_fmu.c"))
    lists = re.findall(r"\{\s*((?:-?\d+\.\d+,?\s*)+)\}", text)
    assert starts in [[float(x) for x in re.findall(r"-?\d+\.\d+", one)][: len(starts)] for one in lists]


def test_parameters_are_the_keys_that_act_in_a_part(parts):
    """The pilot has its own model of the vehicle and knows nothing of the real one; a vehicle has no pilot."""
    keys = {name: {v.name for v in parts[name].variables if v.causality == "parameter"} for name in PARTS}
    assert "plant.mass_scale" in keys["flight"] & keys["vehicle"]
    assert "plant.mass_scale" not in keys["pilot"]
    assert "vehicle.payload.mass" in keys["flight"] & keys["vehicle"] & keys["pilot"]
    assert any(key.startswith("controller.") for key in keys["flight"] & keys["pilot"])
    assert not any(key.startswith(("controller.", "admittance.")) for key in keys["vehicle"])
    assert keys["vehicle"] < keys["flight"]
    for name in PARTS:
        rows = [v for v in parts[name].variables if v.causality == "parameter"]
        mission = tl.load_mission("hover")
        mass = next(v for v in rows if v.name == "vehicle.payload.mass")
        assert mass.start == (mission.vehicle.payload.mass,)


def test_the_thrusts_of_a_pilot_are_one_for_each_rotor(parts):
    (thrusts,) = (v for v in parts["pilot"].variables if v.causality == "output")
    assert (thrusts.name, thrusts.is_array, len(thrusts.labels)) == ("thrusts", True, 8)
    assert len(set(thrusts.labels)) == 8
    assert (thrusts.channel.unit, thrusts.channel.width) == ("N", 1)


def test_a_number_of_each_quadrotor_has_its_quadrotors_name_also_of_one():
    channel = Channel("N", "", "of each quadrotor", 1, "quadrotor")
    assert len(set(_labelled("load", channel, 2, (2,)))) == 2
    assert _labelled("load", channel, 1, (1,)) != ("load",)
    assert _labelled("load", Channel("N", "", "of all", 1), 1, ()) == ("load",)


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_description_is_that_of_its_version(name, fmi, parts, described):
    root, own = described[name, fmi], parts[name]
    simulation, table = root.find("CoSimulation"), root.find("ModelVariables")
    assert (root.get("fmiVersion"), root.get("modelName")) == (f"{fmi}.0", own.identifier)
    assert root.get({2: "guid", 3: "instantiationToken"}[fmi]) == "{token}"
    assert root.get({3: "guid", 2: "instantiationToken"}[fmi]) is None
    state = {2: "FMUstate", 3: "FMUState"}[fmi]
    assert simulation.get(f"canGetAndSet{state}") == simulation.get(f"canSerialize{state}") == "true"
    assert (simulation.find("SourceFiles") is not None) == (fmi == 2)
    assert (simulation.get("canNotUseMemoryManagementFunctions") == "true") == (fmi == 2)
    assert (simulation.get("fixedInternalStepSize") is not None) == (fmi == 3)
    if fmi == 2:
        assert [file.get("name") for file in simulation.find("SourceFiles")] == sources(own)
    references = [int(v.get("valueReference")) for v in table]
    assert len(set(references)) == len(references)
    if fmi == 2:
        assert sorted(references) == sorted(place + 1 for place in numbers(own.variables))
        outputs = [str(i) for i, v in enumerate(table, 1) if v.get("causality") == "output"]
        for kind in ("Outputs", "InitialUnknowns"):
            assert [one.get("index") for one in root.find("ModelStructure").find(kind)] == outputs
    else:
        assert references[1:] == [v.at + 1 for v in own.variables]
        outputs = [str(v.at + 1) for v in own.variables if v.causality == "output"]
        for kind in ("Output", "InitialUnknown"):
            assert [one.get("valueReference") for one in root.find("ModelStructure").findall(kind)] == outputs
    units = {unit.get("name") for unit in root.find("UnitDefinitions")}
    used = {v.get("unit") or (v[0].get("unit") if len(v) else None) for v in table} - {None}
    assert used <= units
    assert "s" in units
    experiment = root.find("DefaultExperiment")
    assert (float(experiment.get("stepSize")), float(experiment.get("stopTime"))) == (own.step, own.duration)


def test_a_unit_is_the_product_of_its_factors():
    assert base_unit("N") == base_unit("kg m/s^2") == base_unit("J/m") == {"kg": 1, "m": 1, "s": -2}
    assert base_unit("N m s/rad") == {"kg": 1, "m": 2, "s": -1, "rad": -1}
    assert base_unit("m^2/m^2") == {}
    assert base_unit("1/s²") == {"s": -2}
    assert base_unit("V") is None


# libraries


def test_the_library_of_this_machine_is_where_each_version_looks_for_it(tmp_path):
    need("gcc")
    source = tmp_path / "one.c"
    source.write_text('int answer(void);\n__attribute__((visibility("default"))) int answer(void) { return 42; }\n')
    name, folder = host()
    kind = fmu_binaries.PLATFORMS[name]
    for asked in (HOST, name) if len(kind.machines) == 1 else (HOST,):
        for fmi, place in ((2, kind.fmi2), (3, folder)):
            (work := tmp_path / f"{asked}{fmi}").mkdir()
            ((path, code),) = libraries([source], "one", asked, fmi, work).items()
            assert path == f"binaries/{place}/one.{kind.ending}"
            library = work / f"copy.{kind.ending}"
            library.write_bytes(code)
            assert ctypes.CDLL(str(library)).answer() == 42


def test_platforms_are_chosen_once_each_and_sources_alone_are_none():
    assert chosen_platforms([HOST, " host "]) == [HOST]
    assert chosen_platforms(["none"]) == []
    with pytest.raises(InputError, match="'none' is for sources alone"):
        chosen_platforms([HOST, "none"])


def test_without_a_compiler_of_its_own_this_machine_needs_zig_and_says_so(monkeypatch):
    asked = []
    monkeypatch.setattr(fmu_binaries, "local_compiler", lambda: None)
    monkeypatch.setattr(fmu_binaries, "zig", lambda user: asked.append(user) or ["zig"])
    _, folder = host()
    assert fmu_binaries._command(folder, "a target") == ["zig", "-target", "a target"]
    assert fmu_binaries._command("mars-rover", "another") == ["zig", "-target", "another"]
    assert asked == [f"a library for {folder} without cc, gcc or clang", "a library for mars-rover"]
    monkeypatch.setattr(fmu_binaries, "local_compiler", lambda: "cc")
    assert fmu_binaries._command(folder, "a target") == ["cc"]
    assert np.size(asked) == 2
