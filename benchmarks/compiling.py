"""Time until the first flight, from an empty cache and a warm one: `python benchmarks/compiling.py`.

Prints Markdown: wall and processor time of whole processes, imports and children among them. With `--base PATH` the
same is done with another checkout, turn by turn, so that what else the machine does meets both alike; a ratio is the
median over the pairs. Against the last commit that Numba compiled:

    git worktree add ../base e5ecfdc
    python3 -m venv ../base/.venv && ../base/.venv/bin/pip install -r ../base/lock/run.txt
    python benchmarks/compiling.py --base ../base --rounds 3

A round takes a quarter of an hour with that base, half a minute without. The base runs in `PATH/.venv` if there is one,
else in this environment, and nothing is installed of either checkout: each is found by PYTHONPATH.

First step: the first report of progress, after up to 5,000 steps. Optimised: the same mission flies on and on until
optimised code has taken the place of what flew at once; with Numba that is the first step. Processor times are what a
busy machine tells best.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from machine import NO_RESULT, describe, heading, number, save, table
from waiting import PATIENCE

HERE = Path(__file__).resolve().parent.parent
NUMBERS = (1, 2, 4, 8, 64)  # of quadrotors
PACKAGES = ("tandemlift", "llvmlite", "numba", "numpy")

LOAD = """
import json, sys, time
import tandemlift as tl
mission = tl.load_mission(sys.argv[1], json.loads(sys.argv[2]))
def first(done, total): sys.exit()
"""
PLAN = """
try:
    from tandemlift.simulation.plan import FlightPlan
except ImportError:  # a base of before this folder
    from tandemlift.prepared import Prepared as FlightPlan
def in_precision(missions, precision):
    from tandemlift.missions import with_precision
    return [FlightPlan(with_precision(mission, precision), in_block=True) for mission in missions]
def loop_code(plan):
    return plan.loop_code if hasattr(plan, 'loop_code') else plan.kernels
def code_of(missions, precision=None):  # that these fly in together
    plans = [FlightPlan(mission) for mission in missions] if precision is None else in_precision(missions, precision)
    code = loop_code(plans[0])
    own = hasattr(code, 'parts_that_differ') and len(plans) > 1  # not a base of before scalars
    differ = {'differ': code.parts_that_differ([plan.start() for plan in plans])} if own else {}
    return code.loop(len(plans), **differ)
"""
FIRST = f"{LOAD}tl.fly(mission, progress=first)"
BEST = f"""{LOAD}
import importlib.util
if importlib.util.find_spec("tandemlift.compiler"):
    exec({PLAN!r})
    code = loop_code(FlightPlan(mission)).loop(1)
    while not code.is_best: tl.fly(mission)
tl.fly(mission, progress=first)
"""
BLOCK = f'{LOAD}tl.fly_many([mission] * 64, keep="metrics")'
IMPORT = "import tandemlift as tl; tl.fly"
BY_NAME = f"import sys; {IMPORT}(sys.argv[1])"
CALL = f"""
import json, sys, time
{IMPORT}
began = time.perf_counter(), time.process_time()
tl.fly(sys.argv[1])
print(json.dumps([time.perf_counter() - began[0], time.process_time() - began[1]]))
"""
AGAIN = f"""{LOAD}
def spent():
    began = time.perf_counter(), time.process_time()
    tl.fly(mission)
    return time.perf_counter() - began[0], time.process_time() - began[1]
