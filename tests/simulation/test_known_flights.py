"""Flights of mission files that flew before: the same flight, and never one of other sources, settings or laws."""

import ast
import os
import re
import sys
import time
from pathlib import Path

import pydantic
import pytest
from edited_package import EditedPackage
from patience import completed

import tandemlift as tl
from tandemlift.compiler.machine_code import store
from tandemlift.missions import built_in
from tandemlift.simulation import known_flights
from tandemlift.simulation.fly import fly_plan
from tandemlift.simulation.known_flights import WITH_LAWS, KnownFile
from tandemlift.simulation.plan import FlightPlan

PACKAGE = Path(tl.__file__).parent
MARKS = {"law", "choice", "elementwise", "register", "register_sensor"}
SHORT = {"mission.duration": 0.3}
FLY = """
import sys, tandemlift as tl
flight = tl.fly(sys.argv[1])
laws = [name for name in sys.modules if name.startswith(("tandemlift.parts", "tandemlift.missions", "pydantic"))]
flight.results["wall_s"] = 0.0
flight.save(sys.argv[2])
print("prepared" if laws else "known", *flight["thrust"][-1:])
"""


def flown(file, out, **environment):
    """How a new process flies a mission's file: 'known' or 'prepared', and the last thrust [N]; the flight it saved."""
    command = [sys.executable, "-W", "error", "-c", FLY, str(file), str(out)]
    done = completed(command, capture_output=True, text=True, env=os.environ | environment)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


@pytest.fixture
def file(tmp_path):
    """A mission of its own, in a file that extends another file."""
    (tmp_path / "base.toml").write_text('extends = "one-push"\n[mission]\nname = "own"\nduration = 0.3\n')
    path = tmp_path / "own.toml"
    path.write_text('extends = "base.toml"\n[plant]\nmass_scale = 1.1\n')
    return path


@pytest.fixture
def unaware(monkeypatch):
    """This process counts as one that has loaded no laws and began after the last edit of the sources."""
    monkeypatch.setattr(known_flights, "WITH_LAWS", re.compile("none of them"))
    monkeypatch.setattr(store, "LOADED", 1 << 62)


@pytest.mark.thorough
def test_a_known_flight_is_the_prepared_one_until_a_file_that_it_extends_changes(file, tmp_path):
    first, second = (flown(file, tmp_path / f"{i}.npz") for i in "ab")
    assert [first[0], second[0]] == ["prepared", "known"]
    assert tl.Flight.load(tmp_path / "a.npz") == tl.Flight.load(tmp_path / "b.npz")
    base = tmp_path / "base.toml"
    base.write_text(base.read_text() + "[initial]\nposition = [0.1, 0.0, 0.0]\n")
    how, thrust = flown(file, tmp_path / "c.npz")
    assert how == "prepared"
    assert thrust != first[1]
    assert flown(file, tmp_path / "d.npz") == ["known", thrust]


@pytest.mark.thorough
def test_an_edit_of_a_law_a_table_or_a_built_in_mission_is_flown(tmp_path):
    package = EditedPackage(tmp_path)
    time.sleep(2e-9 * store.MARGIN)
    fly = 'import sys, tandemlift as tl\nflight = tl.fly("one-push")\n'
    fly += 'print("tandemlift.parts" in sys.modules, flight["position"].sum().hex(), len(flight.time))'
    first, again = package.run(fly).split(), package.run(fly).split()
    assert [first[0], again] == ["True", ["False", *first[1:]]]
    package.replace("parts/mechanics/rotation.py", "return Vec3(2.0 * (q.x * q.z +", "return Vec3(2.1 * (q.x * q.z +")
    turned = package.run(fly).split()
    assert turned[0] == "True"
    assert turned[1] != first[1]
    assert package.run(fly).split() == ["False", *turned[1:]]
    package.insert("missions/mission.py", "from __future__ import annotations\n", "# an edit\n")
    assert package.run(fly).split() == turned
    mission = package.folder / "tandemlift" / "data" / "missions" / "one-push.toml"
    mission.write_text(mission.read_text("utf-8").replace("duration = 12.0", "duration = 6.0"), "utf-8")
    assert package.run(fly).split()[::2] == ["True", "601"]


