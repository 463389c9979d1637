"""Compiled loops: what is loaded when, what the cache sees, what the machine code is made of."""

import inspect
import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
<<<<<<< HEAD
from tandemlift.jit.cache import sources
=======
from patience import completed
>>>>>>> core

import tandemlift as tl
from tandemlift.kernels import LANES
from tandemlift.law import LAWS
from tandemlift.prepared import Prepared

PACKAGE = Path(tl.__file__).parent


def python(code, **environment):
    done = completed(
        [sys.executable, "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_numba_is_not_loaded_until_something_flies():
    code = """
import sys, tandemlift as tl
print("numba" in sys.modules, "numpy" in sys.modules)
tl.load_mission("paper")
print("numba" in sys.modules, "matplotlib" in sys.modules)
tl.fly
print("numba" in sys.modules, "matplotlib" in sys.modules)
"""
    assert python(code) == ["False", "False", "False", "False", "True", "False"]


def test_a_second_process_finds_the_loop_and_an_edit_of_any_law_loses_it(tmp_path):
    copy = tmp_path / "source"
    shutil.copytree(PACKAGE, copy / "tandemlift", ignore=shutil.ignore_patterns("__pycache__"))
    environment = {"PYTHONPATH": str(copy), "TANDEMLIFT_CACHE": str(tmp_path / "cache"), "PYTHONSAFEPATH": "1"}
    code = """
import tandemlift as tl
from tandemlift.prepared import Prepared, needs_compiling
mission = tl.load_mission("one-push", {"mission.duration": 1.0})
print(needs_compiling(mission))
tl.fly(mission)
single = Prepared(mission).kernels.single
print(sum(single.stats.cache_hits.values()), sum(single.stats.cache_misses.values()), tl.__file__)
"""
    first, second = python(code, **environment), python(code, **environment)
    assert first[:3] == ["True", "0", "1"]
    assert second[:3] == ["False", "1", "0"]
    assert first[3].startswith(str(copy))
    with (copy / "tandemlift" / "laws" / "rotation.py").open("a") as law:
        law.write("# an edit\n")
    assert python(code.partition("tl.fly")[0], **environment) == ["True"]


def test_two_variants_whose_parameters_are_equal_tuples_fly_differently():
    tanh = tl.fly(tl.load_mission("one-push", {"controller.switching": "tanh", "initial.position": 0.1}))
    saturation = tl.fly(tl.load_mission("one-push", {"controller.switching": "saturation", "initial.position": 0.1}))
    assert not np.array_equal(tanh["thrust"], saturation["thrust"])


@pytest.fixture(scope="module")
def block_code(tmp_path_factory):
    """The block loop of `one-push`, compiled afresh (a loop from the cache shows no code)."""
    before = os.environ.get("TANDEMLIFT_CACHE")
    os.environ["TANDEMLIFT_CACHE"] = str(tmp_path_factory.mktemp("cache"))
    try:
        from tandemlift import prepared
        from tandemlift.kernels import Kernels

        p = Prepared(tl.load_mission("one-push", {"mission.duration": 0.1}))
        prepared.KERNELS[p.variant] = Kernels(p.flying, p.given)
        tl.fly_many([p.mission] * 2)
        block = prepared.KERNELS.pop(p.variant).block
        return block, next(iter(block.inspect_llvm().values()))
    finally:
        os.environ.pop("TANDEMLIFT_CACHE")
        if before is not None:
            os.environ["TANDEMLIFT_CACHE"] = before


def test_the_block_loop_works_on_all_lanes_at_once(block_code):
    _, code = block_code
    vectors = [f"llvm.fma.v{width}f64" for width in (2, 4, 8, LANES)]
    assert any(name in code for name in vectors)


@pytest.mark.parametrize("name", ["exp", "tanh", "sin", "cos", "atan2", "pow", "log", "floor"])
def test_the_block_loop_calls_no_function_of_the_c_library(block_code, name):
    _, code = block_code
    assert f"@{name}(" not in code
    assert f"@llvm.{name}." not in code or name == "floor"


def test_the_block_loop_is_compiled_without_python_objects(block_code):
    block, _ = block_code
    assert all(not overload.objectmode for overload in block.overloads.values())


def test_every_law_that_a_loop_may_be_made_of_is_in_the_key_of_its_cache():
    known = set(sources(()))
    own = {function for function in LAWS if function.__module__.startswith("tandemlift.")}
    assert len(own) > 200
    assert {Path(inspect.getfile(function)) for function in own} <= known
