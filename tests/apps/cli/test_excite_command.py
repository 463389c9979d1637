"""`tandemlift excite`: the file that it writes, and a room and a mission that it refuses."""

import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission


def run(*args):
    return CliRunner().invoke(cli, ["excite", *args], catch_exceptions=True)


def test_the_file_flies_and_the_promise_is_printed(tmp_path):
    path = tmp_path / "excited.toml"
    result = run("iris", "--time", "24", "--room", "1.5x1.5x1", "--out", str(path), "--set", "mission.seed=3")
    assert result.exit_code == 0, result.output
    mission = load_mission(path)
    assert mission.mission.seed == 3
    assert (mission.excitation.duration, mission.excitation.room) == (24.0, (1.5, 1.5, 1.0))
    for line in path.read_text("utf-8").split("\n\n")[0].splitlines()[:12]:
        assert line.removeprefix("# ") in result.output
    assert tl.fly(mission).outcome == "landed"


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["iris", "--room", "2 by 2"], "--room 2 by 2: must be three sizes in m"),
        (["iris", "--room", "2x2"], "room = "),
        (["paper"], "actuators.model"),
        (["iris", "--out", "mine.json"], "--out mine.json: must end in .toml"),
    ],
)
def test_what_it_cannot_do_is_refused_and_nothing_is_written(args, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*args)
    assert isinstance(result.exception, InputError)
    assert words in str(result.exception)
    assert not list(tmp_path.iterdir())
