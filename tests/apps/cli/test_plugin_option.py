"""`--plugin FILE`, entry points, and every kind of part in the commands that fly."""

import json
import os
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from repository import ROOT

import tandemlift as tl
from tandemlift.apps.cli.main import GROUPS, cli
from tandemlift.core import plugs
from tandemlift.core.plugs import GIVEN, PLUGS

EXTRA = '''
import tandemlift as tl
from tandemlift.parts.sensors.vehicle_sensors import additional


@tl.plug("metric", "way_m")
def way(flight):
    """Way along the ground [m]."""
    return float(abs(flight["position"][-1, 0]))


@tl.plug("figure", "heights")
def heights(flight):
    """The height over time."""
    from matplotlib.figure import Figure

    figure = Figure()
    figure.subplots().plot(flight.time, flight["position"][:, 2])
    return figure


@tl.plug("sensor", "manometer", additional("manometer", "Pa", "pressure"))
def pressure(sensor, state, perfect):
    """Pressure over that of the ground."""
    return state.position.z * -11.8
'''
SHORT = ("--set", "mission.duration=2.0")
SMOOTH = ("--plugin", str(ROOT / "examples" / "my_gate.py"), "--set", "admittance.gate=smooth")
FLIES = {"compare", "check", "tune", "train", "feel", "linearize", "certify", "paper", "excite", "identify", "shadow"}
FLIES |= {"run", "live", "render", "score", "study", "benchmark", "gazebo", "ros", "crazyflie", "mavlink", "page"}
FLIES |= {"compile", "report", "plot", "schema"}


@pytest.fixture(autouse=True)
def as_before(tmp_path, monkeypatch):
    """Take away what a test has brought, and let it write beside its files."""
    monkeypatch.chdir(tmp_path)
    tables = [*PLUGS.values(), *(one.made_by for one in PLUGS.values()), plugs._loaded]
    before = [dict(table) for table in tables]
    yield
    for table, old in zip(tables, before, strict=True):
        table.clear()
        table.update(old)
    plugs.load_all_installed.cache_clear()


def done(*words):
    result = CliRunner().invoke(cli, [str(word) for word in words])
    assert result.exit_code == 0, result.exception
    return result.output


def test_every_command_that_flies_takes_plugins_and_export_says_why_it_does_not():
    takes = {verb.name for verbs in GROUPS.values() for verb in verbs for one in verb.params if "--plugin" in one.opts}
    assert takes == FLIES | {"export"}
    assert "Parts of your own: the key `plugins`" in " ".join(done("export", "--help").split())


def test_a_run_flies_the_gate_of_its_plugin_writes_its_text_and_leaves_nothing_to_the_next_command():
    done("run", "one-push", *SMOOTH, "--no-figures", "--out", "mine")
    flown = tl.Flight.load("mine")
    assert [one["name"] for one in flown.mission["plugins"]] == ["my_gate.py"]
    assert GIVEN == []
    done("run", "one-push", "--no-figures", "--out", "hard")
    assert "plugins" not in tl.Flight.load("hard").mission
    assert flown["position"][-1, 0] < tl.Flight.load("hard")["position"][-1, 0] - 0.05


def test_a_record_is_flown_again_with_its_plugin_and_refused_without_it():
    done("run", "one-push", *SMOOTH, *SHORT, "--no-figures", "--out", "mine")
    PLUGS["gate"].pop("smooth")
    refused = CliRunner().invoke(cli, ["run", "mine/mission.toml"])
    assert "is not loaded: give it by --plugin my_gate.py" in str(refused.exception)
    done("run", "mine/mission.toml", *SMOOTH[:2], "--no-figures", "--out", "again")
    for file in ("mission.toml", "findings.json"):
        assert Path("again", file).read_bytes() == Path("mine", file).read_bytes()


def test_metrics_and_figures_of_a_plugin_are_in_the_results_and_the_report():
    Path("extra.py").write_text(EXTRA)
    done("run", "one-push", "--plugin", "extra.py", "--out", "mine")
    flown = tl.Flight.load("mine")
    assert flown.metrics()["way_m"] == abs(flown["position"][-1, 0])
    assert json.loads(Path("mine/metrics.json").read_text())["way_m"] == flown.metrics()["way_m"]
    assert Path("mine/figures/heights.png").stat().st_size > 5_000
    assert "The height over time." in Path("mine/report.html").read_text("utf-8")
    assert tl.plot(flown, "heights").axes[0].lines[0].get_ydata().tolist() == flown["position"][:, 2].tolist()


