"""Tuning as a whole, and training of a policy: a known best gain, evidence on holdout draws, files, and bad input."""

import itertools
import json
import math
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.analysis.studies.tuning.candidates import Cost, Trial, cost_of
from tandemlift.analysis.studies.tuning.draws import DrawSource, MissionSource, default_study
from tandemlift.analysis.studies.tuning.goals import Goal
from tandemlift.analysis.studies.tuning.result import EVIDENCE_FILE
from tandemlift.analysis.studies.tuning.task import Task
from tandemlift.apps.cli.main import cli
from tandemlift.core.errors import InputError
from tandemlift.parts.guidance.policy import PolicyTable
from tandemlift.pictures.report.study.tuning_figures import draw_search

STIFFNESS = 4.0  # 1/s²
DROP = {  # a mass that is let go 0.1 m above its reference, held by a spring and a damper
    "controller.position_stiffness": STIFFNESS,
    "controller.position_damping": 8.0,
    "initial.position": [0.0, 0.0, 0.1],
    "phases.height": 0.0,
    "mission.duration": 12.0,
    "mission.step": 0.005,
}
TWICE = {"study": {"name": "twice", "missions": ["hover"], "controllers": ["geometric"], "seeds": 2}}
QUICK = {"mission.duration": 3.0, "mission.step": 0.005, "initial.position": [0.0, 0.0, 0.1]}


def drop(**how):
    given = {"parameters": ["controller.position_damping.2"], "draws": TWICE, "holdout": 2, "budget": 120, **how}
    return tl.tune("hover", "position_rmse_m.2", changes=DROP, controller="geometric", **given)


def quick(**how):
    given = {"parameters": ["controller.gains.xi.2"], "draws": 2, "holdout": 6, "budget": 16, "changes": QUICK, **how}
    return tl.tune("hover", given.pop("goals", "position_rmse_m.2"), **given)


@pytest.fixture(scope="module")
def dropped():
    return drop()


def test_the_damping_of_least_error_is_the_root_of_the_stiffness(dropped):
    """∫e² dt = e₀² (d/2k + 1/2d) for e'' + d e' + k e = 0 from rest at e₀, which is least at d = √k."""
    (damping,) = dropped.new
    assert damping == pytest.approx(math.sqrt(STIFFNESS), rel=0.03)
    least = 0.1 * math.sqrt(0.5 / 12.0)  # m, of d/2k + 1/2d = 1/2 s over 12 s
    (found,) = dropped.evidence.comparisons
    assert found.new[0] == pytest.approx(least, rel=2e-3)
    assert found.old[0] == pytest.approx(0.1 * math.sqrt((1.0 + 1.0 / 16.0) / 12.0), rel=2e-3)
    assert dropped.is_better


def test_a_search_repeated_with_its_seed_gives_the_same_bits(dropped):
    assert json.dumps(drop(threads=1).as_table()) == json.dumps(dropped.as_table())


def test_a_mission_in_a_file_is_extended_by_its_path_and_lists_of_tables_are_written_whole(tmp_path):
    own = tmp_path / "own.toml"
    own.write_text("extends = 'hover'\n[actuators]\nmodel = 'rotors'\n", "utf-8")
    lag = {"vehicle.quadrotors.1.lag_up": [0.005, 0.05]}
    draws = {"study": {"name": "twice", "missions": [str(own)], "seeds": 2}}
    found = tl.tune(own, "position_rmse_m.2", parameters=lag, draws=draws, holdout=2, budget=8, changes=QUICK)
    path = found.save(tmp_path / "out")
    assert 'extends = "../own.toml"' in path.read_text("utf-8")
    assert tl.load_mission(path) == found.mission


def test_the_written_mission_is_the_one_that_was_found(dropped, tmp_path):
    path = dropped.save(tmp_path / "some" / "folder")
    loaded = tl.load_mission(path)
    assert loaded == dropped.mission
    assert loaded.controller.position_damping[2] == dropped.new[0]
    kept = json.loads((path.parent / EVIDENCE_FILE).read_text("utf-8"))
    assert kept["parameters"] == [
        {"key": "controller.position_damping.2", "old": 8.0, "new": dropped.new[0], **kept["parameters"][0]}
    ]
    assert kept["evidence"]["better"] is True
    assert len(kept["evidence"]["rows"]) == 2


def test_holdout_draws_are_none_of_the_search_and_old_and_new_fly_the_same_ones():
    found = quick()
    searched = {draw.changes["mission.seed"] for draw in found.draws}
    holdout = {draw.changes["mission.seed"] for draw in found.holdout}
    assert len(found.holdout) == len(holdout) == 6
    assert not searched & holdout
    again = tl.fly(tl.load_mission("hover", {**QUICK, **found.holdout[3].changes, **found.changes}))
    assert found.evidence.new.values[0][3, 0] == again.metrics()["position_rmse_m"][2]


