"""The challenge: flights by hand through a corridor, handed in, flown again and ranked."""

import json
import os
import re
import shutil
import zipfile

import numpy as np
import pytest
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.analysis.studies.corridor_score import count_touches, log_dimensionless_jerk, score_of
from tandemlift.apps.cli.main import cli
from tandemlift.apps.live.session.challenge import write_score
from tandemlift.apps.live.session.interactive_mission import interactive_mission
from tandemlift.core.vector import Vec3
from tandemlift.parts.person.virtual_hand import HAND_RELEASED
from tandemlift.simulation.recorded_flight import RecordedFlight

MISSION = """
extends = "hover"
[pilot]
guidance = "interactive"
[phases]
rotors = "flight"
[ground]
model = "floor"
[compliance]
yaw.model = "compliant"
[corridor]
centreline = [[-1.0, 0.0], [0.5, 0.0], [1.0, 0.2]]
width = 4.0
"""


def pulled(challenge, force, seconds):
    """A flight that is pulled through the corridor by a force [N] from 6 s on."""
    flight = RecordedFlight(interactive_mission(challenge))
    while flight.step * flight.dt < seconds:
        if abs(flight.step * flight.dt - 6.0) < 0.5 * flight.dt:
            flight.hold(HAND_RELEASED._replace(force=Vec3(*force)))
        flight.advance()
    return flight.snapshot()


@pytest.fixture(scope="module")
def handed_in(tmp_path_factory):
    """The challenge, and the folders of two participants who finished and one who went astray."""
    place = tmp_path_factory.mktemp("challenge")
    mission = place / "class.toml"
    mission.write_text(MISSION)
    challenge = tl.load_mission(mission)
    forces = {"anna": (1.5, 0.0, 0.0), "bert": (1.0, 0.0, 0.0), "carl": (0.8, 0.0, 2.0)}
    for name, force in forces.items():
        flight = pulled(challenge, force, 11.0).save(place / "in" / name)
        write_score(flight, place / "in" / name)
    return place


def run(*args):
    result = CliRunner().invoke(cli, ["score", *map(str, args)])
    return result.exit_code, result.output, str(result.exception or "")


@pytest.mark.thorough
def test_the_quicker_one_wins_and_who_left_the_corridor_is_refused_with_the_time(handed_in):
    code, said, _ = run(handed_in / "in", "--mission", handed_in / "class.toml")
    head, first, second, refused = said.splitlines()
    assert head.split() == ["rank", "name", "score", "time", "touches", "effort", "jerk"]
    assert (first.split()[:2], second.split()[:2]) == (["1", "anna"], ["2", "bert"])
    assert "carl" in refused
    assert "left the corridor at" in refused
    assert code == 3
    written = json.loads((handed_in / "in" / "anna" / "score.json").read_text())
    assert f"{written['score']:.1f}" == first.split()[2]
    assert 0.9 < written["effort"] / (1.5 * written["time"]) <= 1.0  # the hand lags
    assert not (handed_in / "in" / "carl" / "score.json").exists()


@pytest.mark.parametrize(
    ("file", "old", "new", "reason"),
    [
        ("score.json", None, '{"score": 1.0}', "score.json says 1.00 s, but the recording flies"),
        ("score.json", None, "{}", "is no score"),
        ("recorded.toml", "width = 4.0", "width = 5.0", "corridor.width = 5.0: the challenge has 4.0"),
    ],
)
def test_what_was_edited_is_refused_by_its_name(handed_in, tmp_path, file, old, new, reason):
    shutil.copytree(handed_in / "in" / "anna", tmp_path / "anna")
    path = tmp_path / "anna" / file
    path.write_text(path.read_text().replace(old, new) if old else new)
    code, said, _ = run(tmp_path, "--mission", handed_in / "class.toml")
    assert code == 3
    assert reason in said


def test_what_participants_may_change_is_free(handed_in, tmp_path):
    challenge = tl.load_mission(handed_in / "class.toml", {"admittance.damping": 1.0})
    pulled(challenge, (1.0, 0.0, 0.0), 10.0).save(tmp_path / "dora-4.5s")
    code, said, _ = run(tmp_path, "--mission", handed_in / "class.toml")
    assert code == 3
    assert "dora-4.5s refused: admittance.damping = " in said
    code, said, _ = run(tmp_path, "--mission", handed_in / "class.toml", "--free", "admittance")
    assert code == 0
    assert said.splitlines()[1].split()[:2] == ["1", "dora-4.5s"]


@pytest.mark.thorough
def test_a_file_of_a_page_without_a_server_is_ranked_although_it_rounds_in_its_own_way(handed_in, tmp_path):
    challenge = tl.load_mission(handed_in / "class.toml", {"mission.fma": False})  # as in `page_modules.page_mission`
    pulled(challenge, (1.5, 0.0, 0.0), 9.0).save(tmp_path / "saved")
    (tmp_path / "in").mkdir()
    with zipfile.ZipFile(tmp_path / "in" / "emil-3.1s.zip", "w") as archive:
        for name in ("recorded.toml", "hand.npz"):
            archive.write(tmp_path / "saved" / name, name)
    code, said, _ = run(tmp_path / "in", "--mission", handed_in / "class.toml")
    assert (code, said.splitlines()[1].split()[:2]) == (0, ["1", "emil-3.1s"])


