"""`tandemlift gazebo`: server, window, cameras and pilot by one command."""

import json
import os
import re
import subprocess
import sys

import matplotlib.image
import numpy as np
import pytest
from patience import COMPILING, completed, ended, said, until
from screen import Screen

import tandemlift as tl
from tandemlift.engines.gazebo_server import root, shell_command, with_gazebo_environment

pytestmark = pytest.mark.gazebo
TANDEMLIFT = [sys.executable, "-m", "tandemlift", "gazebo"]


def begun(*arguments, folder, **environment):
    """A `tandemlift gazebo` that has begun to fly, and the address of Gazebo's transport."""
    process = subprocess.Popen(
        [*TANDEMLIFT, *arguments, "--no-figures", "--out", str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env=os.environ | environment,
    )
    return process, said(process, r"GAZEBO_MASTER_URI=(\S+)")[1]


def gz(master, *arguments):
    script = with_gazebo_environment(master, f"timeout 60 gz {' '.join(arguments)}")
    return completed(shell_command(root(), script), capture_output=True, text=True, check=False).stdout


def flown(master):
    """How long it has flown [s]."""
    told = re.findall(r"^ *[\d.]+, +([\d.]+), ", gz(master, "stats", "-p", "-d", "2"), re.MULTILINE)
    return float(told[-1]) if told else 0.0


def test_a_corridor_is_flown_from_ground_to_ground_and_photographed(tmp_path):
    process, _ = begun("zigzag", "--fast", "--pictures", "--no-window", folder=tmp_path)
    assert ended(process, None, COMPILING) == 0
    flight, alike = tl.Flight.load(tmp_path / "flight.npz"), tl.fly(tl.load_mission("zigzag"))
    assert flight.version["engine"] == "gazebo"
    assert flight["contact_force"][[0, -1], 2] == pytest.approx(34.3, abs=0.5)  # N: it stood, and stands
    assert np.abs(flight["position"] - alike["position"]).max() < 0.02  # m
    assert json.loads((tmp_path / "metrics.json").read_text("utf-8"))["final_position_m"][0] > 24.5
    drawn = matplotlib.image.imread(tmp_path / "figures/views.png")[:, :, :3]
    high, wide = (side // 2 for side in drawn.shape[:2])
    views = [drawn[y : y + high, x : x + wide] for y in (0, high) for x in (0, wide)]
    for k, view in enumerate(views):
        assert view.std() > 0.05  # not of one colour
        assert all(np.abs(view - other).mean() > 0.01 for other in views[:k])  # of another place
    assert "Photographs" in (tmp_path / "report.html").read_text("utf-8")


def test_a_flight_by_hand_yields_to_the_topic_and_is_kept(tmp_path):
    process, master = begun("iris", "--by-hand", "--no-window", folder=tmp_path)
    until(lambda: flown(master) > 14.0, "the end of the tare")  # s: it lifts, and tares until 12 s
    gz(master, "topic", "-p", "/gazebo/default/tandemlift/push", "-m", """'data: "force 2 0 0 duration 2"'""")
    pushed = flown(master)
    until(lambda: flown(master) > pushed + 4.0, "the end of the push")
    assert ended(process) == 0
    flight = tl.Flight.load(tmp_path / "flight.npz")
    assert flight.mission["mission"]["duration"] == pytest.approx(flight.time[-1], abs=0.02)
    assert np.abs(flight["push_estimate"][:, 0]).max() == pytest.approx(2.0, abs=0.3)  # N
    assert 0.5 < flight["position"][-1, 0] < 6.0  # m
    assert abs(flight["position"][-1, 1]) < 0.1
    metrics, along = flight.metrics(), flight["push_force"][:, 0]
    work = (along * flight["velocity"][:, 0]).sum() * flight.mission["mission"]["log_interval"]
    np.testing.assert_allclose(metrics["human_impulse_n_s"], [4.0, 0.0, 0.0], atol=1e-9)  # N s, what was pushed
    assert metrics["human_work_j"] == pytest.approx(work, rel=0.05)
    assert metrics["human_work_j"] > 1.0  # J
    assert metrics["human_time_s"] == pytest.approx(2.0)
    assert metrics["human_force_mean_n"] == pytest.approx(2.0)


def test_a_crash_is_ended_said_and_flown_on_as_in_the_compiled_engine(tmp_path):
    falling = {"initial.position": "[0, 0, 2.2]", "initial.euler": "[0.7, 0.9, 0]", "ground.height": "0.0"}
    settings = [f"{key}={value}" for key, value in (falling | {"phases.lift_start": "5.0"}).items()]
    options = [word for setting in settings for word in ("--set", setting)]
    for engine, command in {
        "gazebo": [*TANDEMLIFT, "iris", "--fast", "--no-window"],
        "compiled": [*TANDEMLIFT[:-1], "run", "iris"],
    }.items():
        folder = tmp_path / engine
        words = [*command, "--after-crash", "8", "--no-figures", "--out", str(folder), *options]
        done = completed(words, capture_output=True, text=True, check=False)
        assert done.returncode == 3
        assert re.search(r"iris: crashed at 0\.5\d* s: impulse of contact \[N s\] = .*, must stay below", done.stderr)
        assert "iris: crashed; " in done.stdout
        metrics = json.loads((folder / "metrics.json").read_text("utf-8"))
        assert metrics["outcome"] == "crashed"
        assert 0.0 < metrics["final_position_m"][2] < 0.3  # m: it lies on the floor
        assert tl.Flight.load(folder / "flight.npz").ending.time < 0.6 < metrics["steps"] * 1e-3  # s


def test_the_window_opens_and_closes_with_the_flight(tmp_path, program):
    screen = Screen(program("Xvfb"), tmp_path / "screen")
    try:
        dark = screen.picture()
        process, _ = begun("zigzag", "--set", "mission.duration=20.0", folder=tmp_path / "out", DISPLAY=screen.name)
        until(lambda: np.mean((dark != screen.picture()).any(axis=2)) > 0.2, "a window")
        assert ended(process, None, COMPILING) == 0
    finally:
        screen.close()
