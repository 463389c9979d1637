"""What users bring: the same flight in a process, a thread, a folder and a record, or a refusal; and bad input."""

import hashlib
import os
import sys
from pathlib import Path

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core import plugs
from tandemlift.core.law import CHOICES, LAWS
from tandemlift.core.plugs import PLUGS
from tandemlift.missions import check, format_toml, load_plugin, mission_from_text, tables_of
from tandemlift.parts.estimation.wrench.momentum import MomentumObserver
from tandemlift.parts.estimation.wrench.observation import observe
from tandemlift.parts.estimation.wrench.start_observer import OwnObserver
from tandemlift.parts.guidance.admittance import HardGate, gate
from tandemlift.parts.mechanics.rigid_body import RigidBody, motion

GATE = '''
"""A gate of one's own."""

from typing import NamedTuple

from tandemlift.core.algebra import absolute, where
from tandemlift.core.law import elementwise
from tandemlift.core.plugs import plug
from tandemlift.core.vector import Vec3, vec3
from tandemlift.parts.guidance.admittance import gate


class Times(NamedTuple):
    threshold: Vec3


@elementwise
def amplified(F, threshold):
    return where(absolute(F) > threshold, 2.0 * F, 0.0)


@gate.register(Times)
def pass_more(kind, F):
    return amplified(F, kind.threshold)


@plug("gate", "own-gate")
def start(table):
    """Twice the force."""
    return Times(vec3(table.threshold))
'''
OBSERVER = '''
from typing import NamedTuple

from tandemlift.core.plugs import plug
from tandemlift.core.vector import ZERO, Vec3
from tandemlift.parts.estimation.wrench.observation import ExternalWrench, NominalBody, observe, unexplained_force


class Filter(NamedTuple):
    body: NominalBody
    share: float


class Memory(NamedTuple):
    force: Vec3


@observe.register(Filter)
def low_pass(k, m, x):
    force = m.force + (unexplained_force(k.body, x) - m.force) * k.share
    return ExternalWrench(force, ZERO), Memory(force)


@plug("observer", "own-observer")
def start(table, body, noise, interval):
    """A low-pass of 12 rad/s."""
    return Filter(body, 12.0 * interval), Memory(ZERO)
'''
PUSH = {"mission.duration": 8.0, "admittance.gate": "own-gate"}
PUSHES = [{"force": [2.0, 0.0, 0.0], "time": 13.0, "sigma": 0.5}]


@pytest.fixture(autouse=True)
def as_before():
    """Take away what a test has brought."""
    tables = [*PLUGS.values(), *(one.made_by for one in PLUGS.values()), plugs._loaded]
    before = [dict(table) for table in tables]
    yield
    for table, old in zip(tables, before, strict=True):
        table.clear()
        table.update(old)


@pytest.fixture
def brought(tmp_path, monkeypatch):
    """Write a plugin beside which the test runs, and load it."""
    monkeypatch.chdir(tmp_path)

    def load(text, name="my.py"):
        Path(name).write_text(text, "utf-8")
        return load_plugin(name)

    return load


def registered():
    tables = [*PLUGS.values(), *(one.made_by for one in PLUGS.values()), *(one.table for one in CHOICES)]
    return [dict(table) for table in tables], len(LAWS), {name for name in sys.modules if "user" in name}


def flown(folder, tables, **how):
    """The final positions along x of a study's rows [m]."""
    return tl.study(tables, folder, **how).to_pandas()["final_position_m.0"].to_numpy()


def gates(*names):
    return {
        "study": {"name": "own", "missions": ["one-push"]},
        "set": {"mission.duration": 8.0},
        "grid": {"admittance.gate": list(names)},
    }


# The faults that flew wrong in silence


def test_processes_fly_the_gate_of_a_user_as_threads_do_and_not_the_built_in_one(brought, tmp_path):
    """The admittance is linear: twice the force, as the gate passes, moves it twice as far as the hard gate's."""
    brought(GATE)
    by_threads = flown(tmp_path / "threads", gates("own-gate", "hard"), threads=1)
    by_processes = flown(tmp_path / "processes", gates("own-gate", "hard"), processes=1)
    assert np.array_equal(by_threads, by_processes)
    assert by_threads[0] == pytest.approx(2.0 * by_threads[1], rel=1e-3)


