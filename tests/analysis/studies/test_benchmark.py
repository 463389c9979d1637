"""The benchmark against other readers of its data, identities, closed forms, and bad entries."""

import copy
import itertools
import math
import re

import benchmark_folder
import numpy as np
import pyarrow.parquet as pq
import pytest
from click.testing import CliRunner
from repository import ROOT

import tandemlift as tl
from tandemlift.analysis.studies import benchmark
from tandemlift.analysis.studies.benchmark_columns import TABLES, csv_of, json_of, lines_of, rms
from tandemlift.analysis.studies.benchmark_entry import (
    KINDS,
    BenchmarkEntry,
    baselines,
    checked_folder,
    entry_of,
)
from tandemlift.apps.cli.main import cli
from tandemlift.core.errors import InputError

LIMITS = (ROOT / "evidence" / "certified_random_missions.csv").read_text("utf-8").splitlines(keepends=True)[:30]
HYBRID = """
from tandemlift.core.plugs import PLUGS, plug

plug("observer", "own-hybrid")(lambda *known: PLUGS["observer"]["hybrid"].start(*known))
"""
NAMES = ("roll (N m)", "pitch (N m)", "yaw (N m)")
TASKS, COLUMNS = benchmark.tasks, benchmark.TABLES  # as they are
LAW = (ROOT / "examples" / "observers" / "own_law.py").read_text("utf-8")
CONTROLLER = (ROOT / "examples" / "my_controller.py").read_text("utf-8").replace("my-pd", "entry-pd")


@pytest.fixture(scope="module", autouse=True)
def tiny():
    """The tasks with a few seconds of flight."""
    tables = benchmark.tasks()
    tables["observers"] = {"pushes": tables["observers"]["pushes"]}
    tables["observers"]["pushes"]["cases"] = tables["observers"]["pushes"]["cases"][:2]
    tables["controllers"] = {name: tables["controllers"][name] for name in ("tracking", "corridor")}
    for kind, task, seconds in (
        ("observers", "pushes", 24.0),
        ("controllers", "tracking", 3.0),
        ("policies", "persons", 14.0),
    ):
        tables[kind][task]["set"].setdefault("mission", {})["duration"] = seconds
        tables[kind][task]["quick"] = {}
    tables["controllers"]["tracking"]["study"]["seeds"] = 1
    tables["controllers"]["corridor"] |= {"quick": {"study.draws": 1, "set.mission.duration": 12.0}}
    tables["policies"]["persons"]["study"]["draws"] = 2
    columns = {kind: tuple(c for c in TABLES[kind] if c.task in tables[kind]) for kind in KINDS}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(benchmark, "tasks", lambda: copy.deepcopy(tables))
        patch.setattr(benchmark_folder, "tasks", benchmark.tasks)
        patch.setattr(benchmark, "TABLES", columns)
        yield columns


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """The folder, made twice."""
    made = [tmp_path_factory.mktemp("data") for _ in range(2)]
    limits = tmp_path_factory.mktemp("limits") / "limits.csv"
    limits.write_text("".join(LIMITS), "utf-8")
    for folder in made:
        benchmark_folder.write_folder(folder, limits, quick=True)
    return made


@pytest.fixture(scope="module")
def scored(tmp_path_factory):
    """Rows of observers: built-in ones, and those of files."""
    here = tmp_path_factory.mktemp("entries")
    (here / "own_hybrid.py").write_text(HYBRID)
    (here / "own_law.py").write_text(LAW)
    entries = {one.name: one for one in baselines("observers") if one.name in ("hybrid", "kalman", "momentum", "zero")}
    entries |= {name: entry_of(here / f"{name}.py") for name in ("own_hybrid", "own_law")}
    again = entries["momentum"]._replace(name="momentum again")
    entries |= {again.name: again}
    return {name: benchmark.scores_of(entry, quick=True) for name, entry in entries.items()}


@pytest.mark.thorough
def test_a_folder_made_twice_has_the_same_bits(folders):
    first, second = ((folder / "SHA256SUMS").read_text() for folder in folders)
    assert first == second
    assert checked_folder(folders[0]) == len(first.splitlines()) == 12


