"""Every registered controller, and the guide to one's own: docs/controllers.md is run, not only read."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.jit import flat
from tandemlift.laws.controllers import CONTROLLERS, controller, load_controller, register
from tandemlift.laws.controllers import control as control_law
from tandemlift.settings import ControllerTable

GUIDE = (Path(tl.__file__).parents[2] / "docs" / "controllers.md").read_text("utf-8")
FILES = dict(re.findall(r"<!-- (\S+) -->\n```python\n(.*?)```", GUIDE, re.DOTALL))
LAW, PLAIN = FILES["my_pd.py"], FILES["my_pd_plain.py"]
REGISTERED = sorted(CONTROLLERS)


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """A folder with the files of the guide."""
    path = tmp_path_factory.mktemp("controllers")
    for name, text in FILES.items():
        (path / name).write_text(text, "utf-8")
    return path


@pytest.fixture(scope="session")
def law(folder):
    return load_controller(folder / "my_pd.py")


@pytest.fixture(scope="session")
def plain(folder):
    return load_controller(folder / "my_pd_plain.py")


@pytest.fixture
def own(tmp_path, monkeypatch):
    """Write a controller file of one's own beside which the test runs; no other is registered, and it is forgotten."""
    monkeypatch.chdir(tmp_path)
    before = dict(CONTROLLERS)
    for name in set(CONTROLLERS) - set(REGISTERED):
        del CONTROLLERS[name]

    def write(text: str, name: str = "my_pd.py") -> str:
        Path(name).write_text(text, "utf-8")
        return name

    yield write
    CONTROLLERS.clear()
    CONTROLLERS.update(before)


def edited(text: str, *changes: tuple[str, str]) -> str:
    for before, after in changes:
        assert before in text
        text = text.replace(before, after, 1)
    return text


@pytest.mark.parametrize("name", REGISTERED)
@pytest.mark.parametrize("mission", ["hover", "one-push"])
def test_a_registered_controller_flies_and_ends_where_the_reference_does(name, mission):
    flight = tl.fly(tl.load_mission(mission, controller=name))
    assert flight.divergence is None
    metrics = flight.metrics()
    np.testing.assert_allclose(metrics["final_position_m"], metrics["final_reference_m"], atol=0.05)


@pytest.mark.parametrize("name", REGISTERED)
def test_a_registered_controller_has_a_summary_and_gains_and_memory_of_numbers(name):
    mission = tl.load_mission("hover", controller=name)
    chosen = controller(name)
    assert len(chosen.summary) > 20
    assert chosen.settings.__doc__
    gains, memory = chosen.start(mission.controller, tl.Vehicle.from_settings(mission.vehicle), 0.001)
    for value in (gains, memory):
        assert isinstance(value, tuple)
        assert hasattr(value, "_fields")
        assert np.isfinite(flat(value)).all()
    assert type(gains) in control_law.table


@pytest.mark.parametrize("name", REGISTERED)
def test_a_registered_controller_refuses_settings_that_it_does_not_know(name):
    with pytest.raises(tl.InputError, match=r"controller\.no_such_setting = 1: unknown key"):
        tl.load_mission("hover", {"controller.no_such_setting": 1}, controller=name)


def test_both_controllers_of_the_guide_reach_the_height_and_agree(law, plain):
    changes = {"mission.duration": 8.0}
    compiled, interpreted = (tl.fly(tl.load_mission("hover", changes, controller=c)) for c in (law, plain))
    for flight in (compiled, interpreted):
        assert flight.divergence is None
        assert np.abs(flight["position"][-1] - [0.0, 0.0, 1.0]).max() < 1e-3  # m; the integral still settles
    for name in ("position", "euler", "moment", "thrust"):
        np.testing.assert_allclose(compiled[name], interpreted[name], rtol=1e-9, atol=1e-12, err_msg=name)