@pytest.mark.thorough
def test_every_module_with_a_law_a_choice_a_table_or_a_registry_counts_as_one_that_may_be_replaced():
    found = []
    for path in PACKAGE.rglob("*.py"):
        tree = ast.parse(path.read_text("utf-8"))
        nodes = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.ClassDef)]
        named = {ast.unparse(mark).partition("(")[0] for node in nodes for mark in node.decorator_list}
        marked = {name.rpartition(".")[2] for name in named if name != "atexit.register"} & MARKS
        tables = {ast.unparse(base) for node in nodes if isinstance(node, ast.ClassDef) for base in node.bases}
        tables = {base for base in tables if base.endswith("Table") or base == "BaseModel"}
        name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
        if (marked or tables) and re.match(r"tandemlift\.(?!core|apps|analysis|pictures|codegen)", name):
            found.append(name)
    assert len(found) > 80
    assert [name for name in found if not WITH_LAWS.match(name)] == []


@pytest.mark.parametrize("before", ["import tandemlift.parts.controllers", "tl.load_mission('hover')", "tl.Pilot"])
def test_a_process_that_has_loaded_laws_neither_finds_nor_keeps_a_flight(before):
    code = f"import tandemlift as tl; from tandemlift.simulation.known_flights import KnownFile\n{before}\n"
    done = completed([sys.executable, "-c", code + "print([KnownFile('hover')._key])"], capture_output=True, text=True)
    assert done.stdout == "['']\n", done.stderr


def test_a_process_that_began_before_a_source_changed_knows_no_flight(monkeypatch):
    monkeypatch.setattr(known_flights, "WITH_LAWS", re.compile("none of them"))
    read = [path for room in store.ROOMS for path in (PACKAGE / room).rglob("*.py")]
    read += [Path(pydantic.__file__).with_name("version.py"), *store.MISSIONS.glob("*.toml")]
    newest = max(path.stat().st_ctime_ns for path in read)
    for begun, knows in ((newest + 10**9, True), (newest - 1, False)):
        monkeypatch.setattr(store, "LOADED", begun)
        assert bool(KnownFile("hover")._key) is knows


def test_missions_settings_versions_processors_and_mathematics_have_keys_of_their_own(unaware, monkeypatch):
    changes = [{}, SHORT, {"mission.seed": 1}, {"mission.seed": 1.0}, {"mission.seed": True}, {"plant.mass_scale": 0.0}]
    changes += [{"plant.mass_scale": -0.0}, {"pushes": []}, {"pushes": ()}]
    keys = [KnownFile(name)._key for name in built_in()] + [KnownFile("hover", c)._key for c in changes[1:]]
    for change in (
        lambda: monkeypatch.setattr("numpy.__version__", "0"),
        lambda: monkeypatch.setattr("llvmlite.__version__", "0"),
        lambda: monkeypatch.setattr("tandemlift.compiler.machine_code.machine.processor", lambda: ("another", "")),
        lambda: monkeypatch.setenv("OPENBLAS_CORETYPE", "Haswell"),
    ):
        change()
        keys.append(KnownFile("hover")._key)
    assert all(keys)
    assert len(set(keys)) == len(keys)


def test_names_and_values_that_are_more_than_text_have_no_key(unaware, tmp_path):
    assert KnownFile("no such mission")._key == KnownFile(tmp_path / "saved.zip")._key == ""
    assert KnownFile("hover", {"mission.duration": __import__("numpy").float64(1.0)})._key == ""


def remembered(name, changes):
    """A mission's file after its flight, and the flight."""
    known = KnownFile(name, changes)
    flight, raw = fly_plan(p := FlightPlan(tl.load_mission(name, changes)))
    known.remember(p, flight, raw)
    return KnownFile(name, changes), flight