@pytest.mark.thorough
def test_a_reader_of_parquet_alone_gets_the_numbers_of_the_baseline(folders, scored):
    table = pq.read_table(folders[0] / "observers" / "test.parquet")
    for axis in "xyz":
        estimate, force, used = (
            table[name].to_numpy().astype(float)
            for name in (f"push_estimate_{axis}", f"push_force_{axis}", "push_usable")
        )
        case = np.array(table["case"].to_pylist())[used > 0]
        error = (estimate - force)[used > 0]
        of_cases = [np.mean(error[case == name] ** 2) for name in dict.fromkeys(case)]
        assert len(of_cases) == 2
        assert math.sqrt(np.mean(of_cases)) == pytest.approx(scored["kalman"][f"F {axis} (N)"], rel=2e-4)


@pytest.mark.thorough
def test_the_card_describes_every_column(folders):
    known = [name.strip() for key in benchmark_folder.MEANINGS for name in key.split(",")]
    for file in sorted(folders[0].rglob("*.parquet")):
        if file.name != "missions.parquet":  # whose columns are keys of missions
            strange = [name for name in pq.read_schema(file).names if not name.startswith(tuple(known))]
            assert strange == [], file
            assert f"`{file.relative_to(folders[0]).as_posix()}`" in (folders[0] / "README.md").read_text()


@pytest.mark.thorough
def test_the_reader_has_ten_lines_and_reads(folders, capsys, monkeypatch):
    assert len(benchmark_folder.READER.splitlines()) <= 12
    monkeypatch.setattr("sys.argv", ["read.py", str(folders[0])])
    exec(benchmark_folder.READER, {})
    assert "nominal" in capsys.readouterr().out


def test_a_folder_with_another_or_a_missing_file_is_refused_by_its_name(folders):
    file = folders[1] / "certificate" / "limits.parquet"
    file.write_bytes(file.read_bytes()[:-1] + b"?")
    with pytest.raises(InputError, match=r"limits\.parquet: is not the file of the benchmark"):
        checked_folder(folders[1])
    file.unlink()
    with pytest.raises(InputError, match=r"limits\.parquet: is missing"):
        checked_folder(folders[1])
    with pytest.raises(InputError, match="SHA256SUMS"):
        checked_folder(folders[1] / "certificate")


@pytest.mark.thorough
def test_an_own_law_flies_in_place_of_a_built_in_one(scored):
    assert scored["own_hybrid"] == scored["hybrid"]  # the same observer, by a file
    assert scored["own_law"] != scored["momentum"] == scored["momentum again"]  # which is back after it
    assert scored["own_law"]["delay (ms)"] > scored["hybrid"]["delay (ms)"]  # 12 rad/s, 20 rad/s


@pytest.mark.thorough
def test_an_observer_without_a_moment_no_longer_wins_and_one_that_says_nothing_is_in_the_table(scored):
    """`own_law` gives no moment. What is missed by zero is the push itself: sums over its Gaussians in the 12 s."""
    for axis in ("roll", "pitch", "yaw"):
        best = min(scored[name][f"M {axis} (N m)"] for name in ("kalman", "hybrid", "momentum"))
        assert best < 0.8 * scored["own_law"][f"M {axis} (N m)"]
    for axis, peak, sigma in (("x", 3.0, 0.6), ("z", 1.5, 0.5)):
        square = peak**2 * sigma * math.sqrt(math.pi) * (1.0 if axis == "z" else 0.5 * (1.0 + math.erf(2.0 / sigma)))
        assert scored["zero"][f"F {axis} (N)"] == pytest.approx(math.sqrt(square / (24.0 - 12.0)), rel=0.01)
    assert scored["zero"]["delay (ms)"] is None, "0 ms by least squares, since nothing is estimated"


@pytest.mark.parametrize("quick", [True, False])
def test_zero_is_the_worst_of_the_shipped_rows_in_every_error(quick):
    rows = benchmark.shipped_tables(quick=quick)["observers"]
    for title in (f"{c} {n}" for c, n in zip("FFFMMM", ("x (N)", "y (N)", "z (N)", *NAMES), strict=True)):
        others = [row[title] for name, row in rows.items() if name != "zero"]
        assert rows["zero"][title] > 1.5 * max(others), title


