import json
import os
import re
from pathlib import Path

import pytest

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.missions import built_in, load_mission

OURS = {"mission.toml", "flight.npz", "findings.json", "figures", "report.html"}
OURS |= {f"metrics.{kind}" for kind in ("json", "csv", "tex")}
ALWAYS = ("reference", "path", "tracking", "inputs", "interaction", "joints")
DRAWN = {f"{name}.{kind}" for name in ALWAYS for kind in ("png", "pdf")}
SHORT = ("--no-figures", "--set", "mission.duration=0.5")


def check_refused(outcome: tuple[int, str, str]) -> str:
    """The one message of a refusal."""
    code, out, err = outcome
    assert (code, out) == (2, "")
    assert "Traceback" not in err
    return err


def test_the_help_of_every_verb_says_what_it_does(run):
    for verb in cli.commands:
        code, own, _ = run(verb, "--help")
        assert code == 0
        assert f"Usage: tandemlift {verb}" in own
        assert len(own.splitlines()) > 4


def test_the_help_shows_each_verb_once_in_a_group_and_no_line_is_cut(run):
    _, out, _ = run("--help")
    verbs = out.partition("Try first:")[2]
    listed = [line.split()[0] for line in verbs.splitlines() if line.startswith("  ")]
    assert sorted(listed) == sorted(cli.commands)
    assert listed[:2] == ["run", "live"]
    assert max(map(len, out.splitlines())) <= 80
    assert "..." not in verbs


def test_without_a_verb_the_help_is_shown_and_the_version_is_told(run):
    code, out, err = run()
    assert code == 2
    assert "tandemlift run paper" in out + err
    assert run("--version") == (0, f"tandemlift, version {tl.__version__}\n", "")


def test_the_help_of_run_names_what_is_written_and_the_exit_codes(run):
    _, out, _ = run("run", "-h")
    for word in (
        *OURS,
        "Exit code 3: crashed, diverged, interrupted or not lifted",
        "--set mission.duration=30",
        "out/NAME",
    ):
        assert word in out


@pytest.mark.parametrize(
    ("arguments", "pieces"),
    [
        (
            ("rnu", "paper"),
            [
                "No such command 'rnu'",
                "run, live, missions, docs, new, template, explain, check, controllers, engines, schema, completion,",
                "Did you mean 'run'?",
            ],
        ),
        (("misions",), ["Did you mean 'missions'?"]),
        (("xyz",), ["No such command 'xyz'; there are run, "]),
        (("run", "paper", "--ste", "a=1"), ["No such option", "--set"]),
        (("run", "paper", "--no-figure"), ["No such option", "--no-figures"]),
        (("run", "paper", "--style", "slides", "--no-figures"), ["--style slides: leave out --no-figures"]),
        (("run",), ["Missing argument 'MISSION'"]),
        (("run", "paper", "hover"), ["unexpected extra argument"]),
        (("run", "paper", "--set"), ["requires an argument"]),
        (("run", "papr"), ["unknown mission 'papr'", "Did you mean 'paper'?"]),
        (("run", "paper", "--engine", "compild"), ["unknown engine 'compild'", "Did you mean 'compiled'?"]),
        (("run", "paper", "--controller", "nftmsc"), ["unknown controller 'nftmsc'", "Did you mean 'nftsmc'?"]),
        (("run", "paper", "--controller", "absent.py"), ["absent.py does not exist"]),
        (("run", "paper", "--set", "mission.duration"), ["--set mission.duration: must be KEY=VALUE"]),
        (("run", "paper", "--set", "mission.step=0.5"), ["paper: mission.step = 0.5: must be a number > 0 and ≤ 0.02"]),
        (("run", "paper", "--set", "pushes.9.sigma=1"), ["'9' must be a number from 0 to 7"]),
        (("run", "paper", "--set", 'mission.name="../x"'), ["mission.name = ", "letters"]),
    ],
    ids=" ".join,
)
def test_bad_input_is_refused_with_a_hint_and_nothing_is_written(arguments, pieces, run, tmp_path):
    message = check_refused(run(*arguments))
    assert [piece for piece in pieces if piece not in message] == []
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("verb", "names"), [("missions", built_in()), ("controllers", ["nftsmc"]), ("engines", ["compiled"])]
)
def test_what_there_is_is_listed_a_line_each(verb, names, run):
    code, out, err = run(verb)
    assert (code, err) == (0, "")
    lines = [line.split(maxsplit=1) for line in out.splitlines()]
    assert {name for name, _ in lines} >= set(names)