def test_the_controllers_of_the_guide_agree_when_pushed_off_the_centre_and_tilted(law, plain):
    pushes = [{"force": [2.0, 1.0, -0.5], "time": 1.0, "sigma": 0.3, "point": [0.1, 0.2, -0.06]}]
    changes = {"mission.duration": 2.0, "initial.euler": [0.2, -0.1, 0.3], "pushes": pushes, "phases.lift_start": 0}
    compiled, interpreted = (tl.fly(tl.load_mission("hover", changes, controller=c)) for c in (law, plain))
    assert np.abs(compiled["euler"]).max() > 0.1
    for name in ("position", "euler", "moment", "thrust"):
        np.testing.assert_allclose(compiled[name], interpreted[name], rtol=1e-9, atol=1e-10, err_msg=name)


def test_the_law_of_the_guide_hovers_for_20_s_and_survives_a_push(law):
    hover, pushed = (tl.fly(tl.load_mission(name, controller=law)) for name in ("hover", "one-push"))
    assert abs(hover["position"][-1, 2] - 1.0) < 1e-4
    assert pushed.divergence is None
    assert np.abs(pushed["position_error"][-1]).max() < 0.03  # m; what the integral took up in the push still unwinds


def test_the_integral_of_the_guide_removes_the_offset_of_a_constant_wind(law):
    wind = {"disturbance.force": [1.0, 0.0, 0.0], "mission.duration": 60.0}
    with_it, without = (
        tl.fly(tl.load_mission("hover", {**wind, "controller.integral": k}, controller=law)) for k in (2.0, 0.0)
    )
    assert abs(with_it["position_error"][-1, 0]) < 1e-3
    assert without["position_error"][-1, 0] == pytest.approx(-1.0 / 3.5 / 4.0, rel=1e-3)  # force/(mass · stiffness)


def test_the_python_of_the_guide_runs(folder, monkeypatch):
    monkeypatch.chdir(folder)
    blocks = re.findall(r"```python\n(import tandemlift.*?)```", GUIDE, re.DOTALL)
    assert len(blocks) == 1
    names: dict = {}
    exec(compile(blocks[0], "controllers.md", "exec"), names)
    assert tl.Flight.load(folder / "hover.npz") == names["flight"]
    assert names["mission"].controller.stiffness == (9.0, 9.0, 9.0)


def test_the_mission_file_of_the_guide_keeps_its_settings(law, folder):
    (folder / "mine.toml").write_text(re.findall(r"```toml\n(.*?)```", GUIDE, re.DOTALL)[0], "utf-8")
    mission = tl.load_mission(folder / "mine.toml", controller=law)
    assert mission.controller.stiffness == (4.0, 4.0, 9.0)
    assert mission.controller.damping == (4.0, 4.0, 4.0)
    assert mission.phases == tl.load_mission("hover").phases


def test_the_controllers_of_the_repository_are_named_in_the_shell_lines_of_the_guide():
    shell = "\n".join(re.findall(r"```sh\n(.*?)```", GUIDE, re.DOTALL))
    assert "tandemlift run hover --controller my_pd.py" in shell


CACHED = """
import sys
import tandemlift as tl
from tandemlift.prepared import needs_compiling
mission = tl.load_mission("hover", {"mission.duration": 0.1}, controller=tl.load_controller(sys.argv[1]))
print(needs_compiling(mission))
tl.fly(mission)
"""


def test_a_second_process_finds_the_compiled_law_until_the_file_changes(own, tmp_path):
    own(LAW)

    def needs_compiling() -> str:
        environment = {**os.environ, "TANDEMLIFT_CACHE": str(tmp_path / "cache")}
        done = subprocess.run(
            [sys.executable, "-c", CACHED, "my_pd.py"], capture_output=True, text=True, env=environment, check=True
        )
        return done.stdout.strip()

    assert needs_compiling() == "True"
    compiled = sorted((tmp_path / "cache").rglob("*.nbc"))
    assert needs_compiling() == "False"
    assert compiled
    assert sorted((tmp_path / "cache").rglob("*.nbc")) == compiled
    own(LAW + "\n# edited\n")
    assert needs_compiling() == "True"


def test_an_unchanged_file_is_run_once_and_an_edited_one_anew(own):
    file = own(LAW)
    first = load_controller(file)
    assert load_controller(file) is first
    own(edited(LAW, ("stiffness: Positive3 = 4.0", "stiffness: Positive3 = 5.0")))
    second = load_controller(file)
    assert second is not first
    assert tl.load_mission("hover", controller=second).controller.stiffness == (5.0, 5.0, 5.0)
    assert not list(Path().glob("__pycache__"))


