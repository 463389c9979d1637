"""Loading a controller file of one's own: what is refused, what is kept, what is compiled."""

import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from listings import GUIDE, LAW, PLAIN
from patience import completed

import tandemlift as tl
from tandemlift.parts.controllers import CONTROLLERS, ControllerTable, controller, load_controller, register

AWAY = {"mission.duration": 1.0, "initial.position": [0.1, 0.0, 0.0]}


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Write a controller file of one's own beside which the test runs."""
    monkeypatch.chdir(tmp_path)

    def write(text: str, name: str = "my_pd.py") -> str:
        Path(name).write_text(text, "utf-8")
        return name

    return write


def edited(text: str, *changes: tuple[str, str]) -> str:
    for before, after in changes:
        at = text.index(before)  # a ValueError, if it is not there
        text = text[:at] + after + text[at + len(before) :]
    return text


CACHED = """
import sys
import tandemlift as tl
from tandemlift.compiler.machine_code import machine
made, compiled = [], machine.compiled
machine.compiled = lambda *args: made.append(args) or compiled(*args)
tl.fly(tl.load_mission("hover", {"mission.duration": 0.1}, controller=tl.load_controller(sys.argv[1])))
print(len(made))
"""


HELPER = """
from my_numbers import FACTOR
from tandemlift.core.law import law

@law
def scaled(v):
    return v * FACTOR
"""
IMPORTED = "from my_helpers import scaled"


@pytest.mark.thorough
def test_a_second_process_finds_the_compiled_law_until_what_it_computes_changes(own, tmp_path):
    """Each process imports all files anew; a comment changes no law, but a law called or a number read does."""
    called = ("tilt - attitude.angles", "scaled(tilt - attitude.angles)")
    text = edited(LAW, called, ("class Settings", f"{IMPORTED}\n\n\nclass Settings"))
    folders = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "TANDEMLIFT_CACHE": str(tmp_path / "cache"), "PYTHONPATH": folders}
    command, made = [sys.executable, "-B", "-c", CACHED, "my_pd.py"], []
    softer = HELPER.replace("* F", "* 0.5 * F")
    for file, helper, factor in (
        (text, HELPER, 0.9),
        (text + "\n# edited\n", HELPER, 0.9),
        (text, softer, 0.9),
        (text, softer, 0.8),
    ):
        own(file)
        own(helper, "my_helpers.py")
        own(f"FACTOR = {factor}", "my_numbers.py")
        made.append(int(completed(command, capture_output=True, text=True, env=environment, check=True).stdout))
    assert made == [1, 0, 1, 1]
    assert len(list((tmp_path / "cache").rglob("*-quick.o"))) == 3


def test_a_law_flies_as_it_was_loaded_and_once_edited_as_edited(own):
    """In one process, also where the line and the name are what they were, and the file has changed before a flight."""

    def loaded(text: str) -> tl.Mission:
        return tl.load_mission("hover", AWAY, controller=load_controller(own(text)))

    softer = edited(LAW, ("e * k.stiffness", "e * (k.stiffness * 0.5)"))
    mission = loaded(LAW)
    own(softer)
    first, second, third = tl.fly(mission), tl.fly(loaded(softer)), tl.fly(loaded(LAW))
    assert np.array_equal(first["position"], third["position"])
    assert np.abs(first["position"] - second["position"]).max() > 1e-3


def test_an_unchanged_file_is_run_once_and_an_edited_one_anew(own):
    file = own(LAW)
    first = load_controller(file)
    assert load_controller(file) is first
    own(edited(LAW, ("stiffness: Positive3 = key(4.0,", "stiffness: Positive3 = key(5.0,")))
    second = load_controller(file)
    assert second is not first
    assert tl.load_mission("hover", controller=second).controller.stiffness == (5.0, 5.0, 5.0)
    assert not list(Path().glob("__pycache__"))


def test_a_mission_from_before_a_controller_was_edited_must_be_loaded_again(own):
    before = tl.load_mission("hover", controller=load_controller(own(LAW)))
    load_controller(own(LAW + "\n"))
    with pytest.raises(tl.InputError, match=r"my_pd\.py has changed since this was made: its digest was \w{16}, "):
        tl.fly(before)


