"""Exercises: solutions get all points, common mistakes a hint, and what notebooks must not do is named."""

import csv
import json
import os
import re
from pathlib import Path

import pytest
from classroom import EXERCISES, graded, handed_in, source

from tandemlift.apps.teaching.grading import checks_of, grade
from tandemlift.apps.teaching.hand_ins import notebooks_in
from tandemlift.core.errors import InputError

NAMES = sorted(p.parent.name for p in EXERCISES.glob("*/checks.py"))


def answers(text: str) -> dict:
    namespace: dict = {}
    exec(compile(text, "cell 1", "exec"), namespace)
    return namespace


# For each exercise ten wrong answers: what stands in the solution, what somebody wrote instead, and a word of the hint.
WRONG = {
    "1-admittance": [
        ("return force * (1.0 - threshold / length)", "return force", "jumps"),
        ("return force * (1.0 - threshold / length)", "return force - threshold * np.array([1.0, 0, 0])", "backwards"),
        (
            "return force * (1.0 - threshold / length)",
            "return force * np.maximum(1 - threshold / abs(force).clip(1e-9), 0)",
            "direction",
        ),
        ("length = np.linalg.norm(force)", "length = np.max(force)", "backwards"),
        ("return np.zeros(3)", "return force", "within the threshold"),
        ("np.exp(-damping * dt / mass)", "np.exp(damping * dt / mass)", "without end"),
        ("np.exp(-damping * dt / mass)", "np.exp(-mass * dt / damping)", "63 %"),
        ("kept = np.exp(-damping * dt / mass)", "force[...] = force; kept = 1 - damping * dt / mass", "solve the"),
        ("force / damping * (1.0 - kept)", "force / mass * dt", "1.25"),
        ("mass = damping * time_constant", "mass = damping / time_constant", "time constant is"),
    ],
    "2-margins": [
        ("np.log(np.abs(response))", "20 * np.log10(np.abs(response)) - 1.0", "not 1 dB"),
        ("np.log(np.abs(response))", "np.log(np.abs(response)) + np.log(2) / 2", "4 rad/s"),
        (
            "* (frequency[i + 1] / frequency[i]) ** share",
            "* (frequency[i + 1] / frequency[i]) ** share / (2 * np.pi)",
            "rad/s",
        ),
        (
            "i = np.flatnonzero(np.diff(np.sign(size)))",
            "i = np.flatnonzero(np.diff(np.sign(size)))[:1]",
            "downwards and upwards",
        ),
        ("np.exp(-1j * frequency * delay)", "np.exp(-1j * delay)", "At 4 rad/s"),
        ("np.exp(-1j * frequency * delay)", "np.exp(-frequency * delay)", "no magnitude"),
        ("np.degrees(margin[np.argmin(abs(margin))])", "np.min(margin)", "degrees"),
        ("np.degrees(margin[np.argmin(abs(margin))])", "np.degrees(np.min(abs(margin)))", "comes back"),
        ("np.min(margin % (2.0 * np.pi) / at)", "np.degrees(np.min(margin % (2 * np.pi) / at))", "in rad over"),
        (
            "np.min(margin % (2.0 * np.pi) / at)",
            "np.radians(phase_margin(frequency, response)) / at[0]",
            "fastest crossover",
        ),
    ],
    "3-sliding-mode": [
        ("rate + slope * error", "rate - slope * error", "decays"),
        ("rate + slope * error", "error + rate / slope", "factor 1"),
        ("if boundary == 0.0:\n        return np.sign(s)\n    return", "return", "ZeroDivisionError"),
        ("np.clip(s / boundary, -1.0, 1.0)", "np.sign(s)", "Within the layer"),
        ("np.clip(s / boundary, -1.0, 1.0)", "s / boundary", "Far from"),
        ("- gain * switching", "+ gain * switching", "without end"),
        ("-slope * rate - gain", "-gain", "slope times the speed"),
        ("- gain * switching(s, boundary)", "- gain * s", "1 s"),
        ("return disturbance + fall", "return max(disturbance, fall)", "although"),
        ("/ (len(signal) * dt)", "", "10 times"),
    ],
    "4-allocation": [
        ("np.array([np.ones(len(arms)), ", "np.array([np.ones(len(arms)) / len(arms), ", "ones"),
        ("arms[:, 1], -arms[:, 0], torque", "-arms[:, 1], arms[:, 0], torque", "rolls"),
        ("arms[:, 1], -arms[:, 0], torque", "arms[:, 0], -arms[:, 1], torque", "rolls"),
        ("-arms[:, 0], torque_per_thrust", "arms[:, 0], torque_per_thrust", "pitches"),
        ("torque_per_thrust * np.asarray(spins)", "np.asarray(spins)", "reaction torque"),
        ("np.linalg.pinv(effectiveness) @ wrench", "np.linalg.solve(effectiveness, wrench)", "LinAlgError"),
        ("np.linalg.pinv(effectiveness) @ wrench", "effectiveness.T @ wrench", "Your thrusts make"),
        ("left[:, rotor] = 0.0", "pass", "is lost, but makes"),
        (
            "return np.linalg.pinv(left) @ wrench",
            "f = allocate(effectiveness, wrench); f[rotor] = 0.0; return f",
            "others must still",
        ),
        ("np.all(thrusts >= -1e-9) and np.all(thrusts <= largest)", "np.all(thrusts <= largest)", "below zero"),
    ],
    "5-observer": [
        ("2.0 * (x * z + w * y)", "2.0 * (x * z - w * y)", "forwards"),
        ("thrust * np.array(", "np.array(", "30 N point up"),
        ("known = rotors + mass * GRAVITY", "known = rotors", "weight"),
        ("known = rotors + mass * GRAVITY", "known = rotors - mass * GRAVITY", "weight"),
        ("dt * (known + estimate)", "dt * (known - estimate)", "without end"),
        ("dt * (known + estimate)", "dt * known", "the hand pushes"),
        ("gain * (mass * velocity - memory)", "gain * (velocity - memory)", "begins with"),
        ("gain * (mass * velocity - memory)", "0.5 * gain * (mass * velocity - memory)", "63 %"),
        ("return mass * velocity", "return 0.0 * velocity", "begin at the momentum"),
        ("estimates[:samples].mean(axis=0)", "0.0", "its mean"),
    ],
    "6-passivity": [
        ("np.sum(power) * dt", "np.sum(power)", "3 J"),
        ("np.sum(power) * dt", "np.cumsum(power) * dt", "one number"),
        ("np.sum(power) * dt", "np.sum(abs(power)) * dt", "sign counts"),
        ("mass * 1j * frequency + damping", "mass + damping * 1j * frequency", "Without delay"),
        ("np.exp(-1j * frequency * delay)", "np.exp(1j * frequency * delay)", "backwards"),
        ("admittance.real >= -1e-12", "abs(admittance) >= 0.0", "Behind 50 ms"),
        ("np.all(admittance.real", "np.any(admittance.real", "at some frequency"),
        ("return low * np.hypot(mass * low, damping)", "return low", "bears"),
        ("middle * delay < np.pi / 2.0", "middle * delay < np.pi", "swings"),
        ("return high", "return 2.0 * high", "of phase"),
    ],
}  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("name", NAMES)
def test_solutions_get_all_points_and_wrong_answers_a_hint(name):
    checks, text = checks_of(EXERCISES / name), source(name)
    full = grade(checks, answers(text))
    assert full.points == sum(c.of for c in full.checks) == 10, str(full)
    assert len(WRONG[name]) == 10
    for right, wrong, word in WRONG[name]:
        assert text.count(right) == 1, right
        got = grade(checks, answers(text.replace(right, wrong)))
        hints = " | ".join(c.hint for c in got.checks)
        assert got.points < 10, f"{wrong}: full points"
        assert word in hints, f"{wrong}: {hints}"


