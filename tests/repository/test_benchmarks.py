"""What is said of speed: whole calls, as a user pays them, before the compiled loop in them; the processor named."""

import importlib
import os
import re
import subprocess
import sys

import pytest
from repository import ROOT

PAGE = ROOT / "docs" / "explanation" / "benchmarks.md"
MEASURE = """
import bench, flights
flights.DURATION, flights.MANY, flights.STEPS, flights.MISSIONS = 2.0, 16, 50, {"paper": {}}
speeds = {"paper": flights.mission_speeds("paper", 1, busy=True)}
about = bench.describe(("tandemlift",))
mujoco = {"real_time": 1.0, "step_us": 1.0, "bare_share": 0.5}
print(about["processor"])
print(bench.report({"machine": about, "missions": speeds, "mujoco": mujoco, "memory_mib": {}}))
"""


def test_the_benchmark_names_the_processor_then_prints_whole_calls_then_the_loop():
    """In a small run of `benchmarks/bench.py`."""
    folder, env = ROOT / "benchmarks", {**os.environ, "TANDEMLIFT_OPTIMISE": "1"}
    env["PYTHONPATH"] = os.pathsep.join([str(ROOT / "src"), env.get("PYTHONPATH", "")])
    command = [sys.executable, "-c", MEASURE]
    printed = subprocess.run(command, cwd=folder, env=env, check=True, capture_output=True, text=True).stdout
    processor, _, report = printed.partition("\n")
    order = [report.index(words) for words in (processor, "Whole calls", "`tl.fly`, ms", "The compiled loop")]
    assert order == sorted(order)


def rows_below(title):
    """The rows of the first table below a heading of the page: cells by the name in the first."""
    text = PAGE.read_text("utf-8").split(f"\n## {title}\n")[1]
    table = re.search(r"(?:^\|.*\n)+", text, re.MULTILINE)[0].splitlines()
    lines = [[cell.strip(" `") for cell in line.strip("|").split("|")] for line in table]
    return lines[0], {cells[0]: cells[1:] for cells in lines[2:]}


def test_the_readme_has_the_whole_calls_of_the_benchmarks_and_their_processor():
    heads, rows = rows_below("Whole calls")
    ns, block = (next(i for i, head in enumerate(heads[1:]) if words in head) for words in ("ns a step", "metrics"))
    text = " ".join((ROOT / "README.md").read_text("utf-8").split())
    said = re.search(
        r"`tl.fly` takes (\S+) ns a step of `paper` and (\S+) of `iris`.* `fly_many` makes (\S+) and (\S+) million",
        text,
    )
    found = [float(said[i].replace(",", "")) for i in (1, 2, 3, 4)]
    table = [float(rows[name][i].replace(",", "")) for i in (ns, block) for name in ("paper", "iris")]
    assert found == pytest.approx(table, rel=0.05)
    processor = re.search(r"Measured on ([^,;(]*\([^)]*\))", PAGE.read_text("utf-8"))[1]
    assert processor in text


def test_each_simulator_that_is_measured_has_its_rows_beside_ours_and_its_packages_pinned(monkeypatch):
    """Those that are in no registry are installed by hand."""
    monkeypatch.syspath_prepend(ROOT / "benchmarks")
    peers = importlib.import_module("peers")
    _, printed = rows_below("Beside other simulators")
    lines = [re.sub(r"[*`]| \d[\d.]*(?=,|$)", "", name) for name in printed]
    rows = [row for name in peers.SIMULATORS for row in importlib.import_module(f"simulators.{name}").ROWS.values()]
    assert lines == [row.what.replace("`", "") for row in rows]
    pinned = (ROOT / "benchmarks" / "requirements-peers.txt").read_text("utf-8")
    needed = {package for row in rows for package in row.packages} - {"tandemlift"}
    assert {package for package in needed if f"\n{package}==" not in pinned} == {"gym-pybullet-drones"}
