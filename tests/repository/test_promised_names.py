"""What the project promises to the outside keeps its name: commands, exit codes, Python names, mission keys, metrics.

These are written here as data, by hand, and compared with what there is. There may be more; none may go or be renamed.
"""

import json
from itertools import product

import numpy as np
import pytest
from click.testing import CliRunner
from mission_schema import SCHEMA

import tandemlift as tl
from tandemlift.apps.cli.main import cli, main
from tandemlift.missions import tables_of
from tandemlift.missions.changes import MISSING, value_at

COMMANDS = {  # each with its arguments and options
    "run": {"MISSION", "--engine", "--out", "--set", "--no-figures"},
    "missions": set(),
    "controllers": set(),
    "engines": set(),
}
FILES = {"mission.toml", "flight.npz", "metrics.json", "metrics.csv", "metrics.tex", "findings.json"}
FILES |= {"report.html", "figures"}
FIGURES = {"reference", "path", "tracking", "inputs", "interaction"}  # each as PNG and as PDF
SHORT = ("--set", "mission.duration=0.5", "--set", "mission.log_interval=0.1")

KEYS = {  # table: the keys in it
    "mission": "name duration step log_interval seed",
    "vehicle.payload": "mass length radius inertia",
    "vehicle.quadrotors.0": (
        "mass inertia position layout arm thrust_constant max_speed torque_per_thrust lag_up lag_down"
    ),
    "vehicle.drag": "force moment",
    "controller": (
        "name switching boundary_layer attitude_reference_derivatives filter_bandwidth euler_rates tilt_inverse "
        "human_force_feedforward"
    ),
    "controller.gains": "xi eta lambda_1 lambda_2 a",
    "admittance": "mass damping stiffness threshold gate hold_after_release",
    "allocation": "method weights",
    "initial": "position velocity euler rates",
    "phases": "lift_start lift_duration height land_start land_duration",
    "pushes.0": "force time sigma point",
    "disturbance": "force moment",
    "plant": "mass_scale inertia_scale",
    "actuators": "model",
}
PROMISED = {f"{table}.{key}" for table, keys in KEYS.items() for key in keys.split()}
METRICS = {  # name: how many numbers, 0 for one that is no list; 4 for U₁ to U₄
    "position_rmse_m": 3,
    "position_rmse_after_10s_m": 3,
    "position_max_error_m": 3,
    "position_max_error_after_10s_m": 3,
    "attitude_rmse_rad": 3,
    "velocity_max_error_after_10s_m_s": 3,
    "max_tilt_after_10s_rad": 3,
    "final_position_m": 3,
    "final_reference_m": 3,
    "thrust_min_after_10s_n": 0,
    "thrust_max_after_10s_n": 0,
    "moment_max_abs_after_10s_n_m": 3,
    "command_at_start": 4,
    "human_impulse_n_s": 3,
    "human_work_j": 0,
    "rotor_saturated_share": 0,
    "steps": 0,
    "wall_s": 0,
}


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder to run commands in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def exit_code(monkeypatch, *arguments):
    """The exit code of the command line."""
    monkeypatch.setattr("sys.argv", ["tandemlift", *arguments])
    with pytest.raises(SystemExit) as ended:
        main()
    return ended.value.code or 0


# ---- Commands


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_has_its_arguments_and_options(command):
    found = {
        name
        for p in cli.commands[command].params
        for name in (p.opts if p.opts[0][0] == "-" else [p.human_readable_name])
    }
    assert found >= COMMANDS[command]


@pytest.mark.parametrize(
    ("command", "known"), [("missions", "paper"), ("controllers", "nftsmc"), ("engines", "compiled")]
)
def test_what_there_is_is_listed_one_on_each_line(command, known):
    done = CliRunner().invoke(cli, [command])
    assert done.exit_code == 0
    rows = [line.split() for line in done.output.splitlines()]
    assert known in [row[0] for row in rows]
    assert all(len(row) > 2 for row in rows), "a name, and what it is"


def test_a_flight_is_written_to_a_folder_of_its_name_with_the_promised_files(here, monkeypatch):
    assert exit_code(monkeypatch, "run", "one-push", *SHORT) == 0
    folder = here / "out" / "one-push"
    assert {path.name for path in folder.iterdir()} == FILES
    drawn = {path.name for path in (folder / "figures").iterdir()}
    assert drawn >= {f"{name}.{kind}" for name, kind in product(FIGURES, ("png", "pdf"))}
    assert set(json.loads((folder / "metrics.json").read_text("utf-8"))) >= set(METRICS)