@pytest.mark.parametrize(
    "changes",
    [
        {"plant.inertia_scale": (1.2, 1.0, 1.0)},
        {"plant.inertia_scale.0": 1.2},
        {"plant": {"inertia_scale": [1.2, 1.0, 1.0]}},
    ],
    ids=str,
)
def test_a_key_that_is_set_is_not_drawn_in_whatever_form_it_is_given(changes):
    source = MissionSource("hover", changes)
    draws = DrawSource(default_study(source, 2, seed=0), "hover", source.changes).search_draws()
    assert [set(draw.changes) for draw in draws] == [{"plant.mass_scale", "mission.seed"}] * 2


@pytest.mark.thorough
def test_a_bad_start_is_left_because_bad_outcomes_count_first():
    """From the paper's gains, with which the vehicle turns over on its rotors, to ones that fly."""
    paper = {key: getattr(tl.load_mission("paper").controller.gains, key) for key in ("xi", "lambda_1", "lambda_2")}
    changes = {f"controller.gains.{key}": value for key, value in paper.items()}
    changes |= {
        "initial.euler": [0.15, -0.15, 0.2],
        "actuators.model": "rotors",
        "actuators.delay": 0.02,
        "initial.position": [0.3, -0.3, 0.0],
    }
    found = tl.tune(
        "hover", "position_rmse_m", changes={**changes, "mission.duration": 6.0}, draws=2, holdout=4, budget=160
    )
    assert found.evidence.costs[0].bad == 4
    assert found.evidence.costs[1].bad == 0
    assert found.is_better
    assert "fewer bad outcomes" in found.evidence.words
    assert np.isnan(found.evidence.comparisons[0].difference)  # no draw went well with both


def test_findings_are_bad_outcomes_if_strict_and_several_goals_need_targets_where_all_flights_end_badly():
    """The start is farther from the reference than the mission promises."""
    far = {**QUICK, "promise.settling_time": 0.0, "promise.distance": 0.05}
    goals = {"position_rmse_m.2": 0.01, "attitude_rmse_rad": 0.1}
    lax, strict = (quick(goals=goals, changes=far, budget=0, strict=strict) for strict in (False, True))
    assert (lax.new, lax.changes, lax.is_better) == (lax.old, {}, False), "without candidates the present values stay"
    assert {found.improved for found in lax.evidence.comparisons} == {0.0}, "no difference is no improvement"
    assert lax.evidence.costs[0].bad == 0
    assert strict.evidence.costs[0].bad == 6
    assert set(strict.evidence.old.outcomes) == {"findings"}
    with pytest.raises(InputError, match="every draw ends badly, so several goals need targets"):
        quick(goals=list(goals), changes=far, budget=0, strict=True)


def test_the_worst_draw_counts_beside_the_mean_and_the_mean_beside_the_worst():
    """Draws with ratios (2, 2) and (1, 3) have the same mean, (3, 3) and (1, 3) the same worst."""

    def cost(*values, aim):
        column = np.array(values)[:, None]
        trial = Trial(("flying",) * 2, ("",) * 2, np.ones(2), ({},) * 2, (column * 0.5,))
        return cost_of(trial, [Goal("position_rmse_m.2")], [np.full((2, 1), 0.5)], aim)

    even, uneven, all_worst = ([cost(*v, aim=aim).ratio for aim in ("mean", "worst")] for v in ((2, 2), (1, 3), (3, 3)))
    assert even[0] < uneven[0] < all_worst[0]
    assert even[1] < uneven[1] < all_worst[1]
    for i, aim in enumerate(("mean", "worst")):  # of twice the values twice the cost
        assert cost(2, 6, aim=aim).ratio == pytest.approx(2.0 * uneven[i])


def test_costs_are_ordered_by_bad_outcomes_and_then_by_ratio_which_may_be_negative():
    costs = [Cost(bad, ratio) for bad in (0, 1) for ratio in (-1e6, -2.0, -1.0, -0.5, 0.0, 0.5, 1e6)]
    ranks = [cost.rank for cost in costs]
    assert all(low < high for low, high in itertools.pairwise(ranks))


def test_the_figure_of_a_search_shows_costs_below_zero(dropped):
    ratios = [-1.1, -0.9, -2.0]
    axes = draw_search(dropped._replace(history=tuple(Cost(0, ratio) for ratio in ratios))).axes[0]
    assert axes.lines[0].get_ydata().tolist() == ratios
    low, high = axes.get_xlim()
    assert low < 0.0 < 2.0 < high, "the dots of the first and the last candidate are whole"