def test_a_zip_with_another_score_a_copy_another_mission_and_other_files_are_told(handed_in, tmp_path):
    place = tmp_path / "in"
    shutil.copytree(handed_in / "in" / "anna", place / "anna")
    shutil.copytree(handed_in / "in" / "anna", place / "mallory")
    (place / "notes.txt").write_text("late")
    with zipfile.ZipFile(place / "oscar.zip", "w") as archive:
        for name in ("recorded.toml", "hand.npz"):
            archive.write(handed_in / "in" / "bert" / name, name)
        archive.write(handed_in / "in" / "anna" / "score.json", "score.json")
    _, said, _ = run(place, "--mission", handed_in / "class.toml")
    anna, mallory, oscar, notes = said.splitlines()[1:]
    assert anna.endswith("same recording as mallory")
    assert mallory.endswith("same recording as anna")
    assert "score.json says" in oscar
    assert "notes.txt: is no saved flight" in notes
    assert "flew another corridor than that of zigzag" in run(place)[1]


def _link(path, target):
    path.unlink()
    path.symlink_to(target)


ATTACKS = {  # of a participant: how it is made of a good flight, and words of its refusal
    "nested": (lambda place: (place / "score.json").write_text("[" * 200_000), "at most 10,000 bytes"),
    "deep": (lambda place: (place / "score.json").write_text("[" * 9_000), "score.json is no score"),
    "large": (lambda place: (place / "score.json").write_bytes(b" " * 64_000_000), "at most 10,000 bytes"),
    "digits": (lambda place: (place / "score.json").write_text('{"score": 1' + "0" * 400 + "}"), "is no score"),
    "nan": (lambda place: (place / "score.json").write_text('{"score": NaN}'), "score.json is no score"),
    "bytes": (lambda place: (place / "score.json").write_bytes(b"\xff\xfe"), "score.json is no score"),
    "folder": (lambda place: [(place / "score.json").unlink(), (place / "score.json").mkdir()], "score.json must be"),
    "device": (lambda place: _link(place / "score.json", "/dev/zero"), "score.json must be a file"),
    "pipe": (lambda place: [(place / "score.json").unlink(), os.mkfifo(place / "score.json")], "score.json must be"),
    "hand": (lambda place: _link(place / "hand.npz", "/dev/zero"), "hand.npz must be a file"),
    "elsewhere": (
        lambda place: _edit(place / "recorded.toml", 'recording = "hand.npz"', 'recording = "/dev/zero"'),
        "has no recording of a hand",
    ),
    "long": (
        lambda place: _edit(place / "recorded.toml", r"(?s)(\[mission\].*?\nduration = )\S+", r"\g<1>1e4"),
        "at most 3600 s",
    ),
    "toml": (lambda place: (place / "recorded.toml").write_text("x = " + "[" * 200_000), "cannot be read"),
    "text": (lambda place: (place / "recorded.toml").write_bytes(b"\xff"), "cannot be read"),
}


def _edit(path, old, new):
    text, count = re.subn(old, new, path.read_text())
    assert count == 1
    path.write_text(text)


def test_whatever_a_participant_hands_in_is_named_and_the_others_are_ranked(handed_in, tmp_path):
    place, good = tmp_path / "in", handed_in / "in" / "anna"
    for name, (attack, _) in ATTACKS.items():
        shutil.copytree(good, place / name)
        attack(place / name)
    with zipfile.ZipFile(place / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as archive:  # 64 MB in 64 kB
        for file in ("recorded.toml", "hand.npz"):
            archive.write(good / file, file)
        archive.writestr("score.json", b"0" * 64_000_000)
    (place / "broken.zip").write_bytes((place / "bomb.zip").read_bytes()[:-40])
    shutil.copytree(good, place / "zoe")
    code, said, error = run(place, "--mission", handed_in / "class.toml")
    assert (code, error) == (3, "3")
    rows = {line.split()[1]: line for line in said.splitlines()[1:]}
    assert rows.keys() == {*ATTACKS, "bomb", "broken", "zoe"}
    assert rows["zoe"].split()[0] == "1"
    for name, (_, reason) in {**ATTACKS, "bomb": (None, "at most 10,000 bytes"), "broken": (None, "")}.items():
        assert re.search(f"refused: .*{reason}", rows[name]), rows[name]


def test_a_folder_without_flights_and_a_mission_without_a_corridor_are_refused(tmp_path):
    assert "must hold flights that a page saved" in run(tmp_path)[2]
    assert "there is no such folder" in run(tmp_path / "none")[2]
    with pytest.raises(tl.InputError, match=r"has no \[corridor\]"):
        score_of(tl.fly("one-push"))


def test_the_jerk_of_the_smoothest_reach_is_that_of_its_closed_form():
    time = np.linspace(0.0, 2.0, 4001)
    s = time / 2.0  # minimum jerk: 10 s³ − 15 s⁴ + 6 s⁵ (Flash and Hogan 1985); 720/1.875² of every size and duration
    speed = 0.5 * 0.7 * (30.0 * s**2 - 60.0 * s**3 + 30.0 * s**4)
    velocity = np.column_stack([speed, 0.0 * speed, 0.0 * speed])
    assert log_dimensionless_jerk(time, velocity) == pytest.approx(np.log(720.0 / 1.875**2), abs=1e-2)


def test_touches_are_counted_once_each():
    time, force = np.arange(0.0, 10.0, 0.01), np.zeros((1000, 3))
    force[:, 2] = 30.0
    force[[100, 101, 120, 400, 900], 0] = -5.0  # a rebound after 0.2 s belongs to the first
    assert count_touches(time, force) == 3
    assert count_touches(time, 0.0 * force) == 0