@pytest.mark.parametrize("value", ["saturation", '"saturation"'])
def test_options_choose_engine_folder_keys_and_no_figures(value, here, monkeypatch):
    setting = f"controller.switching={value}"  # a TOML literal; an unquoted word is a string
    options = ("--engine", "compiled", "--out", "there", "--no-figures", "--set", setting)
    assert exit_code(monkeypatch, "run", "one-push", *SHORT, *options) == 0
    assert {path.name for path in (here / "there").iterdir()} == FILES - {"figures"}
    assert tl.load_mission(here / "there" / "mission.toml").controller.switching == "saturation"


@pytest.mark.parametrize("wrong", ["no-such-mission", "no/such/file.toml"])
def test_bad_input_ends_with_2_and_writes_nothing(wrong, here, monkeypatch):
    assert exit_code(monkeypatch, "run", wrong) == 2
    assert exit_code(monkeypatch, "run", "paper", "--set", "mission.step=0.5") == 2
    assert list(here.iterdir()) == []


def test_a_flight_that_diverges_ends_with_3_and_writes_what_was_flown(here, monkeypatch):
    wild = [f"--set=controller.gains.{gain}" for gain in ("lambda_1=0", "lambda_2=0", "xi=[4,2,11,0.1,0.1,0.1]")]
    assert exit_code(monkeypatch, "run", "paper", "--no-figures", *wild) == 3
    assert {path.name for path in (here / "out" / "paper").iterdir()} == FILES - {"figures"}


@pytest.mark.parametrize("command", ["run", "report", "compare", "linearize", "feel"])
def test_a_command_that_draws_figures_takes_a_style_and_refuses_one_that_is_none(command, here, monkeypatch):
    (style,) = (p for p in cli.commands[command].params if "--style" in p.opts)
    assert set(style.type.choices) >= {"ieee", "elsevier", "slides"}
    assert exit_code(monkeypatch, command, "paper", "--style", "nature") == 2
    assert list(here.iterdir()) == []


# ---- Python


def test_the_names_of_the_python_api_fly_save_and_load(tmp_path):
    mission = tl.load_mission("one-push", {"mission.duration": 0.5})
    flight = tl.fly(mission, engine="compiled")
    assert isinstance(flight, tl.Flight)
    assert flight["position"].shape == (len(flight.time), 3)
    assert set(flight.metrics()) >= set(METRICS)
    flight.save(tmp_path / "flight.npz")
    np.testing.assert_array_equal(tl.Flight.load(tmp_path / "flight.npz")["position"], flight["position"])


def test_many_missions_are_flown_in_the_order_given_for_their_flights_or_their_metrics():
    missions = [tl.load_mission("one-push", {"mission.duration": t}) for t in (0.5, 0.25)]
    flights = tl.fly_many(missions, keep="flights", threads=1)
    assert [flight.time[-1] for flight in flights] == pytest.approx([0.5, 0.25])
    assert [metrics["steps"] for metrics in tl.fly_many(missions, keep="metrics", threads=None)] == [500, 250]


# ---- Mission keys


def test_a_mission_has_the_promised_keys():
    assert sorted(PROMISED - set(SCHEMA)) == []


def test_every_promised_key_can_be_set_by_its_dotted_path():
    mission = tl.load_mission("paper")
    tables = tables_of(mission)
    places = {key: tuple(int(part) if part.isdigit() else part for part in key.split(".")) for key in PROMISED}
    values = {key: value_at(tables, place) for key, place in places.items()}
    given = {key: value for key, value in values.items() if value is not MISSING}
    assert set(values) - set(given) == {"vehicle.payload.inertia", "admittance.gate"}  # a rod; by the guidance
    assert tl.load_mission("paper", given) == mission
    inertia = tl.load_mission("paper", {"vehicle.payload.inertia": [0.2, 0.01, 0.2]}).vehicle.payload.inertia
    assert inertia == (0.2, 0.01, 0.2)


# ---- Metrics


def test_a_flown_mission_has_the_promised_metrics():
    metrics = tl.fly(tl.load_mission("one-push")).metrics()
    assert {name: np.size(metrics[name]) * isinstance(metrics[name], list) for name in METRICS} == METRICS


def test_a_metric_that_could_not_be_formed_is_null():
    metrics = tl.fly(tl.load_mission("one-push", {"mission.duration": 0.5})).metrics()
    assert {name for name in METRICS if metrics[name] is None} == {name for name in METRICS if "after_10s" in name}