@pytest.mark.parametrize("name", NAMES)
def test_notebooks_ask_for_what_their_checks_need(name):
    notebook = json.loads((EXERCISES / name / f"{name}.ipynb").read_text("utf-8"))
    cells = ["".join(c["source"]) for c in notebook["cells"] if "answer" in c["metadata"].get("tags", ())]
    asked = re.findall(r"^def (\w+)", "\n".join(cells), re.M)
    assert set(asked) <= set(answers(source(name)))
    assert notebook["metadata"]["tandemlift"]["exercise"] == name
    empty = grade(checks_of(EXERCISES / name), answers("\n".join(cells)))
    assert empty.points == 0, str(empty)
    assert all("is not written yet" in c.hint for c in empty.checks), str(empty)
    code = [c for c in notebook["cells"] if c["cell_type"] == "code"]
    assert all(c["outputs"] == [] and c["execution_count"] is None for c in code)


@pytest.mark.thorough
def test_a_class_is_graded_and_what_misbehaves_is_named(tmp_path):
    first = "1-admittance"
    solution = EXERCISES / "solutions" / f"{first}.py"
    begin = "%matplotlib inline\nimport json\njson.load?\nif True:\n    !ls\nassert (7\n    % 4\n    != 2)\ndisplay(7)"
    handed_in(tmp_path, "anna", first, begin, source(first))
    handed_in(tmp_path, "ben", first, source(first), "1 / 0")
    handed_in(
        tmp_path, "dan", first, f"try:\n    exec(open({str(solution)!r}).read())\nexcept BaseException:\n    pass"
    )
    handed_in(tmp_path, "eve", first, "import os\nos._exit(0)")
    handed_in(tmp_path, "finn", first, "def dead_band(")
    handed_in(tmp_path, "gus", first, f"text = open({str(tmp_path / 'anna.ipynb')!r}).read()")
    handed_in(tmp_path, "hal", first, "import subprocess\nsubprocess.run(['true'])")
    handed_in(tmp_path, "ida", first, "raise SystemExit")
    handed_in(tmp_path, "jo", first, "import checks\nchecks.check_flight = lambda points=10: None")
    handed_in(tmp_path, "kai", first, source(first), "def design(*given):\n    raise SystemExit")
    (tmp_path / "kim.ipynb").write_text("{}", "utf-8")
    handed_in(tmp_path / "leo", "leo", os.path.relpath(tmp_path / "leo", EXERCISES), "pass")
    (tmp_path / "leo" / "checks.py").write_text("raise SystemExit('ran in the process that grades')", "utf-8")
    handed_in(tmp_path, "mia", "9-unknown", "pass")
    code, said = graded(tmp_path, "--seconds", "600")
    assert code == 3
    assert re.findall(r"^(\w+) +(\d+) +\d+$", said, re.M) == [
        *(("anna", "10"), ("ben", "10"), ("dan", "0"), ("eve", "0"), ("finn", "0")),
        *(("gus", "0"), ("hal", "0"), ("ida", "0"), ("jo", "0"), ("kai", "6")),
    ]
    for line in (
        "ben, 1-admittance: cell 2, ZeroDivisionError: division by zero",
        f"dan, 1-admittance: cell 1 reads the solution ({first}.py)",
        "eve, 1-admittance: cell 1 ended the process",
        "finn, 1-admittance: cell 1, SyntaxError: ",
        "gus, 1-admittance: cell 1 reads another notebook (anna.ipynb)",
        "hal, 1-admittance: cell 1 starts another program",
        "ida, 1-admittance: cell 1, SystemExit",
        "`design`, line 2: SystemExit",
        "kim.ipynb: is a notebook of no exercise, and was skipped",
        "leo/leo.ipynb: is of exercise '../",
        f"mia.ipynb: is of exercise '9-unknown', which is not in {EXERCISES}, and was skipped",
    ):
        assert line in said, said


