"""What cannot be traced is refused with the law, its file and line, and what is allowed; nothing is written."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from listings import GUIDE, LAW
from patience import completed

import tandemlift as tl
from tandemlift.compiler.machine_code.functions import compiled, written
from tandemlift.compiler.tracer import TraceError, graph
from tandemlift.core.law import LAWS, law
from tandemlift.core.vector import Vec3
from tandemlift.parts.controllers import load_controller

HERE = "    attitude = euler_from_quaternion(state.attitude)\n"
LINE = LAW[: LAW.index(HERE)].count("\n") + 1
TWO_WAYS = "choose by where(condition, a, b), minimum, maximum, clip of tandemlift.core.algebra"
NO_NUMBER = "takes a plain number out of its data: use the functions of tandemlift.core.algebra"
FAILS = "fails on symbols, TypeError: "

LEVEL = np.eye(1, 16, 6)[0]

WRONG = {  # what stands in the law, and why it is refused
    "a branch": ("if e.x > 0.0: e = e * 2.0", f"branches on data: {TWO_WAYS}"),
    "both of two": ("e = e * (e.x > 0.0 and e.y > 0.0)", f"branches on data: {TWO_WAYS}"),
    "a plain number": ("e = e * float(e.x)", NO_NUMBER),
    "a helper that makes plain numbers": ("import tandemlift.core.types as o; e = e * o.flat(e)[0]", NO_NUMBER),
    "a power": ("e = e * e.x**2", "takes a power by **: write a product, or power(x, p) of tandemlift.core.algebra"),
    "a number taken apart": ("e = e * (sum(e.x) if hasattr(e.x, 'node') else 1.0)", "takes a number apart as if it"),
    "bits of a number": ("e = e * ((e.x & e.y) if hasattr(e.x, 'node') else 1.0)", "joins a number and a number bit"),
    "a remainder": ("e = e * (e.x % 2.0)", f"{FAILS}unsupported operand"),
    "a rounded number": ("e = e * round(e.x)", NO_NUMBER),
    "a function of NumPy": ("import numpy as np; e = e * np.sin(e.x)", FAILS),
    "an attribute of floats": ("e = e * e.x.is_integer()", "fails on symbols, AttributeError: "),
}


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Write the guide's controller with a line more."""
    monkeypatch.chdir(tmp_path)

    def write(line: str, text: str = LAW) -> Path:
        path = tmp_path / "my_pd.py"
        path.write_text(text.replace(HERE, f"    {line}\n{HERE}", 1), "utf-8")
        return path

    return write


def refusal(run):
    with pytest.raises(tl.InputError) as refused:
        run()
    return str(refused.value)


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_a_law_that_cannot_be_traced_is_refused_with_file_line_and_the_ways_out(wrong, own):
    line, why = wrong
    path = own(line)
    mission = tl.load_mission("hover", {"mission.duration": 0.1}, controller=load_controller(path))
    said = refusal(lambda: tl.fly(mission))
    assert said.startswith(f"{path}, line {LINE}: my_pd() {why}")
    assert said.endswith("; or register the controller with compiled=False")
    assert "\n" not in said


def test_so_it_is_in_many_flights_and_by_the_pilot_as_an_object(own):
    path = own(WRONG["a branch"][0])
    mission = tl.load_mission("hover", {"mission.duration": 0.1}, controller=load_controller(path))
    for run in (lambda: tl.fly_many([mission] * 2), lambda: tl.Pilot(mission).step(LEVEL)):
        assert refusal(run).startswith(f"{path}, line {LINE}: my_pd() branches on data")


def test_what_the_guide_says_of_it_is_real(own):
    said = re.search(r"^error: (/home/me/my_pd\.py, line 61: .*)$", GUIDE, re.MULTILINE)[1]
    path = own("")
    path.write_text(LAW.replace("    e, de = ", "    if state.position.z > 0.0: pass\n    e, de = ", 1))
    mission = tl.load_mission("hover", {"mission.duration": 0.1}, controller=load_controller(path))
    found = refusal(lambda: tl.fly(mission))
    assert re.sub(r"line \d+", "line 61", found) == said.replace("/home/me/my_pd.py", str(path))


