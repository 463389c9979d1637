"""Ctrl-C ends every verb, and a script, whatever is being done: one line, status 130, nothing left behind."""

import contextlib
import os
import random
import signal
import subprocess
import sys
import time

import pytest
import slow_compiler
from patience import COMPILING, PATIENCE, completed, until

pytestmark = [pytest.mark.skipif(os.name != "posix", reason="signals of POSIX"), pytest.mark.thorough]
STOPPED = "stopped; nothing more is written"
OWN = ("Compil", "flying", "warning")  # lines that come before it
FLYING = """
import tandemlift as tl
tl.fly_many([tl.load_mission("hover", {"mission.duration": 1.0})] * 9)
missions = [tl.load_mission("hover", {"mission.duration": 1e6, "mission.log_interval": 1e3})] * 17
print("ready", flush=True)
tl.fly_many(missions, keep="metrics")
"""
COMPILING_ONE = """
import slow_compiler, tandemlift as tl
slow_compiler.make_slow()
print("ready", flush=True)
{}
"""
MANY = 'tl.fly_many([tl.load_mission("hover")] * 17)'
ONE = 'tl.fly(tl.load_mission("hover"))'


class Begun:
    """A process in a folder of its own, with an empty cache; `main`: what Python runs."""

    def __init__(self, folder, *main):
        self.folder = folder / "here"
        self.folder.mkdir(parents=True)
        self.goes_on = folder / "goes on"
        environment = {
            **os.environ,
            "TANDEMLIFT_CACHE": str(folder / "cache"),
            "COMPILES_UNTIL": str(self.goes_on),
            "PYTHONPATH": os.pathsep.join(sys.path),
        }
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(
            [sys.executable, "-W", "ignore", *main],
            cwd=self.folder,
            stdout=pipe,
            stderr=pipe,
            text=True,
            env=environment,
        )

    def check_shown(self, start):
        """Wait until a line of its errors begins like this."""
        assert any(line.startswith(start) for line in iter(self.process.stderr.readline, ""))

    def interrupted(self):
        """Status, output and lines of errors after Ctrl-C."""
        self.process.send_signal(signal.SIGINT)
        try:
            out, err = self.process.communicate(timeout=PATIENCE)
        finally:
            self.process.kill()
        lines = [line for line in err.replace("\r", "\n").splitlines() if line.strip()]
        return self.process.returncode, out, lines


@pytest.fixture
def begin():
    """Begin processes, all of which end with the test."""
    begun = []

    def one(*args):
        begun.append(Begun(*args))
        return begun[-1]

    yield one
    for each in begun:
        each.process.kill()
        each.process.communicate(timeout=PATIENCE)


def test_at_any_moment_it_ends_with_one_line(begin, tmp_path):
    chance = random.Random(7)
    for i in range(2):
        begun = begin(tmp_path / str(i), "-m", "tandemlift", "run", "iris")
        until((begun.folder / "out").exists, "its folder")
        time.sleep(chance.uniform(0.0, 2.5))  # wherever it is by then
        status, _, lines = begun.interrupted()
        if status in (0, 1):
            continue  # it was over
        assert (status, [line for line in lines if not line.startswith(OWN)]) == (130, [STOPPED])


@pytest.mark.parametrize("verb", ["run", "compare"])
def test_while_it_compiles_it_ends_at_once_and_leaves_nothing_and_the_next_start_tells_of_it_again(
    verb, begin, tmp_path
):
    begun = begin(tmp_path, slow_compiler.__file__, verb, "hover")
    begun.check_shown("Compiling")
    status, out, lines = begun.interrupted()  # its compiler would never end
    assert (status, out, lines) == (130, "", [STOPPED])
    assert sorted(begun.folder.rglob("*")) == []
    if verb == "compare":
        return
    command = [sys.executable, "-m", "tandemlift", "run", "hover", "--no-figures", "--set", "mission.duration=0.5"]
    environment = {**os.environ, "TANDEMLIFT_CACHE": str(tmp_path / "cache")}
    told = [completed(command, cwd=tmp_path, capture_output=True, text=True, env=environment).stderr for _ in range(2)]
    assert "Compiled the flight loop in " in told[0]
    assert told[1] == ""


def test_a_script_is_interrupted_while_many_fly(begin, tmp_path):
    begun = begin(tmp_path, "-c", FLYING)
    assert begun.process.stdout.readline() == "ready\n"
    time.sleep(1.0)
    status, _, lines = begun.interrupted()
    assert (status, lines[-1]) == (-signal.SIGINT, "KeyboardInterrupt")


@pytest.mark.parametrize("fly", [ONE, MANY], ids=["one", "many"])
def test_a_script_is_interrupted_while_it_compiles_and_ends_once_the_compiler_does(fly, begin, tmp_path):
    begun = begin(tmp_path, "-c", COMPILING_ONE.format(fly))
    assert begun.process.stdout.readline() == "ready\n"
    time.sleep(2.0)
    begun.process.send_signal(signal.SIGINT)
    begun.check_shown("KeyboardInterrupt")
    begun.goes_on.touch()
    begun.process.communicate(timeout=PATIENCE)
    assert begun.process.returncode == -signal.SIGINT


def test_a_live_page_that_still_compiles_ends_at_once(begin, tmp_path):
    begun = begin(tmp_path, slow_compiler.__file__, "live", "hover", "--no-browser", "--port=0")
    assert "http://" in begun.process.stdout.readline()
    begun.check_shown("Compiling")
    status, out, lines = begun.interrupted()
    assert (status, lines) == (0, [])
    assert out.splitlines()[-1] == "stopped"


def test_processes_that_optimise_are_ended_with_it(begin, tmp_path):
    begun = begin(tmp_path, "-m", "tandemlift", "live", "zigzag", "--no-browser", "--port=0")
    assert "http://" in begun.process.stdout.readline()
    children = f"/proc/{begun.process.pid}/task/"

    def optimising():
        found = []
        for task in os.listdir(children):
            with contextlib.suppress(OSError), open(f"{children}{task}/children", encoding="ascii") as file:
                found += file.read().split()  # unless this thread has just ended
        return found

    if not os.path.exists(f"{children}{begun.process.pid}/children"):
        pytest.skip("the system does not tell of children")
    beside = until(optimising, "a process that optimises", COMPILING)
    begun.interrupted()
    until(lambda: not any(os.path.exists(f"/proc/{pid}") for pid in beside), "its end")
