"""`tandemlift gazebo`: server, window, cameras and pilot by one command."""

import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from patience import COMPILING, completed, ended, until
from screen import Screen

import tandemlift as tl

pytestmark = pytest.mark.gazebo
TANDEMLIFT = [sys.executable, "-m", "tandemlift", "gazebo"]


def test_a_crash_is_ended_said_and_flown_on_as_in_the_compiled_engine(tmp_path):
    falling = ("initial.position=[0, 0, 2.2]", "initial.euler=[0.7, 0.9, 0]", "ground.height=0.0")
    options = [f"--set={setting}" for setting in (*falling, "phases.lift_start=5.0")]
    for engine, command in {
        "gazebo": [*TANDEMLIFT, "iris", "--fast", "--no-window"],
        "compiled": [*TANDEMLIFT[:-1], "run", "iris"],
    }.items():
        folder = tmp_path / engine
        words = [*command, "--after-crash", "8", "--no-figures", "--out", str(folder), *options]
        done = completed(words, capture_output=True, text=True, check=False)
        assert done.returncode == 3
        assert re.search(r"iris: crashed at 0\.5\d* s: hit the floor: .* of 7 N s", done.stderr)
        assert "iris: crashed; " in done.stdout
        metrics = json.loads((folder / "metrics.json").read_text("utf-8"))
        assert metrics["outcome"] == "crashed"
        assert 0.0 < metrics["final_position_m"][2] < 0.3  # m: it lies on the floor
        assert tl.Flight.load(folder / "flight.npz").ending.time < 0.6 < metrics["steps"] * 1e-3  # s


def test_the_window_opens_and_closes_with_the_flight(tmp_path, program):
    screen = Screen(program("Xvfb"), tmp_path / "screen")
    try:
        dark = screen.picture()
        options = ["--set", "mission.duration=20.0", "--no-figures", "--out", str(tmp_path / "out")]
        command = [*TANDEMLIFT, "zigzag", *options]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env=os.environ | {"DISPLAY": screen.name})
        until(lambda: np.mean((dark != screen.picture()).any(axis=2)) > 0.2, "a window")
        assert ended(process, None, COMPILING) == 0
    finally:
        screen.close()