def test_a_law_that_makes_too_many_operations_is_refused(own, monkeypatch):
    assert graph.MOST_NODES == 10**6
    monkeypatch.setattr(graph, "MOST_NODES", 20_000)
    path = own("for i in range(30_000): e = e * (1.0 + 1e-9 * i)")
    mission = tl.load_mission("hover", {"mission.duration": 0.1}, controller=load_controller(path))
    said = refusal(lambda: tl.fly(mission))
    assert said.startswith(f"{path}, line {LINE}: my_pd() makes more than 20,000 operations: write it with fewer; or")


def test_a_memory_of_another_layout_is_refused_even_if_the_law_cannot_be_tried(own):
    """It divides by zero in plain Python, which machine code may well do."""
    text = LAW.replace("Memory(integral)\n", "Memory((integral, integral))\n")
    path = own("e = e + e * (0.0 / (measured.push.x - 0.5))", text)
    mission = tl.load_mission("hover", {"mission.duration": 0.1}, controller=load_controller(path))
    first = LAW[: LAW.index("@control.register")].count("\n") + 1
    for run in (lambda: tl.fly(mission), lambda: tl.Pilot(mission).step(LEVEL)):
        said = refusal(run)
        assert said.startswith(f"{path}, line {first}: my_pd() returns another layout: ")
        assert "memory.controller" in said


def test_the_same_law_called_from_python_flies(own):
    text = LAW.replace("@control.register(Gains)", "@control.register(Gains, compiled=False)")
    lines = "\n    ".join(WRONG[kind][0] for kind in ("a branch", "a plain number", "a function of NumPy"))
    mission = tl.load_mission("hover", {"mission.duration": 0.1}, controller=load_controller(own(lines, text)))
    assert tl.fly(mission).ending is None


def test_the_command_line_says_so_in_one_line_and_writes_nothing(own, tmp_path):
    path = own(WRONG["a branch"][0])
    command = [sys.executable, "-m", "tandemlift", "run", "hover", "--controller", "my_pd.py", "--out", "deep/er"]
    done = completed(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    lines = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert len(lines) == 1
    assert "Traceback" not in done.stderr
    assert lines[0].startswith(f"error: {path}, line {LINE}: my_pd() {WRONG['a branch'][1]}")
    assert lines[0].endswith("or register the controller with compiled=False")
    assert [p.name for p in tmp_path.iterdir()] == ["my_pd.py"]


# Laws of this package


@pytest.fixture
def ours():
    """Functions as if they stood in a file of this package; the laws among them are forgotten afterwards."""
    count = len(LAWS)

    def define(source):
        scope = {"__name__": "imagined", "law": law, "Vec3": Vec3}
        exec(compile(source, str(Path(tl.__file__).parent / "parts" / "imagined.py"), "exec"), scope)
        return scope

    yield define
    del LAWS[count:]


def test_a_law_of_this_package_is_named_itself_and_no_other_way_is_offered(ours):
    scope = ours(
        "def helper(x):\n    return float(x)\n\n\n@law\ndef wrong(x):\n    y = x + 1.0\n    return helper(y)\n"
    )
    with pytest.raises(
        TraceError, match=r"imagined\.py, line 8: wrong\(\) takes a plain number .* tandemlift\.core\.algebra$"
    ):
        compiled(scope["wrong"], 0.0)


def test_a_mistake_in_a_law_of_this_package_is_no_bad_input(ours):
    scope = ours("@law\ndef wrong(x):\n    return x.y\n")
    with pytest.raises(AttributeError):
        compiled(scope["wrong"], 0.0)


def test_a_law_that_never_ends_is_stopped_by_the_number_of_its_operations(monkeypatch):
    def endless(x):
        while True:
            x = x * x + 1.0

    monkeypatch.setattr(graph, "MOST_NODES", 1000)
    with pytest.raises(TraceError, match=r"test_refused\.py, line \d+: endless\(\) makes more than 1,000 operations"):
        written(endless, 0.0)