@pytest.mark.thorough
@pytest.mark.parametrize("name", sorted(built_in()))
def test_a_known_flight_of_a_built_in_mission_has_the_record_of_a_prepared_one(name, unaware):
    file, flight = remembered(name, {"mission.log_interval": 0.05})
    again = file.flight().fly()
    flight.results["wall_s"] = again.results["wall_s"] = 0.0
    assert again == flight
    assert repr(again.results) == repr(flight.results)
    assert list(again.channels) == list(flight.channels)


def test_a_flight_of_a_file_that_was_edited_meanwhile_is_not_kept(unaware, file):
    known = KnownFile(file)
    flight, raw = fly_plan(p := FlightPlan(tl.load_mission(file)))
    file.write_text(file.read_text() + "# an edit\n")
    known.remember(p, flight, raw)
    assert KnownFile(file).flight() is None


def test_facts_of_a_file_are_made_anew_after_the_file_that_it_extends_was_edited(unaware, file):
    made = []
    for duration in ("0.3", "0.2", "0.3"):
        base = file.with_name("base.toml")
        base.write_text(re.sub("duration = .*", f"duration = {duration}", base.read_text()))
        time.sleep(2e-9 * store.MARGIN)
        remembered(file, {})
        made.append(KnownFile(file).facts("test", lambda seconds=duration: {"seconds": seconds}))
    assert made == [{"seconds": "0.3"}, {"seconds": "0.2"}, {"seconds": "0.3"}]


BLOW = {"time": 0.1, "sigma": 0.05, "force": [90.0, 90.0, 0.0]}


@pytest.mark.parametrize(
    "changes",
    [
        {"changes": [{"time": 0.1, "key": "admittance.mass", "value": 2.0}]},  # flown step by step
        {"promise.tilt": 0.005, "crash.tilt": 0.01, "initial.euler": [0.0, 0.0, 0.0], "pushes": [BLOW]},  # a crash
        {"promise.distance": 1e-9, "mission.step": 0.02},  # warned of
    ],
)
def test_a_flight_that_is_changed_ends_early_or_is_warned_of_is_not_kept(changes, unaware):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tl.FlightWarning, "count", 0)
        file, flight = remembered("paper", SHORT | changes)
        assert flight.ending or tl.FlightWarning.count or changes.get("changes")
    assert file.flight() is None


def test_a_flight_that_ends_with_other_numbers_is_prepared_anew(unaware, monkeypatch):
    file, flight = remembered("hover", SHORT)
    key, planned = f"{file._key}-flight", []
    entry, plan = store.read(key), KnownFile._plan
    monkeypatch.setattr(KnownFile, "_plan", lambda self: planned.append(1) or plan(self))
    for ending, count in ((entry.about["ending"], 0), ("0" * 32, 1)):
        store.write(key, entry._replace(about={**entry.about, "ending": ending}))
        again = file.flight().fly()
        again.results["wall_s"] = flight.results["wall_s"] = 0.0
        assert again == flight
        assert len(planned) == count
    store.remove(key)
    assert file.flight() is None


def test_a_known_flight_compiles_its_own_module_where_the_code_is_gone(unaware, tmp_path, monkeypatch):
    file, flight = remembered("hover", SHORT)
    entry = store.read(f"{file._key}-flight")
    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path))
    assert file.flight() is None
    store.write(f"{file._key}-flight", entry)
    again = file.flight().fly()
    flight.results["wall_s"] = again.results["wall_s"] = 0.0
    assert again == flight


def test_facts_of_a_known_flight_are_made_once_and_those_of_others_each_time(unaware):
    file, _ = remembered("hover", SHORT | {"mission.seed": 7})
    made, name = [], f"test-{os.urandom(6).hex()}"
    make = lambda: made.append(1) or {"number": len(made)}  # noqa: E731
    assert [KnownFile("hover", SHORT | {"mission.seed": 7}).facts(name, make) for _ in "ab"][1] == {"number": 1}
    assert file.facts(name, make) == {"number": 1}
    other = KnownFile("hover", {"mission.duration": 0.31})
    assert [other.facts(name, make), other.facts(name, make)] == [{"number": 2}, {"number": 3}]