def test_ctrl_c_keeps_the_best_so_far_and_writes_it_as_unfinished(tmp_path):
    def interrupt(tried, budget, lowest):
        if tried >= 16:
            raise KeyboardInterrupt

    found = quick(budget=80, progress=interrupt)
    assert not found.is_finished
    assert found.evidence is None
    assert len(found.history) == 17
    assert found.costs[1] == min(found.history, key=lambda cost: cost.rank)
    path = found.save(tmp_path)
    assert "unfinished" in path.read_text("utf-8")
    assert json.loads((tmp_path / EVIDENCE_FILE).read_text("utf-8"))["finished"] is False


@pytest.mark.thorough
def test_a_search_that_was_stopped_goes_on_in_its_folder_with_the_bits_of_one_that_was_not(tmp_path, monkeypatch):
    def interrupt(tried, budget, lowest):
        if tried >= 24:
            raise KeyboardInterrupt

    flown, fly = [], Task.fly_while_hopeful
    monkeypatch.setattr(Task, "fly_while_hopeful", lambda task, c, d: (flown.extend(c), fly(task, c, d))[1])
    whole = quick(budget=48).as_table()
    assert len(flown) == 48
    assert not quick(budget=48, folder=tmp_path, progress=interrupt).is_finished
    assert len(flown) == 48 + 24
    assert quick(budget=48, folder=tmp_path).as_table() == whole
    assert len(flown) == 48 + 48, "the 24 that had flown are not flown again"
    quick(budget=48, folder=tmp_path, seed=1)  # another search
    assert len(flown) == 48 + 48 + 48
    (tmp_path / EVIDENCE_FILE).write_text("[" * 9000)  # broken
    quick(budget=48, folder=tmp_path)
    assert len(flown) == 48 + 48 + 48 + 48


@pytest.mark.thorough
def test_what_a_search_had_found_is_on_disk_when_it_is_killed(tmp_path):
    """By SIGKILL, which no program can handle."""
    mission = tmp_path / "short.toml"
    sizes = "\n".join(f"{key} = {value}" for key, value in QUICK.items())
    mission.write_text(f'extends = "hover"\n{sizes}\n')
    words = ["--minimize", "position_rmse_m.2", "--parameter", "controller.gains.xi.2", "--draws", "2"]
    out = ["--out", str(tmp_path / "out"), "--holdout", "6"]
    run = [sys.executable, "-m", "tandemlift", "tune", str(mission), *words, *out]
    with subprocess.Popen([*run, "--budget", "100000"], stderr=subprocess.DEVNULL) as process:
        try:
            while process.poll() is None and not (tmp_path / "out" / "tuned.toml").exists():
                time.sleep(0.05)
        finally:
            process.kill()
    assert process.returncode == -signal.SIGKILL
    evidence = json.loads((tmp_path / "out" / EVIDENCE_FILE).read_text("utf-8"))
    tried, history = evidence["search"]["tried"], evidence["search"]["history"]
    assert (evidence["finished"], evidence["ended"]) == (False, "interrupted")
    assert len(tried) == len(history) >= 9
    best = min(range(len(history)), key=lambda i: Cost(*history[i]).rank)
    loaded = tl.load_mission(tmp_path / "out" / "tuned.toml")
    assert loaded.controller.gains.xi[2] == tried[best][0]
    done = subprocess.run([*run, "--budget", str(len(tried) - 1 + 8)], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    after = json.loads((tmp_path / "out" / EVIDENCE_FILE).read_text("utf-8"))
    assert after["search"]["tried"][: len(tried)] == tried
    assert after["finished"]


def test_cases_with_targets_are_measured_against_them(tmp_path):
    file = tmp_path / "scenes.toml"
    file.write_text(
        "study = {name = 'scenes', missions = ['hover']}\n"
        "[[cases]]\nname = 'light'\nset.plant.mass_scale = 0.99\ntargets.'position_rmse_m.2' = 0.002\n"
        "[[cases]]\nname = 'heavy'\nset.plant.mass_scale = 1.02\n",
        "utf-8",
    )
    found = quick(draws=file, holdout=3, budget=0, goals={"position_rmse_m.2": 0.01}, aim="worst")
    assert [draw.case for draw in found.draws] == ["light", "heavy"]
    assert found.task.scales[0][:, 0].tolist() == [0.002, 0.01]
    assert [draw.case for draw in found.holdout] == ["light", "light", "heavy", "heavy"]


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"goals": "position_rmse_m.3"}, "has 3 components"),
        ({"goals": "position_rmse_after_10s_m"}, "no flight has a number for it"),
        ({"goals": {"position_rmse_m": -1.0}}, "target must be a number > 0"),
        ({"goals": {"position_rmse_m": [1.0, 2.0]}}, "target has 2 numbers, the metric 3"),
        ({"goals": ()}, "needs a metric"),
        ({"goals": ["position_rmse_m", "position_rmse_m"]}, "is given twice"),
        ({"budget": 3}, "must be at least 8, which are tried at a time, or 0"),
        ({"draws": 0}, "must be from 1"),
        ({"aim": "best"}, "unknown aim 'best'"),
        ({"parameters": ["plant.mass_scale"]}, "the draws change plant.mass_scale"),
        ({"parameters": ["controller.switching"]}, "is not a number"),
        ({"drawz": 3}, "unknown argument of tune 'drawz'.*Did you mean 'draws'"),
    ],
    ids=str,
)
def test_bad_input_is_refused_with_what_is_allowed(how, words):
    with pytest.raises(InputError, match=words):
        quick(**how)