def test_a_controller_from_before_its_file_was_edited_must_be_loaded_again(own):
    before = load_controller(own(LAW))
    load_controller(own(LAW + "\n"))
    with pytest.raises(tl.InputError, match="'my-pd' is not the one registered last by that name"):
        tl.load_mission("hover", controller=before)


IMPORT = ("Vec3, clip, law", "Vec3, clop, law")
RETURN = ("return Command(Wrench(total_thrust(attitude, force), moment), tilt), Memory(integral)", "return {}")
WRONG_FILES = {
    "no controller": ((('@register("my-pd", Settings)\n', ""),), "my_pd.py: registers 0 controllers"),
    "two controllers": (
        (('@register("my-pd", Settings)\n', '@register("my-pd", Settings)\n@register("second", Settings)\n'),),
        "my_pd.py: registers 2 controllers; it must register one",
    ),
    "a failing import": (
        (IMPORT,),
        "my_pd.py, line 5: ImportError: cannot import name 'clop' from 'tandemlift.core.algebra'",
    ),
    "a typo at its top": ((("class Memory(NamedTuple)", "class Memory(NamedTupel)"),), "NameError: name 'NamedTupel'"),
    "bad syntax": (
        (("def start(s, vehicle, step):", "def start(s, vehicle, step)"),),
        "line 72: SyntaxError: expected",
    ),
    "an exit": ((("class Gains", "raise SystemExit(3)\nclass Gains"),), "line 29: SystemExit: 3"),
    "settings of another kind": ((("(ControllerTable)", ""),), "its settings must be a class derived from Controller"),
    "a name that is taken": ((('"my-pd"', '"nftsmc"'),), "the name 'nftsmc' is taken by the controller in nftsmc.py"),
    "a name that is none": ((('"my-pd"', '"my pd"'),), "a controller cannot be named 'my pd'"),
    "a helper that is no law": ((("@law\n", ""),), "calls wanted_moment(), which is no law: mark it @law"),
}
WRONG_LAWS = {
    "a typo in the law": ((("state.velocity\n", "state.velocty\n"),), "line 61: AttributeError: 'State' object has no"),
    "an unknown name": ((("* k.mass", "* mass"),), "line 64: NameError: name 'mass' is not defined"),
    "no memory": (
        ((RETURN[0], RETURN[1].format("Command(Wrench(total_thrust(attitude, force), moment), tilt)")),),
        "my_pd() must return (Command, memory), not Command(Wrench(number, Vec3), Vec3)",
    ),
    "another memory": ((("Memory(integral)\n", "integral\n"),), "starts as Memory(Vec3) and cannot become Vec3"),
    "another command": (
        ((RETURN[0], RETURN[1].format("Command(total_thrust(attitude, force), tilt), Memory(integral)")),),
        "must return Command(Wrench(number, Vec3), Vec3) and the memory, not Command(number, Vec3) and the memory",
    ),
    "nothing": (((RETURN[0], "pass"),), "my_pd() must return (Command, memory), not NoneType"),
    "gains without a law": ((("@control.register(Gains)\n", ""),), "mark one @control.register(Gains)"),
    "an array in the gains": (
        (("stiffness=vec3(s.stiffness)", "stiffness=vehicle.inertia"),),
        "gains.stiffness is ndarray; it must be a number, a Vec3 or a NamedTuple of them",
    ),
    "text in the gains": ((("step=step", "step='1 ms'"),), "gains.step is str"),
    "a list for the memory": ((("Memory(ZERO)", "[0.0]"),), "memory is list; it must be a NamedTuple"),
    "a start without gains": (
        (("return gains, Memory", "return Memory"),),
        "must return (gains, memory), not Memory(Vec3)",
    ),
    "a list of gains and memory": (
        (("return gains, Memory(ZERO)", "return [gains, Memory(ZERO)]"),),
        "must return (gains, memory), not list",
    ),
    "a typo in start": ((("vehicle.mass", "vehicle.mas"),), "line 75: AttributeError: 'Vehicle' object has no"),
    "a default that is not allowed": ((("key(4.0", "key(-4.0"),), "controller.stiffness: must be one number or a list"),
}


