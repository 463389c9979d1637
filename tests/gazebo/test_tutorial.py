"""The tutorial of Gazebo: its commands fly, compare, and are pushed by hand."""

import json
import os
import re

import numpy as np
import pytest
from patience import completed, until
from tutorial import Tutorial

import tandemlift as tl
from tandemlift.engines.gazebo_server import root, shell_command, with_gazebo_environment

pytestmark = pytest.mark.gazebo


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    """The tutorial, run to its end, and its folder."""
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "DISPLAY")}
    page = Tutorial("gazebo", tmp_path_factory.mktemp("gazebo"), environment, {"sudo": "env"})  # it may have none
    try:
        page.run("fly")
        page.run("compare")
        by_hand = page.start("by-hand")
        push = by_hand.says(r"\n  (.*gz topic .*push.*)\n")[1]
        by_hand.says("Ctrl-C ends it")
        master = re.search(r"GAZEBO_MASTER_URI=(\S+)", push)[1]
        until(lambda: simulated(master) > 14.0, "the end of the tare")  # s
        page.paste(push)
        pushed = simulated(master)
        until(lambda: simulated(master) > pushed + 4.0, "the end of the push")
        assert by_hand.interrupt() == 0, by_hand.printed()
        page.run("read")
    finally:
        page.close()
    page.check_complete()
    return page.folder / "out"


def simulated(master):
    """How long a server of that address has simulated [s]."""
    script = with_gazebo_environment(master, "timeout 60 gz stats -p -d 2")
    told = completed(shell_command(root(), script), capture_output=True, text=True, check=False).stdout
    times = re.findall(r"^ *[\d.]+, +([\d.]+), ", told, re.MULTILINE)
    return float(times[-1]) if times else 0.0


def test_the_corridor_is_flown_from_ground_to_ground(flown):
    folder = flown / "gazebo" / "zigzag"
    flight, alike = tl.Flight.load(folder / "flight.npz"), tl.fly(tl.load_mission("zigzag"))
    assert flight.version["engine"] == "gazebo"
    assert flight["contact_force"][[0, -1], 2] == pytest.approx(34.3, abs=0.5)  # N: it stood, and stands
    assert np.abs(flight["position"] - alike["position"]).max() < 0.02  # m
    assert json.loads((folder / "metrics.json").read_text("utf-8"))["final_position_m"][0] > 24.5


def test_both_engines_are_in_one_table(flown):
    assert "gazebo" in (flown / "zigzag" / "engines.json").read_text("utf-8")


def test_a_push_by_hand_is_followed_and_kept(flown):
    flight = tl.Flight.load(flown / "gazebo" / "iris" / "flight.npz")
    assert flight.mission["mission"]["duration"] == pytest.approx(flight.time[-1], abs=0.02)
    assert np.abs(flight["push_estimate"][:, 0]).max() == pytest.approx(2.0, abs=0.3)  # N
    assert abs(flight["position"][-1, 1]) < 0.1  # m
    metrics, along = flight.metrics(), flight["push_force"][:, 0]
    work = (along * flight["velocity"][:, 0]).sum() * flight.mission["mission"]["log_interval"]
    assert metrics["human_work_j"] == pytest.approx(work, rel=0.05)
    assert metrics["human_work_j"] > 1.0  # J
    assert metrics["human_time_s"] == pytest.approx(2.0)
    assert metrics["human_force_mean_n"] == pytest.approx(2.0)