def test_the_file_of_a_mission_is_printed_and_is_that_mission(run, tmp_path):
    code, out, err = run("missions", "iris")
    assert (code, err) == (0, "")
    (tmp_path / "mine.toml").write_text(out, "utf-8")
    assert load_mission(tmp_path / "mine.toml") == load_mission("iris")
    code, out, err = run("missions", "irs")
    assert (code, out) == (2, "")
    assert "Did you mean 'iris'" in err


def test_compile_takes_a_controller_as_run_does(run, tmp_path):
    module = ("compile", "hover", "--target", "wasm32")
    assert run(*module, "--controller", "pid")[0] == 0
    numbers = json.loads((tmp_path / "out" / "hover-wasm32" / "hover.json").read_text("utf-8"))["numbers"]
    assert "controller.velocity_i" in str(numbers)
    message = check_refused(run(*module, "--controller", "nftmsc"))
    assert "Did you mean 'nftsmc'?" in message


def test_a_run_writes_its_results_to_out_name(run, tmp_path):
    code, out, _ = run("run", "hover", *SHORT, "--set", "mission.name=mine")
    folder = tmp_path / "out" / "mine"
    assert code == 0
    assert {path.name for path in folder.iterdir()} == OURS - {"figures"}
    assert "mine: flying; 500 steps" in out
    assert str(Path("out") / "mine" / "report.html") in out
    assert "http-equiv" not in (folder / "report.html").read_text("utf-8")


def test_the_results_are_those_of_the_flight(run, tmp_path):
    assert run("run", "one-push", *SHORT, "--out", "here")[0] == 0
    flight = tl.Flight.load(tmp_path / "here" / "flight.npz")
    mission = load_mission(tmp_path / "here" / "mission.toml")
    assert mission == load_mission("one-push", {"mission.duration": 0.5})
    text = (tmp_path / "here" / "metrics.json").read_text("utf-8")
    metrics = json.loads(text, parse_constant=pytest.fail)
    assert metrics == flight.metrics()
    assert metrics["position_rmse_after_10s_m"] is None
    again = tl.fly(mission)
    assert {name: again[name].tobytes() for name in again} == {name: flight[name].tobytes() for name in flight}


def test_a_second_run_replaces_our_files_and_no_other(run, tmp_path):
    folder = tmp_path / "out" / "hover"
    (folder / "figures").mkdir(parents=True)
    strangers = [folder / "notes.txt", folder / "figures" / "mine.png", folder / "figures" / "path.svg"]
    for path in [*strangers, folder / "metrics.json", *(folder / "figures" / name for name in DRAWN)]:
        path.write_text("mine")
    assert run("run", "hover", *SHORT)[0] == 0
    assert [path.read_text() for path in strangers] == ["mine"] * 3
    assert json.loads((folder / "metrics.json").read_text())["steps"] == 500
    assert {path.name for path in folder.iterdir()} == OURS | {"notes.txt"}
    assert {path.name for path in (folder / "figures").iterdir()} == {"mine.png", "path.svg"}


def test_results_do_not_replace_the_mission_file_that_was_given_but_that_of_an_earlier_run(run, tmp_path):
    own, whole = tmp_path / "mission.toml", run("missions", "hover")[1]  # with comments
    for text in ('extends = "hover"\n', f"\ufeff{whole}"):
        own.write_text(text, "utf-8")
        message = check_refused(run("run", "mission.toml", *SHORT, "--out", "."))
        assert "--out .: the results would replace mission.toml" in message
        assert (own.read_text("utf-8"), [*tmp_path.iterdir()]) == (text, [own])
    assert run("run", "hover", *SHORT)[0] == 0
    assert run("run", "out/hover/mission.toml", *SHORT, "--set", "admittance.mass=3")[0] == 0


@pytest.mark.parametrize(
    ("out", "pieces"),
    [
        ("file", ["--out file: file is a file, not a folder"]),
        ("file/deep/er", ["file is a file, not a folder"]),
        ("/proc/no/such", ["--out /proc/no/such: cannot be made"]),
        ("n" * 300, ["cannot be made", "too long"]),
        ("taken", ["taken/metrics.json is in the way"]),
        ("drawn", ["drawn/figures is in the way"]),
    ],
)
def test_a_folder_that_cannot_take_the_results_is_refused_before_the_flight(out, pieces, run, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "taken" / "metrics.json").mkdir(parents=True)
    (tmp_path / "drawn").mkdir()
    (tmp_path / "drawn" / "figures").write_text("mine")
    monkeypatch.setattr("tandemlift.simulation.fly.fly_plan", lambda *_, **__: pytest.fail("flown"))
    message = check_refused(run("run", "hover", "--out", out))
    assert [piece for piece in pieces if piece not in message] == []
    assert (tmp_path / "file").read_text() == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drawn", "file", "taken"]