def test_a_mission_from_before_a_controller_was_edited_must_be_loaded_again(own):
    before = tl.load_mission("hover", controller=load_controller(own(LAW)))
    load_controller(own(LAW + "\n"))
    with pytest.raises(tl.InputError, match="'my-pd' has been loaded anew since the mission was"):
        tl.fly(before)


IMPORT = ("from tandemlift.ops import clip", "from tandemlift.ops import clop")
RETURN = ("return Command(Wrench(total_thrust(attitude, force), moment), tilt), Memory(integral)", "return {}")
WRONG_FILES = {
    "no controller": ((('@register("my-pd", Settings)\n', ""),), "my_pd.py: registers 0 controllers"),
    "two controllers": (
        (('@register("my-pd", Settings)\n', '@register("my-pd", Settings)\n@register("second", Settings)\n'),),
        "my_pd.py: registers 2 controllers; it must register one",
    ),
    "a failing import": ((IMPORT,), "my_pd.py, line 12: ImportError: cannot import name 'clop' from 'tandemlift.ops'"),
    "a typo at its top": ((("class Memory(NamedTuple)", "class Memory(NamedTupel)"),), "NameError: name 'NamedTupel'"),
    "bad syntax": (
        (("def start(s, vehicle, step):", "def start(s, vehicle, step)"),),
        "line 71: SyntaxError: expected",
    ),
    "an exit": ((("class Gains", "raise SystemExit(3)\nclass Gains"),), "line 28: SystemExit: 3"),
    "settings of another kind": ((("(ControllerTable)", ""),), "its settings must be a class derived from Controller"),
    "a name that is taken": ((('"my-pd"', '"nftsmc"'),), "the name 'nftsmc' is taken by the controller in nftsmc.py"),
    "a name that is none": ((('"my-pd"', '"my pd"'),), "a controller cannot be named 'my pd'"),
    "a helper that is no law": ((("@law\n", ""),), "calls wanted_moment(), which is no law: mark it @law"),
}
WRONG_LAWS = {
    "a typo in the law": ((("state.velocity\n", "state.velocty\n"),), "line 60: AttributeError: 'State' object has no"),
    "an unknown name": ((("* k.mass", "* mass"),), "line 63: NameError: name 'mass' is not defined"),
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
    "a typo in start": ((("vehicle.mass", "vehicle.mas"),), "line 74: AttributeError: 'Vehicle' object has no"),
    "a default that is not allowed": ((("= 4.0", "= -4.0"),), "controller.stiffness: must be one number or a list"),
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
    written = re.findall(r"^error: (.*)$", GUIDE, re.MULTILINE)
    ways = [
        WRONG_FILES["a failing import"],
        WRONG_FILES["no controller"],
        WRONG_FILES["a helper that is no law"],
        *(WRONG_LAWS[name] for name in ("a typo in the law", "no memory", "another memory", "a start without gains")),
    ]
    changed = [((), {"controller.stifness": 9}), ((), {"controller.stiffness": -1})]
    for line, (changes, given) in zip(written, [*((changes, {}) for changes, _ in ways), *changed], strict=True):
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
        assert tl.fly(tl.load_mission("hover", {"mission.duration": 0.01}, controller=chosen)).divergence is None


def test_a_name_belongs_to_one_file(own):
    Path("other").mkdir()
    load_controller(own(LAW))
    with pytest.raises(tl.InputError, match=r"the name 'my-pd' is taken by the controller in my_pd\.py"):
        load_controller(own(LAW, "other/my_pd.py"))


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
    before = dict(CONTROLLERS)

    class Settings(ControllerTable):
        pass

    def start(s, vehicle, step):
        """Nothing."""

    try:
        register("temporary", Settings)(start)
        first = CONTROLLERS["temporary"]
        register("temporary", Settings)(start)
        assert CONTROLLERS["temporary"] is not first
        assert first.summary == "Nothing."
    finally:
        CONTROLLERS.clear()
        CONTROLLERS.update(before)