def test_the_tables_fit_a_terminal_of_80_columns_whatever_the_names_and_lose_no_number():
    for kind in KINDS:
        rows = {**benchmark.shipped_tables()[kind], "m" * 90: next(iter(benchmark.shipped_tables()[kind].values()))}
        for own in ("", "m" * 90):
            lines = lines_of(kind, rows, own)
            assert max(map(len, lines)) <= 80
            cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]
            shown = {name for row in cells if row and row[0] == kind for name in row[1:]}
            assert shown == {*rows} - {"m" * 90} | {"m" * 23 + "…"}


@pytest.mark.thorough
def test_a_function_has_the_errors_that_the_flight_has_of_the_same_estimate():
    """Channels have moments about the system's centre of mass, the metric is about the payload's."""
    changes = {"estimator.wrench": "kalman", "estimator.error_metrics": True, "mission.log_interval": 0.001}
    flight = tl.fly(tl.load_mission("iris", {**changes, "mission.duration": 18.0}))
    both = np.hstack([flight["push_estimate"], flight["push_moment_estimate"]])
    found = benchmark.of_function(lambda table: both[: len(table)], flight)
    for name in ("push_force_rmse_n", "push_moment_rmse_n_m", "push_delay_s"):
        assert found[name] == pytest.approx(flight.metrics()[name], rel=1e-3)


BRANCHING = LAW.replace("    force = m", "    if x.dt > 1:\n        return 0\n    force = m")
STEERED = "    if state.position.x > 0:\n        w = w * 2\n    e, de"
REFUSED = {  # a file: its text, and the words of its refusal
    "asks.py": ("def observer(table): return table['push_force_x']", "asks for 'push_force_x'; it gets time, "),
    "shape.py": ("def observer(table): return table[['time']].to_numpy()", r"of the shape \(\d+, 3\) or"),
    "future.py": (
        "def observer(table): return [list(table.filter(regex='^measured_velocity').iloc[-1])] * len(table)",
        "is not causal",
    ),
    "raises.py": ("def observer(table):\n    return table + unknown", "line 2: NameError"),
    "none.py": ("x = 1", "holds no entry"),
    "joints.py": ("def observer(table): return table", "a baseline has this name"),
    "both.py": (f"{CONTROLLER}\ndef observer(table): return 0", "the controller 'entry-pd' and an observer"),
    "broken.py": ("x = (", "line 1: SyntaxError"),
    "branches.py": (BRANCHING.replace("low-pass", "branching"), "branches on data"),
    "grows.py": (
        LAW.replace("Memory(force)\n", "Memory(force.x)\n").replace("low-pass", "growing"),
        "must keep its layout",
    ),
    "cannot.py": (CONTROLLER.replace("    e, de", STEERED).replace("entry", "other"), r"line \d+"),
    "flight.npz": ("", "an entry is"),
    "mission.toml": ("[mission]\nname = 'x'", r"no weights in \[compliance\.policy\]"),
    "short.toml": ("[compliance.policy]\nweights = [1.0, 2.0]", "has 2 numbers: must be 9 H"),
    "broken.toml": ("[", ""),
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", REFUSED)
def test_an_entry_that_cannot_be_scored_is_named_with_its_reason(tmp_path, name):
    text, words = REFUSED[name]
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=rf"{re.escape(name)}(?s:.)*{words}"):
        benchmark.scores_of(entry_of(tmp_path / name), quick=True)


