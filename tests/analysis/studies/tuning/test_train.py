"""Training of a policy: a short one improves on persons that it never saw; bad input."""

import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.core.errors import InputError
from tandemlift.parts.interaction.policy import PolicyTable

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


def test_a_short_training_saves_other_persons_work_and_force(trained):
    assert trained.is_better
    work, force = trained.evidence.comparisons
    assert (work.label, force.label) == ("human_work_j", "human_force_mean_n")
    assert work.interval[1] < 0.0
    assert force.interval[1] < 0.0
    assert len(trained.holdout) >= 12
    assert not [draw for draw in trained.holdout if draw in trained.draws]
    assert trained.old == tuple(PolicyTable.zeros(1))


def test_what_was_trained_flies_as_a_file_and_trains_on(trained, tmp_path):
    mission = tl.load_mission(trained.save(tmp_path))
    assert mission.compliance.policy.model == "network"
    assert mission.compliance.policy.weights == trained.new
    again = tl.train(tmp_path / "tuned.toml", **{**SHORT, "budget": 0, "holdout": 2, "changes": {"person.delay": 0.2}})
    assert again.old == trained.new


def test_the_seed_gives_the_same_bits(trained):
    assert tl.train("iris", **SHORT, threads=1).as_table() == trained.as_table()


@pytest.mark.parametrize(
    ("mission", "how", "said"),
    [
        ("iris", {"changes": {}}, "mission 'iris' has no person"),
        ("hover", {"changes": {}}, 'must be "none" where pilot.guidance is "scheduled"'),
        ("iris", {"hidden": 0}, "--hidden 0: must be from 1 to 64"),
        ("iris", {"persons": 0}, "--persons 0: must be from 1 to"),
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