def test_processes_fly_the_observer_of_a_user_as_threads_do_and_not_a_built_in_one(brought, tmp_path):
    brought(OBSERVER)
    study = {"study": {"name": "own", "missions": ["iris"]}, "grid": {"estimator.wrench": ["own-observer", "hybrid"]}}
    study["set"] = {"mission.duration": 16.0, "estimator.error_metrics": True, "pushes": PUSHES}
    rows = [flown(tmp_path / name, study, **{name: 1}) for name in ("threads", "processes")]
    assert np.array_equal(*rows)
    assert rows[0][0] != rows[0][1]


def test_a_folder_that_holds_the_rows_of_another_gate_of_this_name_is_that_of_another_study(brought, tmp_path):
    brought(GATE)
    first = flown(tmp_path / "rows", gates("own-gate"))
    brought(GATE.replace("2.0 * F", "3.0 * F"))
    with pytest.raises(tl.InputError, match=r"was flown with another version of my\.py"):
        flown(tmp_path / "rows", gates("own-gate"))
    assert flown(tmp_path / "others", gates("own-gate"))[0] == pytest.approx(1.5 * first[0], rel=1e-3)
    brought(GATE)
    assert flown(tmp_path / "rows", gates("own-gate")) == first  # as they were, and not flown again


def test_a_record_holds_name_text_and_digest_of_what_flew_and_its_mission_flies_alike_or_not_at_all(brought, tmp_path):
    brought(GATE)
    flight = tl.fly(tl.load_mission("one-push", PUSH))
    record = tl.Flight.load(flight.save(tmp_path / "flight.npz"))
    digest = hashlib.sha256(GATE.encode()).hexdigest()
    assert record.mission["plugins"] == [{"name": "my.py", "digest": digest, "text": GATE}]
    assert np.array_equal(tl.fly(check(record.mission))["position"], flight["position"])
    edited = brought(GATE.replace("2.0 * F", "3.0 * F"))
    with pytest.raises(tl.InputError, match=f"changed since .* was {digest[:16]}, .* is {edited.said.digest[:16]}"):
        check(record.mission)
    for name in ("gate", "observer"):
        PLUGS[name].pop("own-gate", None)
    with pytest.raises(tl.InputError, match=f"my.py with the digest {digest[:16]} is not loaded: give it by --plugin"):
        check(record.mission)


@pytest.mark.parametrize(("choice", "kind"), [(motion, RigidBody), (gate, HardGate), (observe, MomentumObserver)])
def test_a_law_over_one_of_the_package_is_refused_with_its_line_and_changes_nothing(choice, kind):
    before = choice.table[kind]
    with pytest.raises(
        tl.InputError, match=rf"test_plugs\.py, line \d+: {choice.__name__}\(\) of a {kind.__name__} .*@plug"
    ):

        @choice.register(kind)
        def own(*given):
            return given

    assert choice.table[kind] is before


def test_an_observer_in_place_of_a_built_in_one_is_refused_with_what_has_taken_its_place():
    with pytest.raises(tl.InputError, match=r'@plug\("observer", NAME\) .*estimator\.wrench = NAME'):
        OwnObserver(lambda body, noise, interval: None)


def test_flights_at_the_same_time_share_no_choice(brought):
    brought(GATE)
    missions = [tl.load_mission("one-push", {**PUSH, "admittance.gate": name}) for name in ("own-gate", "hard")] * 2
    together = [f["position"][-1, 0] for f in tl.fly_many(missions, threads=2)]
    assert together == [tl.fly(mission)["position"][-1, 0] for mission in missions]


def test_an_edited_gate_flies_as_edited_and_a_mission_from_before_must_be_loaded_again(brought):
    brought(GATE)
    mission = tl.load_mission("one-push", PUSH)
    before = tl.fly(mission)["position"][-1, 0]
    brought(GATE.replace("2.0 * F", "1.0 * F"))
    with pytest.raises(tl.InputError, match="or load the mission again"):
        tl.fly(mission)
    assert tl.fly(tl.load_mission("one-push", PUSH))["position"][-1, 0] == pytest.approx(0.5 * before, rel=1e-3)


# The key