@pytest.mark.thorough
def test_a_controller_file_is_scored_as_the_same_controller_by_name(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(CONTROLLER.replace("entry-pd", "scored-pd"))
    entry = entry_of(file)
    assert entry.kind == "controllers"
    row = benchmark.scores_of(entry, quick=True)
    assert row == benchmark.scores_of(BenchmarkEntry("controllers", "again", {}, str(file)), quick=True)
    assert row["through (%)"] == 0.0  # in 12 s
    assert row["work (J)"] is None


@pytest.mark.thorough
def test_a_policy_with_weights_of_zero_is_the_admittance_alone(tmp_path):
    file = tmp_path / "tuned.toml"
    file.write_text(f"[compliance.policy]\nweights = {[0.0] * 11}")
    mine, alone = (benchmark.scores_of(one, quick=True) for one in (entry_of(file), baselines("policies")[0]))
    assert mine == pytest.approx(alone, rel=1e-4)


def test_the_smallest_push_is_the_last_before_one_that_is_followed_late():
    time = np.arange(0.0, benchmark.FIRST_PUSH + benchmark.PUSH_SPACING * 4 * len(benchmark.FORCES) + 1.0, 0.004)

    def flight_that_takes(seconds):
        """Of a flight that follows a push after `seconds(force)`."""
        active = np.zeros((len(time), 3))
        places = itertools.product(benchmark.FORCES, range(4))
        for n, (force, way) in enumerate(places):
            begin = benchmark.FIRST_PUSH + benchmark.PUSH_SPACING * n + seconds(force)
            active[(time >= begin) & (time < begin + 0.5), way % 2] = 1.0
        return tl.Flight(time, {"push_active": active}, {}, {})

    assert benchmark.smallest_push(flight_that_takes(lambda force: 0.02)) == {"smallest_push_n": benchmark.FORCES[-1]}
    assert benchmark.smallest_push(flight_that_takes(lambda force: 0.1)) == {"smallest_push_n": math.inf}
    found = benchmark.smallest_push(flight_that_takes(lambda force: 0.05 / force))["smallest_push_n"]
    assert 0.05 / found < benchmark.FOLLOW_TIME < 0.05 / (found / 1.2)


def test_steps_of_pushes_have_their_force():
    first = [p for p in benchmark.steps_of_pushes() if p["time"] < benchmark.FIRST_PUSH + benchmark.PUSH_SPACING]
    at = benchmark.FIRST_PUSH + 0.5 * benchmark.PUSH_TIME
    force = sum(p["force"][0] * math.exp(-0.5 * ((at - p["time"]) / p["sigma"]) ** 2) for p in first)
    assert force == pytest.approx(benchmark.FORCES[0], rel=1e-3)
    assert rms([3.0, 4.0]) == pytest.approx(math.sqrt(12.5))


@pytest.mark.thorough
def test_a_baseline_flown_again_has_the_numbers_that_ship(monkeypatch):
    monkeypatch.setattr(benchmark, "tasks", TASKS)
    monkeypatch.setattr(benchmark, "TABLES", COLUMNS)
    entry = baselines("policies")[0]
    assert benchmark.scores_of(entry, quick=True) == benchmark.shipped_tables(quick=True)["policies"][entry.name]


@pytest.mark.parametrize("kind", KINDS)
def test_every_task_can_be_planned_for_every_baseline(monkeypatch, kind):
    """A key that a study draws must act in its missions: the draws once had a wind without `wind.model`."""
    monkeypatch.setattr(benchmark, "tasks", TASKS)
    for entry in baselines(kind):
        for task in {column.task for column in COLUMNS[kind]}:
            assert benchmark.plan_of(entry, task, quick=False).count >= 1


@pytest.mark.parametrize("quick", [True, False])
def test_the_tables_that_ship_have_all_baselines_and_columns(quick):
    tables = benchmark.shipped_tables(quick=quick)
    for kind in KINDS:
        assert list(tables[kind]) == [one.name for one in baselines(kind)]
        assert all(list(row) == [column.title for column in TABLES[kind]] for row in tables[kind].values())


@pytest.mark.thorough
def test_the_command_prints_the_row_beside_the_baselines(tmp_path):
    (tmp_path / "own_law.py").write_text(LAW)
    out = tmp_path / "out"
    done = CliRunner().invoke(cli, ["benchmark", str(tmp_path / "own_law.py"), "--quick", "--out", str(out)])
    assert done.exit_code == 0, done.output
    lines = done.output.splitlines()
    assert max(map(len, lines)) <= 80
    heads = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("| observers")]
    assert all(head[:2] == ["observers", "own_law"] for head in heads), "the entry is beside all baselines"
    assert [name for head in heads for name in head[2:]] == [one.name for one in baselines("observers")]
    text = (out / "scores.csv").read_text()
    assert text.startswith("kind,name,column,value\n")
    assert "observers,own_law,delay (ms)," in text
    assert (out / "scores.json").read_text().endswith("}\n")


def test_numbers_are_written_so_that_they_are_read_as_they_are():
    tables = {"policies": {"a": {"work (J)": 0.1, "force (N)": None}}}
    assert csv_of(tables).splitlines()[1:] == ["policies,a,work (J),0.1", "policies,a,force (N),NaN"]
    assert '"work (J)": 0.1' in json_of(tables)