@pytest.mark.parametrize(
    "content", [b"{", b"", b"\xff\xfe{}", b"[" * 100_000], ids=("half", "empty", "no text", "deep")
)
def test_a_damaged_notebook_is_no_readable_json(tmp_path, content):
    (tmp_path / "kim.ipynb").write_bytes(content)
    found, others = notebooks_in(tmp_path, EXERCISES)
    assert (found, list(map(str, others))) == (
        [],
        ["kim.ipynb: is no readable JSON, as of a file that is damaged or not whole, and was skipped"],
    )


@pytest.mark.thorough
def test_an_endless_cell_is_ended_and_named_although_it_catches_everything(tmp_path):
    loop = "while True:\n    try:\n        pass\n    except BaseException:\n        pass"
    handed_in(tmp_path, "cleo", "1-admittance", loop)
    code, said = graded(tmp_path, "--seconds", "5")
    assert code == 3
    assert re.search("cleo, 1-admittance: (cell 1|the start) did not end within 5 s", said), said  # by how busy it is


@pytest.mark.thorough
def test_where_nothing_was_compiled_yet_whole_notebooks_with_right_answers_get_all_points(tmp_path):
    for name in ("1-admittance", "4-allocation", "6-passivity"):  # which fly the same mission
        notebook = json.loads((EXERCISES / name / f"{name}.ipynb").read_text("utf-8"))
        cells = [c for c in notebook["cells"] if "answer" in c["metadata"].get("tags", ())]
        for cell in cells:
            cell["source"] = source(name) if cell is cells[0] else ""
        (tmp_path / f"{name}.ipynb").write_text(json.dumps(notebook), "utf-8")
    new = {"TANDEMLIFT_CACHE": str(tmp_path / "cache"), "TANDEMLIFT_OPTIMISE": "1"}
    _, said = graded(tmp_path, "--seconds", "600", **new)
    assert re.findall(r" (\d+)$", said, re.M) == ["10", "10", "10"], said


