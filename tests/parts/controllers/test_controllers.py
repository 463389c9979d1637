"""Every registered controller, and the guide to one's own: docs/reference/controllers.md is run, not only read."""

import re
import shutil

import numpy as np
import pytest
from law_values import paper_vehicle
from listings import GUIDE, LISTINGS
from reference_tables.keys import key_tables

import tandemlift as tl
from tandemlift.compiler.tracer.graph import Graph
from tandemlift.core.errors import InputError
from tandemlift.core.types import flat
from tandemlift.parts.controllers import CONTROLLERS, controller, load_controller
from tandemlift.parts.controllers import control as control_law
from tandemlift.parts.controllers.registry import check_started

REGISTERED = sorted(CONTROLLERS)


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    """A folder with the files of the guide."""
    path = tmp_path_factory.mktemp("controllers")
    for file in LISTINGS.glob("*.py"):
        shutil.copy(file, path)
    return path


@pytest.fixture(scope="module")
def law(folder):
    return load_controller(folder / "my_pd.py")


@pytest.fixture(scope="module")
def plain(folder):
    return load_controller(folder / "my_pd_plain.py")


@pytest.mark.parametrize("name", REGISTERED)
@pytest.mark.parametrize("mission", ["hover", "one-push"])  # the baselines are tuned for ideal rotors and sensors
def test_a_registered_controller_flies_and_ends_where_the_reference_does(name, mission):
    flight = tl.fly(tl.load_mission(mission, controller=name))
    assert flight.ending is None
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
        assert flight.ending is None
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
    assert pushed.ending is None
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
    flown, unit_test = re.findall(r"```python\n(import tandemlift.*?)```", GUIDE, re.DOTALL)
    names: dict = {}
    exec(compile(unit_test, "controllers.md", "exec"), {})
    exec(compile(flown, "controllers.md", "exec"), names)
    assert tl.Flight.load(folder / "hover.npz") == names["flight"]
    assert names["mission"].controller.stiffness == (9.0, 9.0, 9.0)


def test_the_variants_of_the_guide_are_chosen_by_the_type_of_a_gain():
    names: dict = {"__name__": "variants"}
    (block,) = [block for block in re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL) if "class Soft" in block]
    exec(block, names)
    assert names["switching"](names["Soft"](0.1), 0.05) == pytest.approx(np.tanh(0.5))
    assert names["switching"](names["Hard"](), 0.05) == 1.0


def test_the_mission_file_of_the_guide_keeps_its_settings(law, folder):
    (folder / "mine.toml").write_text(re.findall(r"```toml\n(.*?)```", GUIDE, re.DOTALL)[0], "utf-8")
    mission = tl.load_mission(folder / "mine.toml", controller=law)
    assert mission.controller.stiffness == (4.0, 4.0, 9.0)
    assert mission.controller.damping == (4.0, 4.0, 4.0)
    assert mission.phases == tl.load_mission("hover").phases


def test_the_controllers_of_the_repository_are_named_in_the_shell_lines_of_the_guide():
    shell = "\n".join(re.findall(r"```sh\n(.*?)```", GUIDE, re.DOTALL))
    assert "tandemlift run hover --controller my_pd.py" in shell


@pytest.mark.parametrize("duration", [9.5, 10.0, 10.5])
def test_metrics_around_ten_seconds_are_those_of_the_law_compiled(duration, law, plain):
    compiled, interpreted = (
        tl.fly(tl.load_mission("hover", {"mission.duration": duration}, controller=c)).metrics() for c in (law, plain)
    )
    assert (compiled["thrust_max_after_10s_n"] is None) == (duration <= 10.0)
    for name, value in compiled.items():
        if name in ("outcome", "findings", "failure"):
            assert interpreted[name] == value
        elif name == "wall_s" or value is None:
            assert name == "wall_s" or interpreted[name] is None
        else:
            np.testing.assert_allclose(interpreted[name], value, rtol=1e-6, atol=1e-9, err_msg=name)


@pytest.mark.parametrize("name", [name for name in REGISTERED if name != "nftsmc"])
def test_every_key_of_a_baseline_is_in_the_page_of_keys_and_has_a_default(name):
    fields = CONTROLLERS[name].settings.model_fields
    page = key_tables()
    section = page.partition(f"## `[controller]` of `{name}`\n")[2].partition("\n## ")[0]
    assert [key for key in fields if key != "name" and f"`controller.{key}`" not in section] == []
    assert [key for key, field in fields.items() if key != "name" and field.is_required()] == []


def test_gains_hold_numbers_or_symbols_and_nothing_else():
    chosen = controller("pid")
    gains, memory = chosen.start(chosen.settings.model_validate({"name": "pid"}), paper_vehicle(), 0.001)
    check_started("pid", gains, memory)
    check_started("pid", gains, memory._replace(velocity=Graph().inputs("x", memory.velocity)))
    with pytest.raises(InputError, match=r"memory\.velocity is str; it must be a number"):
        check_started("pid", gains, memory._replace(velocity="fast"))