@pytest.mark.skipif(os.name != "posix", reason="permissions of POSIX")
def test_a_folder_without_permission_is_refused_before_the_flight(run, tmp_path, monkeypatch):
    (tmp_path / "closed").mkdir()
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # root may write anywhere
    assert "--out closed: the folder cannot be written to" in check_refused(run("run", "hover", "--out", "closed"))
    assert list((tmp_path / "closed").iterdir()) == []


def test_a_flight_that_fails_leaves_no_folder_behind(run, tmp_path):
    Path("bad.py").write_text(
        "from typing import NamedTuple\n"
        "from tandemlift.parts.controllers import ControllerTable, control, register\n"
        "class Settings(ControllerTable): pass\n"
        "class Gains(NamedTuple): pass\n"
        "@control.register(Gains, compiled=False)\n"
        "def law(k, memory, measured, reference):\n"
        "    return 1 / measured.state.position.x\n"
        "@register('bad', Settings)\n"
        "def start(s, vehicle, step):\n"
        "    return Gains(), None\n"
    )
    message = check_refused(run("run", "hover", "--controller", "bad.py", "--out", "deep/er"))
    assert "controller 'bad' fails: bad.py, line 7: ZeroDivisionError: float division by zero" in message
    assert [path.name for path in tmp_path.iterdir()] == ["bad.py"]


def test_a_flight_that_crashes_ends_there_and_after_it_on_request(run):
    upset = ("--set", "disturbance.moment=[0,9,0]", "--set", "mission.duration=12", "--no-figures")
    code, out, err = run("run", "iris", *upset)
    at = float(re.search(r"iris: crashed at (\S+) s: tilt \[deg\] = [\d.]+, must stay within 89 degrees", err)[1])
    assert code == 3
    assert f"iris: crashed; {round(at * 1000)} steps" in out
    code, out, err = run("run", "iris", *upset, "--after-crash", "1.5")
    assert code == 3
    assert f"iris: crashed at {at:g} s" in err
    steps = int(re.search(r"iris: crashed; (\d+) steps", out)[1])
    assert round(at * 1000) + 500 < steps <= round((at + 1.5) * 1000) + 1


def test_a_lift_that_never_happens_is_a_failure(run):
    code, out, err = run(
        "run", "iris", "--set", "disturbance.force=[0,0,-30]", "--set", "mission.duration=9", "--no-figures"
    )
    assert code == 3
    assert "iris: not-lifted" in out
    assert "iris: not-lifted: a lift of the mission" in err


@pytest.mark.thorough
def test_a_flight_that_diverges_in_its_first_step_is_written_and_drawn_as_any(run, tmp_path):
    code, out, err = run("run", "hover", "--set", "initial.rates=[1e200,1e200,1e200]")
    assert code == 3
    assert "hover: diverged at 0.001 s: " in err
    assert "Traceback" not in err
    assert "hover: diverged; 1 steps" in out
    metrics = json.loads((tmp_path / "out" / "hover" / "metrics.json").read_text(), parse_constant=pytest.fail)
    assert metrics["steps"] == 1
    assert metrics["final_position_m"] is None or len(metrics["final_position_m"]) == 3
    assert {path.name for path in (tmp_path / "out" / "hover").iterdir()} == OURS
    assert {path.name for path in (tmp_path / "out" / "hover" / "figures").iterdir()} == DRAWN


def test_a_warning_is_one_line_told_once(run):
    _, _, err = run("run", "hover", *SHORT, "--set", "controller.boundary_layer=0.0001")
    told = [line for line in err.splitlines() if "may chatter" in line]
    assert len(told) == 1
    assert told[0].startswith("warning: ")


def test_docs_open_what_a_checkout_has_the_newest_site_first(run, tmp_path, monkeypatch):
    from tandemlift.apps.cli import live

    opened = []
    monkeypatch.setattr(live, "DATA", tmp_path / "src/tandemlift/data")
    monkeypatch.setattr(live.click, "launch", opened.append)
    assert "a wheel of a release has it, and a checkout" in check_refused(run("docs"))
    pages = [tmp_path / name for name in ("docs/index.md", "out/site/index.html", "out/site-quick/index.html")]
    for i, page in enumerate(pages):
        page.parent.mkdir(parents=True)
        page.touch()
        os.utime(page, (i, i))
        code, out, _ = run("docs")
        assert code == 0
        assert out.splitlines()[0] == str(page)
        assert ("make docs" in out) == (i == 0)  # as text only
    assert opened == [page.as_uri() for page in pages]
