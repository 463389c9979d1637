"""`tandemlift compare`: one mission, several controllers; a table, and numbers."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from as_toml import to_toml

import tandemlift as tl
from tandemlift.analysis.studies.comparison import Entry, MissionComparison, with_controllers
from tandemlift.analysis.studies.comparison_scores import controller_table
from tandemlift.flight.record import interruption
from tandemlift.parts.controllers import CONTROLLERS

SHORT = ("--set", "mission.duration=0.6")
WILD = ("lambda_1=0", "lambda_2=0", "xi=[4,2,11,0.1,0.1,0.1]")  # of nftsmc
TWO = ("--controllers", "nftsmc,pid")


def test_a_comparison_writes_numbers_and_prints_a_row_each(run, tmp_path):
    code, out, _ = run("compare", "hover", *TWO, *SHORT)
    folder = tmp_path / "out" / "hover"
    assert code == 0
    assert {path.name for path in folder.iterdir()} == {f"compare.{kind}" for kind in ("json", "csv", "tex")}
    assert [line.split()[0] for line in out.splitlines()[2:4]] == ["nftsmc", "pid"]
    assert "wall ns/step" in out.splitlines()[1]
    found = json.loads((folder / "compare.json").read_text("utf-8"), parse_constant=pytest.fail)
    assert [row["controller"] for row in found["controllers"]] == ["nftsmc", "pid"]
    flight = tl.fly(tl.load_mission("hover", {"mission.duration": 0.6}, controller="pid"))
    row = found["controllers"][1]
    assert row["metrics"]["position_rmse_m"] == flight.metrics()["position_rmse_m"]
    assert row["effort_n_m"] == pytest.approx(np.sqrt((flight["moment"] ** 2).sum(axis=1)).mean(), rel=1e-12)
    assert row["settings"] == flight.mission["controller"]


def test_a_controller_that_diverges_is_a_row_that_says_when_and_why(run, tmp_path):
    wild = [part for gain in WILD for part in ("--set", f"controller.gains.{gain}")]
    code, out, err = run("compare", "paper", *TWO, *wild, "--set", "mission.duration=40")
    assert code == 3
    assert re.search(r"nftsmc: diverged at 31\.2\S* s: distance", err)
    assert "pid:" not in err
    assert "diverged at" in out
    found = json.loads((tmp_path / "out" / "paper" / "compare.json").read_text("utf-8"))
    assert found["controllers"][0]["failure"].startswith("diverged at ")
    assert found["controllers"][1]["failure"] is None


@pytest.mark.parametrize(
    ("arguments", "pieces"),
    [
        (("hovr",), ["unknown mission 'hovr'", "Did you mean 'hover'?"]),
        (("hover", "--controllers", "pdi"), ["unknown controller 'pdi'", "Did you mean 'pid'?"]),
        (("hover", "--controllers", " , "), ["--controllers: must be a comma-separated list of names"]),
        (("hover", "--controllers", "absent.py"), ["absent.py does not exist"]),
        (("hover", "--engine", "compild"), ["unknown engine 'compild'"]),
        (("hover", "--set", "mission.step=0.5"), ["mission.step = 0.5"]),
        (("hover", "--set", "controller.nothing=1"), ["controller.nothing = 1: unknown key"]),
        (
            ("hover", "--controllers", "pid,nftsmc", "--set", "controller.velocity_i=1"),
            ["controller.velocity_i = 1: unknown key", "gives keys to nftsmc only, the controller of mission hover"],
        ),
    ],
    ids=" ".join,
)
def test_bad_input_is_refused_and_nothing_is_written(arguments, pieces, run, tmp_path):
    code, out, err = run("compare", *arguments)
    assert (code, out) == (2, "")
    assert "Traceback" not in err
    assert [piece for piece in pieces if piece not in err] == []
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_in_the_way_is_refused_before_the_flight(run, tmp_path, monkeypatch):
    (tmp_path / "taken" / "compare.json").mkdir(parents=True)
    monkeypatch.setattr("tandemlift.analysis.studies.comparison.fly_each", lambda *_, **__: pytest.fail("flown"))
    code, _, err = run("compare", "hover", "--out", "taken")
    assert code == 2
    assert "taken/compare.json is in the way" in err


def test_all_controllers_enter_by_default_the_mission_s_own_first_with_its_settings():
    entered = with_controllers("hover", {"controller.boundary_layer": 0.7, "mission.duration": 1.0}).entries
    assert [e.name for e in entered] == ["nftsmc", *sorted(CONTROLLERS.keys() - {"nftsmc"})]
    assert entered[0].mission.controller.boundary_layer == (0.7,) * 6
    for e in entered:
        assert (e.mission.mission.duration, e.mission.controller.name) == (1.0, e.name)


def test_a_controller_has_the_settings_of_the_mission_that_is_extended(tmp_path):
    """And one that lacks settings is refused alone: nobody else is kept from flying."""
    file = tmp_path / "mine.toml"
    file.write_text('extends = "hover"\n[controller]\nname = "pid"\nposition_p = 1.7\n')
    assert tl.load_mission(file).controller.position_p == (1.7,) * 3
    assert tl.load_mission(file, controller="nftsmc") == tl.load_mission("hover")
    assert tl.load_mission(file, controller="pid") == tl.load_mission(file)
    assert tl.load_mission(file, controller="smc") == tl.load_mission("hover", controller="smc")
    alone = tmp_path / "alone.toml"
    alone.write_text(to_toml(tl.load_mission(file)))
    entered = {e.name: e for e in with_controllers(str(alone), {}).entries}
    assert [name for name, e in entered.items() if e.mission is None] == ["nftsmc"]
    assert "controller.gains" in entered["nftsmc"].refusal
    with pytest.raises(tl.InputError, match=r"controller\.gains"):
        with_controllers(str(alone), {}, [CONTROLLERS["nftsmc"]])


def test_another_engine_flies_them_one_by_one(tmp_path):
    pytest.importorskip("mujoco")
    seen = []
    changes = {"mission.duration": 0.1}
    entered = with_controllers("hover", changes, [CONTROLLERS["pid"]], "mujoco")
    other = Entry("other", refusal="lacks everything")
    found = MissionComparison("controllers", [*entered.entries, other]).fly(lambda *done: seen.append(done))
    assert seen == [(1, 1)]
    assert found.entries[0].flight.version["engine"] == "mujoco"
    assert found.entries[1] == other


FAILING = '''
"""Fails in flight."""
from typing import NamedTuple
from tandemlift.parts.controllers import NoMemory, control, register
from tandemlift.parts.controllers import ControllerTable
class Gains(NamedTuple):
    """None."""
@control.register(Gains, compiled=False)
def fail(k, memory, measured, reference):
    """Fails."""
    return 1 / 0
class Settings(ControllerTable):
    """None."""
@register("failing", Settings)
def start(s, vehicle, step):
    """Fails in flight, whatever it is told."""
    return Gains(), NoMemory()
'''


def test_a_controller_of_one_s_own_that_fails_is_told_with_its_line(run, tmp_path):
    (tmp_path / "mine.py").write_text(FAILING)
    code, _, err = run("compare", "hover", "--controllers", "mine.py", *SHORT)
    assert code == 2
    assert "controller 'failing' fails: mine.py, line 11: ZeroDivisionError" in err


def test_long_flights_are_scored_after_ten_seconds_and_one_that_ended_before_does_not_change_that():
    missions = [tl.load_mission("hover", {"mission.duration": duration}) for duration in (11.0, 2.0)]
    long, short = (tl.fly(mission) for mission in missions)
    ended = replace(short, ending=interruption(2.0, "lost"))
    table = controller_table({"a": long, "b": ended})
    assert table.what == "position errors after 10 s"
    assert table.rows["a"][:3] == [f"{1e3 * value:.3f}" for value in long.metrics()["position_rmse_after_10s_m"]]
    assert table.rows["b"][:4] == [""] * 4
    table = controller_table({"a": long, "b": short})
    assert table.what == "position errors over the whole flight"
    assert table.rows["b"][3] == f"{1e3 * max(short.metrics()['position_max_error_m']):.3f}"