print(json.dumps(sorted(spent() for _ in range(7))[3]))
"""
VERSIONS = """
import sys
sys.path.insert(0, sys.argv[1])
import machine
about = machine.describe({})
print(f"Python {{about['python']}},", ", ".join(f"{{name}} {{v}}" for name, v in about["versions"].items()))
"""


class Failed(Exception):
    """A process that ended with an error."""


class Spent(NamedTuple):
    """Wall and processor time [s]."""

    wall: float
    cpu: float


class Checkout(NamedTuple):
    """Sources, and the Python that runs them."""

    path: Path
    python: str

    def environment(self, cache: str) -> dict[str, str]:
        """Of a process that finds these sources, and keeps what it compiles in a folder."""
        return {**os.environ, "PYTHONPATH": str(self.path / "src"), "TANDEMLIFT_CACHE": cache}

    @classmethod
    def at(cls, path: Path) -> Checkout:
        """The checkout in a folder, with the environment that is there, or else this one."""
        own = path.resolve() / ".venv/bin/python"
        return cls(path.resolve(), str(own) if own.exists() else sys.executable)

    @property
    def about(self) -> str:
        """Its commit, and the versions that it runs with."""
        git = ["git", "-C", str(self.path), "describe", "--always", "--dirty"]
        versions = [self.python, "-c", VERSIONS.format(PACKAGES), str(Path(__file__).parent)]
        commit, said = (subprocess.run(c, capture_output=True, text=True, timeout=PATIENCE) for c in (git, versions))
        return f"`{self.path.name}` at {commit.stdout.strip()}, with {said.stdout.strip()}"


class Job(NamedTuple):
    """A row of the table: what a checkout does in an environment, and the targeted ratio to the base.

    `before`: what is done first, untimed, that leaves a warm cache; without it the cache is empty. `alone`: the base is
    spared it.
    """

    what: str
    measure: Callable[[Checkout, dict[str, str]], Spent]
    target: str = ""
    before: Callable[[Checkout, dict[str, str]], Spent] | None = None
    alone: bool = False


def process(
    command: list[str], environment: dict[str, str], until: str = "", more: Callable[[str], None] | None = None
) -> tuple[Spent, str]:
    """The time of a process until its end, and its output.

    With a pattern, until it prints that, and until `more`, asked with it, returns; then it is ended.
    """
    began = time.perf_counter()
    with tempfile.TemporaryFile("w+") as errors:
        p = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=errors, text=True)
        watch = threading.Timer(PATIENCE, p.kill)
        watch.start()
        try:
            said = output(p, until, more)
            wall = time.perf_counter() - began
        finally:
            os.kill(p.pid, signal.SIGTERM)  # also where it has ended: `wait4` alone may take its end away
            _, status, used = os.wait4(p.pid, 0)
            watch.cancel()
            p.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        if p.returncode and p.returncode != -signal.SIGTERM:
            raise Failed((errors.read().strip().splitlines() or [f"status {p.returncode}"])[-1])
    return Spent(wall, used.ru_utime + used.ru_stime), said


def output(p: subprocess.Popen[str], until: str, more: Callable[[str], None] | None) -> str:
    """The output of a process until its end, or until a pattern and the end of `more`."""
    assert p.stdout
    said = ""
    for line in iter(p.stdout.readline, ""):
        said += line
        if until and (match := re.search(until, line)):
            if more:
                more(match[0])
            return said
    if not until:
        os.waitid(os.P_PID, p.pid, os.WEXITED | os.WNOWAIT)  # it may print no more and still work
    return said


def script(code: str, mission: str, changes: dict[str, Any] | None = None) -> Callable[..., Spent]:
    """Run Python on a mission, as a whole process."""
    given = [mission, json.dumps(changes or {})]
    return lambda checkout, environment: process([checkout.python, "-c", code, *given], environment)[0]


def told(code: str, mission: str) -> Callable[..., Spent]:
    """Run Python on a mission, which says what it took."""

    def measure(checkout: Checkout, environment: dict[str, str]) -> Spent:
        return Spent(*json.loads(process([checkout.python, "-c", code, mission, "{}"], environment)[1]))

    return measure


def flown(address: str) -> None:
    """Wait until the flight of a live page has begun."""
    from websockets.sync.client import connect

    from tandemlift.apps.live.session.frames import read_frames

    fields: tuple[tuple[str, int], ...] = ()
    with connect(address.replace("http", "ws") + "ws", origin=address.rstrip("/"), ping_timeout=None) as socket:
        while True:
            told = socket.recv(PATIENCE)
            if isinstance(told, bytes):
                if fields and read_frames(fields, told)["time"][0] > 0.0:
                    return
            elif (text := json.loads(told))["type"] == "scene":
                fields = tuple((name, count) for name, count in text["fields"])


def command(*words: str, until: str = "", more: Callable[[str], None] | None = None) -> Callable[..., Spent]:
    """Run `tandemlift` with words, and a folder for what it writes."""

    def measure(checkout: Checkout, environment: dict[str, str]) -> Spent:
        with tempfile.TemporaryDirectory() as out:
            called = [checkout.python, "-m", "tandemlift", *words, f"--out={out}"]
            return process(called, environment, until, more)[0]

    return measure


def with_quadrotors(count: int) -> dict[str, Any]:
    """`iris` with so many quadrotors: two at the ends of the beam, another number on a circle."""
    import tandemlift as tl

    one = tl.load_mission("iris").vehicle.quadrotors[0].model_dump(mode="json", exclude_none=True)
    turns = [2.0 * math.pi * i / count + math.pi / 2.0 for i in range(count)]
    reach = max(1.0, 0.8 * count / (2.0 * math.pi)) if count > 1 else 0.0  # m: so that no rotors strike each other
    places = [[reach * math.cos(turn), reach * math.sin(turn), 0.075] for turn in turns]
    return {"vehicle.quadrotors": [{**one, "position": place} for place in places]}


def jobs() -> list[Job]:
    """All rows."""
    page, address = ("live", "zigzag", "--no-browser", "--port=0"), r"http://\S+"
    live, flying = command(*page, until=address), command(*page, until=address, more=flown)
    runs = {name: command("run", name, "--no-figures") for name in ("paper", "iris")}
    drawn, named, call = command("run", "paper"), script(BY_NAME, "paper"), told(CALL, "paper")
    firsts = {"paper": "20", "iris": "40", "zigzag": "40"}
    bests = {"paper": "8", "iris": "20", "zigzag": "20"}
    return [
        *[Job(f"`{name}`, empty cache, first step", script(FIRST, name), target) for name, target in firsts.items()],
        *[Job(f"`{name}`, empty cache, optimised", script(BEST, name), target) for name, target in bests.items()],
        Job("64 `iris` by `fly_many`, empty cache", script(BLOCK, "iris"), "20"),
        Job("`live zigzag`, empty cache, served", live),
        Job("`live zigzag`, empty cache, first step", flying, "20"),
        Job("`live zigzag`, warm, served", live, "1.25", live),
        *[Job(f"`run {name} --no-figures`, warm", run, "2", run) for name, run in runs.items()],
        Job("`run paper`, figures and report, warm", drawn, "2", drawn),
        Job("`import` of `tl.fly` and `tl.fly('paper')`, warm", named, "1.67", named),
        Job("`import` of `tl.fly`", script(IMPORT, "paper"), "1.67", named),
        Job("first `tl.fly('paper')`, warm, without the import", call, "1.67", named),
        *[
            Job(f"one `tl.fly` of `{name}`, optimised, warm", told(AGAIN, name), "1.25", script(BEST, name))
            for name in runs
        ],
        *[
            Job(f"`iris` × {n}, empty cache, first step", script(FIRST, "iris", with_quadrotors(n)), alone=True)
            for n in NUMBERS
        ],
    ]


def measured(job: Job, checkout: Checkout, caches: dict[Any, str]) -> Spent:
    """A job once, with an empty cache or a warm one."""
    if job.before is None:
        with tempfile.TemporaryDirectory() as cache:
            return job.measure(checkout, checkout.environment(cache))
    key = checkout, job.what
    environment = checkout.environment(caches.setdefault(key, f"{caches['root']}/{len(caches)}"))
    if not Path(environment["TANDEMLIFT_CACHE"]).exists():
        Path(environment["TANDEMLIFT_CACHE"]).mkdir()
        job.before(checkout, environment)
    return job.measure(checkout, environment)


def measure_all(chosen: list[Job], checkouts: list[Checkout], rounds: int) -> dict[str, Any]:
    """For each row a list of turns, each with the time of every checkout, or the reason that there is none."""
    results: dict[str, Any] = {job.what: [] for job in chosen}
    with tempfile.TemporaryDirectory() as root:
        caches: dict[Any, str] = {"root": root}
        for turn in range(rounds):
            for job in chosen:
                print(f"{turn + 1} of {rounds}: {job.what} …", file=sys.stderr, flush=True)
                if not isinstance(results[job.what], list):
                    continue
                try:
                    asked = checkouts[:1] if job.alone else checkouts
                    results[job.what].append([measured(job, checkout, caches) for checkout in asked])
                except Failed as error:
                    results[job.what] = str(error)
    return results


def row(job: Job, turns: Any) -> list[str]:
    """Cells of a row: medians, and the median over the pairs of the ratio of the base to it."""
    if not isinstance(turns, list):
        return [f"{job.what}. **Not measured: {turns}**", *[NO_RESULT] * 6, job.target]
    columns = list(zip(*turns, strict=True))
    times = [[median(s.wall for s in column), median(s.cpu for s in column)] for column in columns]
    ratios = [[b / a for a, b in zip(*pair, strict=True)] for pair in turns if len(pair) == 2]
    less = [median(r) for r in zip(*ratios, strict=True)] or [None, None]
    base = times[1] if len(times) == 2 else [None, None]
    return [job.what, *map(number, [*times[0], *base, *less]), f"≥ {job.target}" if job.target else ""]


HEADER = ("", "wall, s", "processor, s", "base: wall", "processor", "times faster: wall", "processor", "target")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--base", type=Path, metavar="PATH", help="another checkout to measure in pairs with this one")
    parser.add_argument("--rounds", type=int, default=3, help="turns that a median is taken over")
    parser.add_argument("--only", default="", metavar="PATTERN", help="measure only rows whose text has this")
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    options = parser.parse_args()
    checkouts = [Checkout.at(HERE), *([Checkout.at(options.base)] if options.base else [])]
    checkouts[0] = checkouts[0]._replace(python=sys.executable)
    machine, abouts = describe(PACKAGES), [checkout.about for checkout in checkouts]
    chosen = [job for job in jobs() if re.search(options.only, job.what)]
    results = measure_all(chosen, checkouts, options.rounds)
    print(heading(machine), *abouts, sep="\n\n", end="\n\n")
    print(table(HEADER, [row(job, results[job.what]) for job in chosen]))
    load = f"{os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else "unknown"
    print(f"\nMedians of {options.rounds}; load at the end {load}.")
    save(options.json, {"machine": machine, "checkouts": abouts, "rows": results})


if __name__ == "__main__":
    main()