def test_a_study_by_processes_flies_the_engine_the_sensor_and_the_metric_of_its_plugins():
    """The engine is first order in its step of 1 ms: some hundredths of a millimetre from Runge-Kutta's."""
    Path("extra.py").write_text(EXTRA)
    Path("my_engine.py").write_text((ROOT / "examples" / "my_engine.py").read_text())
    Path("s.toml").write_text(
        '[study]\nname = "own"\nmissions = ["one-push"]\nengines = ["compiled", "euler"]\n'
        'plugins = ["my_engine.py", "extra.py"]\n[set]\nmission.duration = 5.0\n'
    )
    table = tl.study("s.toml", "rows", processes=1).to_pandas()
    assert list(table["engine"]) == ["compiled", "euler"]
    assert 3e-5 < abs(table["way_m"][0] - table["way_m"][1]) < 3e-4
    assert np.array_equal(table["way_m"], table["final_position_m.0"].abs())
    sensed = {"study": {"name": "b", "missions": ["iris"], "plugins": ["extra.py"]}, "keep": {"rows": [0]}}
    sensed["keep"]["channels"] = ["measured_manometer", "position"]
    sensed["set"] = {"mission.duration": 12.0, "sensors.additional": [{"name": "manometer"}]}
    channels = tl.study(sensed, "sensed", processes=1).channels(0)
    assert channels["measured_manometer"][-1] == pytest.approx(-11.8 * channels["position"][-1, 2], abs=0.1)


def test_a_metric_that_fails_or_gives_no_number_is_refused_with_its_line():
    Path("extra.py").write_text(EXTRA.replace("float(abs(", "float(1 / 0 * abs("))
    refused = CliRunner().invoke(cli, ["run", "one-push", "--plugin", "extra.py", *SHORT])
    assert str(refused.exception) == "metric 'way_m' fails: extra.py, line 9: ZeroDivisionError: division by zero"
    Path("extra.py").write_text(EXTRA.replace("float(abs(", "'far' + str(abs("))
    refused = CliRunner().invoke(cli, ["run", "one-push", "--plugin", "extra.py", *SHORT])
    assert "metric 'way_m'" in str(refused.exception)


@pytest.mark.parametrize("words", [("check",), ("linearize",), ("compare",), ("feel",)])
def test_other_commands_fly_the_gate_too(words):
    assert done(*words, "one-push", *SMOOTH, *(SHORT if words != ("feel",) else ()))


def test_pages_and_compiled_missions_have_the_gate_of_a_plugin():
    done("compile", "one-push", *SMOOTH, "--target", "c", "--out", "c")
    done("compile", "one-push", "--target", "c", "--out", "hard")
    assert Path("c/one_push_pilot.c").read_text() != Path("hard/one_push_pilot.c").read_text()
    Path("my_gate.py").write_text(Path(SMOOTH[1]).read_text())
    Path("mine.toml").write_text('extends = "one-push"\nplugins = ["my_gate.py"]\nadmittance.gate = "smooth"\n')
    done("page", "mine.toml", "--html", "page.html")


def test_an_installed_package_brings_parts_by_its_entry_point_also_to_processes(monkeypatch):
    Path("site/my_parts-1.0.dist-info").mkdir(parents=True)
    Path("site/my_parts").mkdir()
    Path("site/my_parts/__init__.py").write_text("from my_parts import gates\n")
    Path("site/my_parts/gates.py").write_text(Path(SMOOTH[1]).read_text().replace('"smooth"', '"packed"'))
    Path("site/my_parts-1.0.dist-info/METADATA").write_text("Name: my-parts\nVersion: 1.0\n")
    Path("site/my_parts-1.0.dist-info/entry_points.txt").write_text("[tandemlift]\nmy-parts = my_parts\n")
    monkeypatch.syspath_prepend(Path("site").resolve())
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(Path("site").resolve()), os.environ.get("PYTHONPATH", "")]))
    plugs.load_all_installed.cache_clear()
    mission = tl.load_mission("one-push", {"admittance.gate": "packed"})  # found by its name alone
    assert [one.name for one in mission.plugins] == ["my-parts"]
    study = {"study": {"name": "p", "missions": ["one-push"]}, "set": {"admittance.gate": "packed"}}
    end = tl.study(study, "rows", processes=1).to_pandas()["final_position_m.0"][0]
    assert end == tl.fly(mission)["position"][-1, 0]
    listed = tl.load_mission("one-push", {"plugins": ["my-parts"]})
    assert listed.plugins == mission.plugins
    with pytest.raises(tl.InputError, match="plugin 'other': no installed package has it; there is my-parts"):
        tl.load_mission("one-push", {"plugins": ["other"]})
    for name in [name for name in sys.modules if name.startswith("my_parts")]:
        del sys.modules[name]


def test_an_installed_package_that_fails_is_named_and_leaves_nothing(monkeypatch):
    Path("site/bad-1.0.dist-info").mkdir(parents=True)
    Path("site/bad_parts.py").write_text(Path(SMOOTH[1]).read_text() + "\n1 / 0\n")
    Path("site/bad-1.0.dist-info/METADATA").write_text("Name: bad\nVersion: 1.0\n")
    Path("site/bad-1.0.dist-info/entry_points.txt").write_text("[tandemlift]\nbad = bad_parts\n")
    monkeypatch.syspath_prepend(Path("site").resolve())
    with pytest.raises(tl.InputError, match="plugin 'bad': its package fails: ZeroDivisionError"):
        tl.load_mission("one-push", {"plugins": ["bad"]})
    assert "smooth" not in PLUGS["gate"]
    assert "bad_parts" not in sys.modules
