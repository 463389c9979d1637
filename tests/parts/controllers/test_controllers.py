"""Every registered controller, and the guide to one's own: docs/reference/controllers.md is run, not only read."""

import re
import shutil

import numpy as np
import pytest
from listings import GUIDE, LISTINGS
from reference_tables.keys import key_tables

import tandemlift as tl
from tandemlift.parts.controllers import CONTROLLERS, controller, load_controller

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
def test_a_registered_controller_flies_and_ends_where_the_reference_does(name):
    """The baselines are tuned for ideal rotors and sensors."""
    flight = tl.fly(tl.load_mission("one-push", controller=name))
    assert flight.ending is None
    metrics = flight.metrics()
    np.testing.assert_allclose(metrics["final_position_m"], metrics["final_reference_m"], atol=0.05)


def test_a_registered_controller_is_described():
    for name in REGISTERED:
        chosen = controller(name)
        assert len(chosen.summary) > 20, name
        assert chosen.settings.__doc__, name


@pytest.mark.thorough
def test_both_controllers_of_the_guide_reach_the_height_and_agree_to_the_metrics(law, plain):
    longer = {"mission.duration": 10.5}
    compiled, interpreted = (tl.fly(tl.load_mission("hover", longer, controller=c)) for c in (law, plain))
    for flight in (compiled, interpreted):
        assert flight.ending is None
        assert np.abs(flight["position"][-1] - [0.0, 0.0, 1.0]).max() < 1e-3  # m; the integral still settles
    for name in ("position", "euler", "moment", "thrust"):
        np.testing.assert_allclose(compiled[name], interpreted[name], rtol=1e-9, atol=1e-12, err_msg=name)
    metrics, others = compiled.metrics(), interpreted.metrics()
    assert metrics["thrust_max_after_10s_n"] > 0.0
    for name in metrics.keys() - {"wall_s"}:
        if metrics[name] is None or name in ("outcome", "findings", "failure"):
            assert others[name] == metrics[name]
        else:
            np.testing.assert_allclose(others[name], metrics[name], rtol=1e-6, atol=1e-9, err_msg=name)


def test_a_flight_of_ten_seconds_has_no_metrics_after_ten_seconds(law):
    metrics = tl.fly(tl.load_mission("hover", {"mission.duration": 10.0}, controller=law)).metrics()
    assert metrics["thrust_max_after_10s_n"] is None


def test_the_controllers_of_the_guide_agree_when_pushed_off_the_centre_and_tilted(law, plain):
    pushes = [{"force": [2.0, 1.0, -0.5], "time": 1.0, "sigma": 0.3, "point": [0.1, 0.2, -0.06]}]
    changes = {"mission.duration": 2.0, "initial.euler": [0.2, -0.1, 0.3], "pushes": pushes, "phases.lift_start": 0}
    compiled, interpreted = (tl.fly(tl.load_mission("hover", changes, controller=c)) for c in (law, plain))
    assert np.abs(compiled["euler"]).max() > 0.1
    for name in ("position", "euler", "moment", "thrust"):
        np.testing.assert_allclose(compiled[name], interpreted[name], rtol=1e-9, atol=1e-10, err_msg=name)


def test_the_law_of_the_guide_survives_a_push(law):
    pushed = tl.fly(tl.load_mission("one-push", controller=law))
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


def test_every_key_of_a_baseline_is_in_the_page_of_keys_and_has_a_default():
    page, missing = key_tables(), []
    for name in set(REGISTERED) - {"nftsmc"}:
        section = page.partition(f"## `[controller]` of `{name}`\n")[2].partition("\n## ")[0]
        fields = {key: field for key, field in CONTROLLERS[name].settings.model_fields.items() if key != "name"}
        missing += [(name, k) for k, v in fields.items() if f"`controller.{k}`" not in section or v.is_required()]
    assert missing == []