def test_a_mission_names_its_files_from_its_folder_and_those_of_the_mission_that_it_extends(tmp_path):
    (tmp_path / "above").mkdir()
    (tmp_path / "above" / "gates.py").write_text(GATE)
    (tmp_path / "observers.py").write_text(OBSERVER)
    (tmp_path / "above" / "base.toml").write_text(
        'extends = "one-push"\nplugins = ["gates.py"]\n[admittance]\ngate = "own-gate"\n'
    )
    (tmp_path / "mine.toml").write_text('extends = "above/base.toml"\nplugins = ["observers.py"]\n')
    mission = tl.load_mission(tmp_path / "mine.toml")
    assert [(one.name, one.text) for one in mission.plugins] == [("gates.py", GATE), ("observers.py", OBSERVER)]
    assert tl.load_mission(mission_file(mission, tmp_path)).plugins == mission.plugins


def mission_file(mission, folder):
    path = folder / "flown.toml"
    path.write_text(format_toml(tables_of(mission)))
    return path


def test_a_file_that_is_read_alone_brings_no_code(tmp_path):
    (tmp_path / "my.py").write_text("raise SystemExit")
    with pytest.raises(tl.InputError, match="plugins: must be left out, as the file is read alone"):
        mission_from_text("sent.toml", f'extends = "hover"\nplugins = ["{tmp_path}/my.py"]\n')


# Bad input: one message, and nothing half registered


SECOND = OBSERVER.replace("@plug", '@plug("gate", "kept")\ndef other(table):\n    return table\n\n\n@plug')
WRONG = {
    "raises at import": (SECOND + "\n1 / 0\n", r"plugin my\.py, line 34: ZeroDivisionError: division by zero"),
    "ends the process": (SECOND + "\nraise SystemExit('no')\n", r"plugin my\.py, line 34: SystemExit: no"),
    "over a built-in name": (GATE.replace('"own-gate"', '"hard"'), r"'hard' is taken by the gate in admittance\.py"),
    "over a built-in law": (
        GATE.replace("import gate", "import gate, HardGate").replace("gate.register(Times)", "gate.register(HardGate)"),
        r"plugin my\.py, line \d+: my\.py, line \d+: gate\(\) of a HardGate is a matter of tandemlift",
    ),
    "a kind that is none": (
        SECOND.replace('"observer", "own', '"observr", "own'),
        "'observr'.*Did you mean 'observer'",
    ),
    "no name": (SECOND.replace('"own-observer"', '"own observer"'), "cannot be named 'own observer'"),
    "not Python": ("def\n", r"plugin my\.py, line 1: SyntaxError"),
    "nothing": ("import math\n", r"my\.py registers nothing"),
}


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_a_wrong_plugin_is_refused_in_one_message_and_leaves_nothing_behind(wrong, brought):
    text, said = wrong
    before = registered()
    with pytest.raises(tl.InputError, match=said) as refused:
        brought(text)
    assert "\n" not in str(refused.value)
    assert registered() == before or "nothing" in said


def test_two_plugins_of_one_name_are_refused_and_the_first_stays(brought):
    held = brought(GATE)
    with pytest.raises(tl.InputError, match=r"'own-gate' is taken by the gate in my\.py; choose another"):
        brought(GATE + "\n", "other.py")
    assert held.is_current


@pytest.mark.skipif(os.name == "nt", reason="others have no rights by these bits there")
@pytest.mark.parametrize("place", ["folder", "folder/my.py"])
def test_a_plugin_that_others_can_write_is_refused_before_it_runs(place, tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "my.py").write_text("raise SystemExit")
    (tmp_path / place).chmod(0o777)
    with pytest.raises(
        tl.InputError, match=rf"others can write {tmp_path / place}, and so decide what runs; chmod go-w"
    ):
        load_plugin(tmp_path / "folder" / "my.py")


BRANCHING = GATE.replace("    return amplified(F, kind.threshold)", "    return F if F.x > 0.0 else F * 0.5")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (BRANCHING, r"my\.py, line 24: pass_more\(\) branches on data: choose by where\(condition, a, b\)"),
        (GATE.replace("return Times(", "return missing("), r"gate 'own-gate' fails: my\.py, line 30: NameError"),
    ],
)
def test_a_law_that_cannot_be_traced_is_refused_with_its_line_and_what_is_allowed(text, said, brought):
    brought(text)
    mission = tl.load_mission("one-push", PUSH)
    with pytest.raises(tl.InputError, match=said):
        tl.fly(mission)