@pytest.mark.thorough
def test_the_command_prints_and_writes_a_table(tmp_path):
    for name in ("anna", "ben"):
        handed_in(tmp_path / "in" / name, "1-admittance", "1-admittance", source("1-admittance"))
    handed_in(tmp_path / "in" / "ben", "6-passivity", "6-passivity", source("6-passivity"))
    out = tmp_path / "points.csv"
    assert graded(tmp_path / "in", "--out", str(out))[0] == 0
    head = ["name", "1-admittance", "6-passivity", "points", "remarks"]
    rows = [head, ["anna", "10", "–", "10", ""], ["ben", "10", "10", "20", ""]]
    assert list(csv.reader(out.read_text("utf-8").splitlines())) == rows


def test_hidden_folders_are_left_out_but_not_those_above(tmp_path, monkeypatch):
    names = ("anna", ".ipynb_checkpoints/anna-checkpoint", "ben/.ipynb_checkpoints/ben", "ben/ben")
    for path in map(Path, names):
        handed_in(tmp_path / ".hidden" / path.parent, path.name, "1-admittance", "pass")
    monkeypatch.chdir(tmp_path / ".hidden" / "ben")
    for folder in (tmp_path / ".hidden", Path("..")):
        assert [one.name for one in notebooks_in(folder, EXERCISES)[0]] == ["anna", "ben"]
    monkeypatch.chdir("..")
    assert [one.name for one in notebooks_in(Path(), EXERCISES)[0]] == ["anna", "ben"]


def test_folders_without_notebooks_or_exercises_are_refused(tmp_path):
    with pytest.raises(InputError, match="there is no such folder"):
        notebooks_in(tmp_path / "none", EXERCISES)
    with pytest.raises(InputError, match=r"must hold notebooks \(.ipynb\)"):
        notebooks_in(tmp_path, EXERCISES)
    with pytest.raises(InputError, match=r"must hold a folder for each exercise, with a checks.py; has none"):
        notebooks_in(tmp_path, tmp_path)