@pytest.mark.parametrize("wrong", WRONG_FILES.values(), ids=WRONG_FILES)
def test_a_wrong_file_is_refused_and_leaves_nothing_behind(wrong, own):
    changes, piece = wrong
    before, modules = dict(CONTROLLERS), set(sys.modules)
    with pytest.raises(tl.InputError) as refused:
        load_controller(own(edited(LAW, *changes)))
    assert piece in str(refused.value)
    assert str(refused.value).startswith("controller file my_pd.py")
    assert before == CONTROLLERS
    assert set(sys.modules) == modules


@pytest.mark.parametrize("wrong", WRONG_LAWS.values(), ids=WRONG_LAWS)
def test_a_wrong_law_is_refused_before_it_is_compiled(wrong, own):
    changes, piece = wrong
    with pytest.raises(tl.InputError) as refused:
        tl.fly(tl.load_mission("hover", controller=load_controller(own(edited(LAW, *changes)))))
    assert piece in str(refused.value)
    assert len(str(refused.value).splitlines()) == 1


def test_the_errors_of_the_guide_are_real(own):
    written = re.findall(r"^error: (?!/)(.*)$", GUIDE, re.MULTILINE)  # the one with a path is in test_refused.py
    files = [WRONG_FILES[name][0] for name in ("a failing import", "a helper that is no law")]
    laws = [WRONG_LAWS[name][0] for name in ("a typo in the law", "another memory")]
    ways = [*((changes, {}) for changes in files + laws), ((), {"controller.stifness": 9})]
    for line, (changes, given) in zip(written, ways, strict=True):
        with pytest.raises(tl.InputError) as refused:
            tl.fly(tl.load_mission("hover", given, controller=load_controller(own(edited(LAW, *changes)))))
        assert str(refused.value).startswith(line)


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    for path in (tmp_path / "absent.py", tmp_path):
        with pytest.raises(tl.InputError, match="does not exist"):
            load_controller(path)


def test_files_of_the_same_name_in_two_folders_fly_side_by_side(own):
    Path("other").mkdir()
    first = load_controller(own(PLAIN))
    second = load_controller(own(edited(PLAIN, ('"my-pd-plain"', '"my-other-pd"')), "other/my_pd.py"))
    for chosen in (first, second):
        assert tl.fly(tl.load_mission("hover", {"mission.duration": 0.01}, controller=chosen)).ending is None


def test_the_same_file_elsewhere_is_the_same_module_and_needs_no_compiler_again(own):
    Path("other").mkdir()
    first = load_controller(own(LAW))
    CONTROLLERS.pop("my-pd")
    second = load_controller(own(LAW, "other/my_pd.py"))
    assert first.start is not second.start
    assert first.start.__module__ == second.start.__module__


def test_a_name_belongs_to_one_file(own):
    Path("other").mkdir()
    load_controller(own(LAW))
    with pytest.raises(tl.InputError, match=r"the name 'my-pd' is taken by the controller in my_pd\.py"):
        load_controller(own(LAW + "# another\n", "other/my_pd.py"))


def test_a_law_that_divides_by_zero_only_in_the_trial_may_fly(own):
    harmless = (
        "    attitude = euler",
        "    integral = integral * (0.0 * (1.0 / (state.rates.x * 0.0)) + 1.0)\n    attitude = euler",
    )
    chosen = load_controller(own(edited(LAW, harmless)))
    mission = tl.load_mission("hover", controller=chosen)
    gains, _ = chosen.start(mission.controller, tl.Vehicle.from_settings(mission.vehicle), 0.001)
    assert gains.mass == 3.5


def test_an_unknown_controller_is_refused_with_a_suggestion():
    with pytest.raises(tl.InputError, match=r"unknown controller 'nfsmc'; there are .*Did you mean 'nftsmc'\?"):
        controller("nfsmc")


def test_registering_again_in_the_same_module_replaces():
    class Settings(ControllerTable):
        pass

    def start(s, vehicle, step):
        """Nothing."""

    register("temporary", Settings)(start)
    first = CONTROLLERS["temporary"]
    register("temporary", Settings)(start)
    assert CONTROLLERS["temporary"] is not first
    assert first.summary == "Nothing."


def test_a_controller_that_says_nothing_of_itself_is_listed_with_its_file():
    class Settings(ControllerTable):
        pass

    register("temporary", Settings)(lambda s, vehicle, step: None)
    assert CONTROLLERS["temporary"].summary == "of test_controller_files.py, which does not describe it"
