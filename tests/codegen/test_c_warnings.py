"""C compilers have nothing to say about the C of a mission: all its files, with all warnings as errors.

What other tests compile, such as `zigzag` in test_c_flights.py, they compile with the same options.
"""

import itertools
import subprocess

import pytest
from c_flights import STRICT
from random_missions.generate import random_family

import tandemlift as tl
from tandemlift.codegen.c_package import code_texts, written
from tandemlift.missions import built_in
from tools import need

pytestmark = pytest.mark.thorough

CORTEX_M7 = ("-mcpu=cortex-m7", "-mthumb", "-mfpu=fpv5-d16", "-mfloat-abi=hard")
COMPILERS = {"gcc": (), "clang": (), "aarch64-linux-gnu-gcc": (), "arm-none-eabi-gcc": CORTEX_M7}


def complaints(folder, compiler, *options):
    """What a compiler says about the sources of a folder."""
    said = ""
    for source in sorted(folder.glob("*.c")):
        command = [compiler, *STRICT, *options, "-c", source, "-o", folder / "object.o"]
        said += subprocess.run(command, check=False, capture_output=True, text=True).stderr
    return said


def in_c(mission, folder, single=False):
    """The folder with the C of a mission, without its self-tests, for which it would have to fly."""
    written(code_texts(mission, single), folder)
    return folder


def test_gcc_does_not_warn_of_single_precision_nor_of_self_tests(tmp_path):
    need("gcc")
    tl.compile_mission(tl.load_mission("paper"), "c", tmp_path, single=True)
    assert not complaints(tmp_path, "gcc", "-O1")


@pytest.mark.targets
@pytest.mark.parametrize("name", sorted(built_in()))
def test_no_compiler_warns_of_a_mission(name, tmp_path):
    need(*COMPILERS)
    for single in (False, True):
        folder = in_c(tl.load_mission(name), tmp_path / str(single), single)
        for compiler, options in COMPILERS.items():
            assert not complaints(folder, compiler, "-O2", *options)


def portable(family):
    """The missions of a random family that C can fly."""
    for drawn in random_family(25, family, 4):
        if not drawn.mission.changes:
            yield drawn


@pytest.mark.targets
@pytest.mark.parametrize("family", range(12))
def test_no_compiler_warns_of_random_missions(family, tmp_path):
    need("gcc", "clang")
    for drawn in itertools.islice(portable(family), 1):
        folder = in_c(drawn.mission, tmp_path / str(drawn.member))
        for compiler in ("gcc", "clang"):
            assert not complaints(folder, compiler, "-O1"), drawn.changes
