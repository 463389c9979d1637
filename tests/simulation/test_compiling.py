"""Compiled loops: what is loaded when, what decides their key, what the machine code is made of."""

import functools
import inspect
import os
import re
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from patience import completed

import tandemlift as tl
from tandemlift.compiler.machine_code import machine, store
from tandemlift.compiler.machine_code.store import key_of, sources
from tandemlift.core.law import LAWS
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LANES

PARTS = {"wind.model": "air", "detection.model": "residual", "supervision.model": "on"}  # beside those of a corridor
LOOPS = {"one-push": {}, "four": {}, "zigzag": PARTS}  # changes by mission: between them all parts of a loop
PACKAGE = Path(tl.__file__).parent
LEVELS = {"quick": machine.QUICK, "best": machine.BEST, "best of blocks": machine.BEST_OF_VECTORS}


def check_run(code, **environment):
    command = [sys.executable, "-W", "error", "-c", code]
    done = completed(command, capture_output=True, text=True, env={**os.environ, **environment})
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_no_compiler_is_loaded_until_something_flies():
    code = """
import sys, tandemlift as tl
print("numpy" in sys.modules)
from tandemlift.missions import built_in
missions = [tl.load_mission(name) for name in built_in()]
print([m for m in ("llvmlite", "scipy", "mujoco", "matplotlib", "numba") if m in sys.modules])
tl.fly(tl.load_mission("paper", {"mission.duration": 0.1}))
print([m for m in ("llvmlite", "matplotlib", "numba") if m in sys.modules])
"""
    assert check_run(code) == ["False", "[]", "['llvmlite']"]


@pytest.mark.thorough
def test_a_second_process_finds_the_code_and_so_does_one_after_an_edit_that_changes_no_step(tmp_path):
    copy = tmp_path / "source"
    shutil.copytree(PACKAGE, copy / "tandemlift", ignore=shutil.ignore_patterns("__pycache__"))
    environment = {"PYTHONPATH": str(copy), "TANDEMLIFT_CACHE": str(tmp_path / "cache"), "PYTHONSAFEPATH": "1"}
    code = """
import tandemlift as tl
from tandemlift.compiler.machine_code import machine
made, compiled = [], machine.compiled
machine.compiled = lambda *args: made.append(args) or compiled(*args)
flight = tl.fly(tl.load_mission("one-push", {"mission.duration": 0.1}))
print(len(made), flight["thrust"].sum().hex(), tl.__file__)
"""
    first, second = check_run(code, **environment), check_run(code, **environment)
    assert [first[0], second[0]] == ["1", "0"]
    assert first[1:] == second[1:]
    assert first[2].startswith(str(copy))
    law = copy / "tandemlift" / "parts" / "mechanics" / "rotation.py"
    text = law.read_text("utf-8")
    law.write_text(text.replace("(the direction of thrust)", "(of thrust)") + "# an edit\n", "utf-8")
    assert check_run(code, **environment) == ["0", *first[1:]]
    law.write_text(text.replace("1.0 - 2.0 * (q.x * q.x", "1.0 - 2.5 * (q.x * q.x"), "utf-8")
    assert check_run(code, **environment)[0] == "1"


def test_an_edit_of_any_source_changes_the_key(monkeypatch):
    value = FlightPlan(tl.load_mission("one-push")).model
    before, content = key_of(value), store.content
    assert len(sources()) > 50
    for path in sources()[::8]:
        edit = lambda p, edited=path: content(p) + b"#" * (p == edited)  # noqa: E731
        monkeypatch.setattr(store, "content", edit)
        assert key_of(value) != before
    monkeypatch.setattr(store, "content", content)
    assert key_of(value) == before


def test_other_versions_another_processor_and_another_layout_have_other_keys(monkeypatch):
    changes = {"controller.switching": "saturation"}
    paper, other = (FlightPlan(tl.load_mission("paper", c)).model for c in ({}, changes))
    keys = [key_of(paper), key_of(other), key_of(paper, "loop", 8)]
    monkeypatch.setattr(machine, "processor", lambda: ("another", "+fma"))
    keys.append(key_of(paper))
    monkeypatch.setattr("llvmlite.__version__", "0.0.0")
    keys.append(key_of(paper))
    assert len(set(keys)) == len(keys)


def test_two_variants_whose_parameters_are_equal_tuples_fly_differently():
    tanh = tl.fly(tl.load_mission("one-push", {"controller.switching": "tanh", "initial.position": [0.1, 0.1, 0.1]}))
    saturation = tl.fly(
        tl.load_mission("one-push", {"controller.switching": "saturation", "initial.position": [0.1, 0.1, 0.1]})
    )
    assert not np.array_equal(tanh["thrust"], saturation["thrust"])


@functools.cache
def text_of(name, lanes):
    """The module of a built-in mission's loop."""
    return FlightPlan(tl.load_mission(name, LOOPS[name])).loop_code.written("loop", lanes).text


@pytest.mark.parametrize("name", LOOPS)
def test_the_loop_of_a_block_works_on_all_lanes_at_once(name):
    text = text_of(name, LANES)
    assert f"call <{LANES} x double> @llvm.fma.v{LANES}f64(" in text
    alone, together = (len(re.findall(rf"= f(?:add|sub|mul|div) {kind}", text)) for kind in ("double", "<8 x double>"))
    assert together > 10 * alone  # times, and what else all lanes share


@pytest.mark.parametrize(
    ("name", "level", "lanes"),
    [
        ("zigzag", "quick", 1),
        ("zigzag", "quick", LANES),
        ("one-push", "best", 1),
        ("one-push", "best of blocks", LANES),
    ],
)
def test_machine_code_needs_nothing_from_outside_but_moves_of_memory(name, level, lanes):
    """What an object does not define would come from a library."""
    if not sys.platform.startswith("linux"):
        pytest.skip("reads ELF")
    missing = undefined(machine.compiled(text_of(name, lanes), LEVELS[level]))
    assert missing <= {"memset", "memcpy", "memmove"}


def undefined(code):
    """The names that an ELF object of 64 bits asks for."""

    def word(at, size):
        return int.from_bytes(code[at : at + size], "little")

    if code[:5] != b"\x7fELF\x02":
        raise ValueError("no ELF object of 64 bits")
    sections = [word(40, 8) + i * word(58, 2) for i in range(word(60, 2))]
    table = next(s for s in sections if word(s + 4, 4) == 2)
    names = word(sections[word(table + 40, 4)] + 24, 8)
    begin, length = word(table + 24, 8), word(table + 32, 8)
    places = [names + word(at, 4) for at in range(begin, begin + length, 24) if word(at + 6, 2) == 0 and word(at, 4)]
    return {code[at : code.index(b"\0", at)].decode() for at in places}


def test_every_law_that_a_loop_may_be_made_of_is_in_its_key():
    known = set(sources())
    own = {function for function in LAWS if function.__module__.startswith("tandemlift.")}
    own = {function for function in own if not function.__module__.endswith(".outcome")}  # after a flight
    own = {function for function in own if ".codegen." not in function.__module__}  # of C alone
    assert own
    assert {Path(inspect.getfile(function)) for function in own} <= known