def test_a_study_of_another_mission_is_refused(tmp_path):
    file = tmp_path / "other.toml"
    file.write_text("study = {name = 'other', missions = ['one-push']}\n", "utf-8")
    with pytest.raises(InputError, match="must fly hover alone, compiled; it flies one-push"):
        quick(draws=file)


def test_a_study_that_sets_the_seed_has_no_holdout_draws(tmp_path):
    file = tmp_path / "fixed.toml"
    file.write_text(
        "study = {name = 'fixed', missions = ['hover'], draws = 4}\nset.mission.seed = 3\n"
        "draw.plant.mass_scale = {distribution = 'choice', among = [1.0, 1.01]}\n",
        "utf-8",
    )
    with pytest.raises(InputError, match=r"sets mission\.seed"):
        quick(draws=file)


LED = {  # straight ahead, without sensors; one delay, so that all flights have one compiled loop
    "pushes": [],
    "sensors.model": "none",
    "pilot.state": "truth",
    "pilot.push": "truth",
    "phases.lift_start": 0.5,
    "phases.lift_duration": 1.5,
    "person.model": "steer",
    "person.delay": 0.2,
    "person.start_time": 2.0,
    "person.path": [{"point": [6.0, 0.0]}],
    "mission.duration": 8.0,
    "mission.step": 0.005,
}
SHORT = {"hidden": 1, "persons": 2, "holdout": 12, "budget": 32, "changes": LED}


@pytest.fixture(scope="module")
def trained():
    return tl.train("iris", **SHORT)


@pytest.mark.thorough
def test_a_short_training_saves_other_persons_work_and_force(trained):
    assert trained.is_better
    work, force = trained.evidence.comparisons
    assert (work.label, force.label) == ("human_work_j", "human_force_mean_n")
    assert work.interval[1] < 0.0
    assert force.interval[1] < 0.0
    assert len(trained.holdout) >= 12
    assert not [draw for draw in trained.holdout if draw in trained.draws]
    assert trained.old == tuple(PolicyTable.zeros(1))


@pytest.mark.thorough
def test_what_was_trained_flies_as_a_file_and_trains_on(trained, tmp_path):
    mission = tl.load_mission(trained.save(tmp_path))
    assert mission.compliance.policy.model == "network"
    assert mission.compliance.policy.weights == trained.new
    again = tl.train(tmp_path / "tuned.toml", **{**SHORT, "budget": 0, "holdout": 2, "changes": {"person.delay": 0.2}})
    assert again.old == trained.new


@pytest.mark.parametrize(
    ("mission", "how", "said"),
    [
        ("iris", {"changes": {}}, "mission 'iris' has no person"),
        ("hover", {"changes": {}}, 'must be "none" where pilot.guidance is "scheduled"'),
        ("iris", {"hidden": 0}, "--hidden 0: must be from 1 to 64"),
        ("iris", {"aim": "worst"}, "argument of train"),
    ],
    ids=str,
)
def test_bad_input_is_refused(mission, how, said):
    with pytest.raises(InputError) as refused:
        tl.train(mission, **{**SHORT, **how})
    assert said in str(refused.value)


def test_the_command_refuses_bad_input_and_writes_nothing(tmp_path):
    result = CliRunner().invoke(cli, ["train", "zigzag", "--hidden", "0", "--out", str(tmp_path / "out")])
    assert "--hidden 0" in str(result.exception)
    assert not (tmp_path / "out").exists()
