"""`tandemlift compare`: one mission, several controllers or engines; a table, numbers, and how far apart."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from as_toml import to_toml
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.analysis.studies.comparison import in_engines, with_controllers
from tandemlift.analysis.studies.comparison_scores import controller_table, differences, largest_differences
from tandemlift.core.errors import InputError
from tandemlift.flight.record import interruption
from tandemlift.missions import tables_of
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
        (("hover", "--controllers", "pdi"), ["unknown controller 'pdi'", "Did you mean 'pid'?"]),
        (("hover", "--controllers", " , "), ["--controllers: must be a comma-separated list of names"]),
        (("hover", "--controllers", "absent.py"), ["absent.py does not exist"]),
        (("hover", "--engine", "compild"), ["unknown engine 'compild'"]),
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


pytest.importorskip("mujoco")
BRIEF = {"mission.duration": 2.0}


def made(seed, count=50, **channels):
    """A flight of chance, with some channels as given."""
    rng = np.random.default_rng(seed)
    attitude = Rotation.random(count, rng=rng).as_quat(scalar_first=True)
    own = {"position": rng.normal(size=(count, 3)), "attitude": attitude, "joint_force": rng.normal(size=(count, 2, 3))}
    return tl.Flight(0.01 * np.arange(count), own | channels, tables_of(tl.load_mission("paper")), {})


def test_attitudes_are_apart_by_the_angle_of_the_rotation_between_them():
    a, b = made(1), made(2)
    between = Rotation.from_quat(a["attitude"], scalar_first=True).inv() * Rotation.from_quat(
        b["attitude"], scalar_first=True
    )
    assert differences(a, b)["attitude"] == pytest.approx(between.magnitude())
    other = made(1, attitude=-a["attitude"])  # the same attitudes
    assert largest_differences(a, other)["attitude"] == 0.0


def test_a_known_difference_is_found_and_joints_are_looked_at_once_settled():
    a = made(3)
    moved, force = a["position"].copy(), a["joint_force"].copy()
    moved[20] += [0.3, 0.4, 0.0]
    force[5, 1, 2] += 7.0  # at 0.05 s
    force[30, 0, 1] -= 0.25
    found = largest_differences(made(3, position=moved, joint_force=force), a)
    assert found["position"] == pytest.approx(0.5)
    assert found["joint_force"] == pytest.approx(0.25)
    assert "push_estimate" not in found


def test_a_flight_that_ended_early_is_compared_as_far_as_it_came():
    a, b = made(4), made(4)
    short = tl.Flight(b.time[:20], {n: v[:20] for n, v in b.channels.items()}, b.mission, {})
    assert largest_differences(short, a) == {"position": 0.0, "attitude": 0.0, "joint_force": 0.0}


def test_a_mission_is_flown_in_each_engine_and_the_numbers_say_so(run, tmp_path):
    code, printed, _ = run(
        "compare", "paper", "--engines", "compiled,mujoco", "--set", "mission.duration=2.0", "--out", "o"
    )
    assert code == 0
    assert sorted(p.name for p in (tmp_path / "o").iterdir()) == [*("engines.csv", "engines.json", "engines.tex")]
    found = json.loads((tmp_path / "o/engines.json").read_text("utf-8"))
    assert [row["engine"] for row in found["engines"]] == ["compiled", "mujoco"]
    a, b = (tl.fly(tl.load_mission("paper", BRIEF), engine) for engine in ("compiled", "mujoco"))
    most = np.linalg.norm(a["position"] - b["position"], axis=1).max()
    assert 0.0 < most < 1e-6  # m
    assert found["engines"][1]["difference"]["position"] == pytest.approx(most)
    assert set(found["engines"][0]["difference"].values()) == {0.0}
    assert f"{most:.1e}" in printed


@pytest.mark.parametrize(
    ("arguments", "pieces"),
    [
        (["--engines", "compiled,mujco"], ["unknown engine 'mujco'", "'mujoco'"]),
        (["--engines", "mujoco"], ["must be two or more"]),
        (["--engines", ","], ["--engines: must be a comma-separated list of names"]),
        (["--engines", "compiled,mujoco", "--controllers", "pid"], ["give only one of them"]),
    ],
    ids=["an unknown one", "one alone", "none", "controllers too"],
)
def test_bad_engines_are_refused_and_nothing_is_written(arguments, pieces, run, tmp_path):
    code, _, said = run("compare", "paper", *arguments)
    assert code == 2
    assert [piece for piece in pieces if piece not in said] == []
    assert list(tmp_path.iterdir()) == []


def test_an_engine_may_not_be_named_twice():
    with pytest.raises(InputError, match="without repetition"):
        in_engines(tl.load_mission("paper", BRIEF), ["compiled", "compiled"])
